"""Effects read from a fit: their intervals hold what a run at both ends would say."""

import numpy as np
import pytest

from opsim.study.intervals import t_interval
from opsim.study.sweep import fit_response, grid
from opsim.study.sweep.designs import latin_hypercube
from opsim.study.sweep.effects import best_of, effects_by_fit
from opsim.study.sweep.factors import Factor
from opsim.study.sweep.response_surface import columns
from opsim.study.sweep.response_surface import fit_response as fit_response_of_by_fit

# Montgomery, Design and Analysis of Experiments, 8th ed., table 11.6: a central composite design and its yields
CODED = [(-1, -1), (-1, 1), (1, -1), (1, 1), *[(0, 0)] * 5, (1.414, 0), (-1.414, 0), (0, 1.414), (0, -1.414)]
YIELDS = [76.5, 77.0, 78.0, 79.5, 79.9, 80.3, 80.0, 79.7, 79.8, 78.4, 75.6, 78.5, 77.0]
THREE = grid([3, 3]).astype(float)


def bowl(x):
    return 5 + 2 * x[:, 0] - x[:, 1] + 3 * x[:, 0] ** 2 + 0.5 * x[:, 0] * x[:, 1]


def test_the_second_order_model_of_montgomery():
    fit = fit_response(CODED, YIELDS, low=[-1, -1], high=[1, 1], kind="quadratic")
    by_term = dict(zip(fit.terms, fit.coefficients))
    known = {(): 79.94, ((0, 1),): 0.99, ((1, 1),): 0.52, ((0, 2),): -1.38, ((1, 2),): -1.00, ((0, 1), (1, 1)): 0.25}
    assert by_term == pytest.approx(known, abs=0.006)
    assert fit.r2 == pytest.approx(0.9828, abs=0.0005) and fit.r2_predicted == pytest.approx(0.918, abs=0.002)
    assert fit_response(CODED, YIELDS, low=[-1, -1], high=[1, 1]).loo_rmse < fit.loo_rmse


def test_a_polynomial_is_found_again_and_says_so():
    points = THREE * [10, 4] + [20, 1]
    fit = fit_response(points, bowl(THREE))
    assert fit.means(points) == pytest.approx(bowl(THREE))
    assert fit.at([35, 7]).mean == pytest.approx(float(bowl(np.array([[1.5, 1.5]]))[0]))
    assert fit.trusted and fit.loo_rmse < 1e-9


def test_leave_one_out_is_what_fits_without_each_point_miss(rng):
    y = bowl(THREE) + rng.normal(0, 1, 9)
    fit = fit_response(THREE, y)
    design = columns(fit.terms, fit.room.scaled(THREE), fit.room)
    misses = []
    for out in range(9):
        rest = np.arange(9) != out
        misses.append(y[out] - design[out] @ np.linalg.lstsq(design[rest], y[rest], rcond=None)[0])
    assert fit.loo_rmse == pytest.approx(np.sqrt(np.mean(np.square(misses))))


def test_intervals_hold_the_truth_with_common_random_numbers():
    """95 % of 1,200 intervals of coefficients; the luck of a replication moves all points and tilts them."""
    truth = np.array([5.0, 2.0, -1.0])
    rng, held = np.random.default_rng(4), 0
    corners = grid([2, 2]) * 2.0 - 1
    points = np.vstack([corners, [[0, 0]]])
    design = np.column_stack([np.ones(5), points])
    for _ in range(400):
        luck = rng.normal(0, 1, (1, 8)) + points[:, :1] * rng.normal(0, 0.3, (1, 8))
        y = (design @ truth)[:, None] + luck + rng.normal(0, 0.5, (5, 8))
        each = np.linalg.lstsq(design, y, rcond=None)[0]
        fit = fit_response(points, y)
        by_term = dict(zip(fit.terms, zip(fit.coefficients, fit.half_widths)))
        for term, known, row in zip(((), ((0, 1),), ((1, 1),)), truth, each):
            value, half = by_term[term]
            assert fit.kind != "linear" or value == pytest.approx(row.mean())
            held += abs(value - known) <= half
    assert 0.93 < held / 1200 < 0.97


def test_lack_of_fit_cries_wolf_as_rarely_as_it_promises_and_sees_a_wolf():
    rng, n = np.random.default_rng(8), 300
    points = np.linspace(-1, 1, 7)[:, None]
    luck = [rng.normal(0, 1, (1, 6)) + rng.normal(0, 0.5, (7, 6)) for _ in range(n)]
    straight = [fit_response(points, 3 * points + one) for one in luck]
    steps = [fit_response(points, np.sin(6 * points) * 3 + one) for one in luck[:20]]
    share = np.mean([fit.lack_of_fit_p < 0.05 for fit in straight])
    assert share < 0.08  # choosing among the fits by what they miss can only lower it
    assert all(fit.lack_of_fit_p < 1e-6 and not fit.trusted for fit in steps)


@pytest.mark.parametrize("bend, least", [(0.0, 0.93), (0.3, 0.9)])
def test_a_prediction_holds_the_truth_at_points_that_were_not_seen(bend, least):
    """In 300 studies of 13 points; also where the truth is a little other than a parabola."""
    rng, held = np.random.default_rng(12), 0
    points = np.vstack([THREE - 1, [[-0.5, 0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, -0.5]]])
    for _ in range(300):
        new = rng.uniform(-1, 1, (1, 2))
        truth = [bowl(x) + bend * np.sin(4 * x[:, 0]) for x in (points, new)]
        luck = rng.normal(0, 1, (1, 6)) + rng.normal(0, 0.4, (13, 6))
        fit = fit_response(points, truth[0][:, None] + luck).at(new[0])
        held += fit.low <= truth[1][0] <= fit.high
    assert held / 300 >= least


