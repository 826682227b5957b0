"""Effects read from a fit: their intervals hold what a run at both ends would say."""

import numpy as np
import pytest

from opsim.study.sweep.designs import latin_hypercube
from opsim.study.sweep.effects import effects_by_fit
from opsim.study.sweep.factors import Factor
from opsim.study.sweep.response_surface import fit_response

FACTORS = (Factor("a.b", (-1.0, 1.0), is_range=True), Factor("c.d", (-1.0, 1.0), is_range=True))


def knee(x):
    """No polynomial: it stops rising in a, and rises in d only below the middle."""
    return 10 * np.minimum(x[:, 0], -0.3) + np.minimum(x[:, 1], 0)


def plane(x):
    return 5 * x[:, 0] + x[:, 1]


def effects(truth, rng, points=12, replications=5, noise=0.1):
    x = 2 * latin_hypercube(points, 2, rng) - 1
    luck = rng.normal(0, 1, (1, replications)) + noise * rng.normal(0, 1, (points, replications))
    fit = fit_response(x, truth(x)[:, None] + luck, low=[-1, -1], high=[1, 1])
    return fit, effects_by_fit(FACTORS, fit)


@pytest.mark.parametrize("truth", [plane, knee])
def test_an_interval_by_the_fit_holds_the_true_difference_of_its_two_levels(truth):
    rng, held = np.random.default_rng(2), []
    for _ in range(150):
        for one in effects(truth, rng)[1]:
            column = 0 if one.name == "a.b" else 1
            ends = np.zeros((2, 2))
            ends[:, column] = [float(one.levels[k].name) for k in (one.least, one.most)]
            low, high = truth(ends)
            held.append(one.rise.low <= high - low <= one.rise.high)
    assert np.mean(held) > 0.92


def test_a_plane_is_found_clear_with_an_interval_no_wider_than_its_luck():
    _, (first, second) = effects(plane, np.random.default_rng(3), points=20, replications=10)
    assert first.name == "a.b" and first.clear and second.clear and second.rise.half_width < 0.4


def test_nothing_is_clear_by_a_fit_that_is_not_to_be_trusted():
    fit, found = effects(lambda x: 5 * np.sin(9 * x[:, 0]) + 3 * x[:, 0], np.random.default_rng(1))
    assert not fit.trusted and found and not any(one.clear for one in found)