def test_a_factor_without_order_is_fitted_by_its_means():
    points = np.array([[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1], [0, 2.0], [1, 2], [2, 2]])
    values = np.array([1.0, 7, 4])[points[:, 0].astype(int)] + 2 * points[:, 1]
    fit = fit_response(points, values, categories=[3, 0])
    assert fit.means(points) == pytest.approx(values)
    assert fit.coefficients[0] == pytest.approx(values.mean())


def test_noise_leaves_out_luck_that_all_points_share(rng):
    y = np.arange(4.0)[:, None] + rng.normal(0, 50, (1, 10))
    assert fit_response(np.arange(4.0)[:, None], y).noise < 1e-9


@pytest.mark.parametrize(
    "values, said",
    [
        (np.ones((2, 3)), "2 points are too few"),
        (np.full((2, 3), np.nan), "no replication with a value at every point"),
    ],
)
def test_what_cannot_be_fitted_is_said(values, said):
    with pytest.raises(ValueError, match=said):
        fit_response([[0.0], [1.0]], values)


def test_nothing_is_foretold_outside_of_what_was_looked_at():
    fit = fit_response(THREE, bowl(THREE))
    with pytest.raises(ValueError, match="outside of what was looked at, 0 to 2"):
        fit.at([1, 2.5])


def test_a_flat_figure_is_fitted_without_fear():
    fit = fit_response(THREE, np.full((9, 4), 3.0))
    assert fit.r2_predicted == 1 and fit.lack_of_fit_p == 1 and fit.trusted


@pytest.mark.parametrize("bend, least, most", [(0.0, 0.02, 0.09), (0.3, 1.0, 1.0)])
def test_lack_of_fit_keeps_its_level_and_its_power_where_luck_tilts_the_line(bend, least, most):
    """Common random numbers: slopes vary from replication to replication, 20 times as much as a point by itself."""
    rng, found = np.random.default_rng(4), []
    x = rng.uniform(-1, 1, (20, 2))
    for _ in range(300):
        y = 10 + (3 + rng.normal(0, 1, (1, 5))) * x[:, :1] + bend * x[:, :1] ** 2 + rng.normal(0, 0.05, (20, 5))
        found.append(fit_response(x, y, kind="linear"))
    assert least <= np.mean([fit.lack_of_fit_p < 0.05 for fit in found]) <= most
    assert np.mean([fit.noise**2 for fit in found]) == pytest.approx(0.05**2 / 5, rel=0.05)


def test_the_misfit_is_what_the_misses_have_beyond_luck():
    """A saw tooth of 0.5 about a line: its variance, whatever the luck."""
    rng = np.random.default_rng(5)
    x = np.linspace(-1, 1, 40)[:, None]
    tooth = 0.5 * (-1.0) ** np.arange(40)[:, None]
    found = [fit_response(x, 2 * x + tooth + rng.normal(0, 1, (40, 8)), kind="linear").misfit for _ in range(100)]
    straight = [fit_response(x, 2 * x + rng.normal(0, 1, (40, 8)), kind="linear").misfit for _ in range(100)]
    assert np.mean(found) == pytest.approx(0.25, rel=0.1) and np.mean(straight) < 0.02


FACTORS = (Factor("a.b", (-1.0, 1.0), is_range=True), Factor("c.d", (-1.0, 1.0), is_range=True))


def knee(x):
    """No polynomial: it stops rising in a, and rises in d only below the middle."""
    return 10 * np.minimum(x[:, 0], -0.3) + np.minimum(x[:, 1], 0)


def plane(x):
    return 5 * x[:, 0] + x[:, 1]


def effects(truth, rng, points=12, replications=5, noise=0.1):
    x = 2 * latin_hypercube(points, 2, rng) - 1
    luck = rng.normal(0, 1, (1, replications)) + noise * rng.normal(0, 1, (points, replications))
    fit = fit_response_of_by_fit(x, truth(x)[:, None] + luck, low=[-1, -1], high=[1, 1])
    return fit, effects_by_fit(FACTORS, fit)


@pytest.mark.parametrize("truth", [pytest.param(plane, marks=pytest.mark.slow), knee])
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


NAN = float("nan")


def best(values, better="more"):
    rows = np.array(values, dtype=float)
    return best_of(rows, [t_interval(row) for row in rows], better)


def test_the_best_has_the_best_mean_and_is_told_from_the_others_pair_by_pair(rng):
    luck = rng.normal(0, 50, 8)
    tie = 5 + 0.1 * (-1.0) ** np.arange(8)
    found = best([luck, luck + tie, luck + tie[::-1] + 0.001])
    assert found.row == 2 and found.like_it == 1 and found.shared == 8


def test_a_point_does_not_win_by_having_values_in_lucky_replications_only(rng):
    luck = np.array([0.0, 0, 0, 10, 10, 10])
    worse = np.where(luck > 0, luck - 1, NAN)
    for better, sign in (("more", 1), ("less", -1)):
        found = best(sign * np.array([worse, luck, luck - 2 - rng.normal(0, 0.1, 6)]), better)
        assert found.row == 1 and found.shared == 3


def test_points_without_any_value_are_no_rivals():
    found = best([[NAN, NAN], [1, 2], [0, 1.5]])
    assert found.row == 1 and found.shared == 2
