import numpy as np
import pytest

from emulator.geometry.flattening import SIEM
from emulator.judge.likelihood import two_level
from emulator.model.gaussian import LowRankNormal
from tests.emulator.judge.made import sequences


class Gaussian:
    """A Gaussian of the coordinates, its spread stretched by a factor."""

    def __init__(self, given, stretch):
        self.flatten = SIEM.fit(given)
        self.density = LowRankNormal.fit(self._flat(given), rho=0.0)
        self.stretch, self.shape, self.n_given = stretch, (given.shape[1], -1), len(given)

    def _flat(self, given):
        return self.flatten.forward(given).reshape(len(given), -1)

    def sample(self, n, rng):
        drawn = self.density.mean + self.stretch * (self.density.sample(n, rng) - self.density.mean)
        return self.flatten.inverse(drawn.reshape(n, *self.shape))

    def log_likelihood(self, given):
        return self.density.log_likelihood(self._flat(given))


STRETCH = {"right": 1.0, "wide": 2.0, "still": 0.05}
GIVEN = sequences(30, 6, 3, spread=0.2)
SMALL = {"n_train": 120, "n_test": 60, "n_drawn": 60}


def fit(name, given):
    return Gaussian(given, STRETCH[name])


def test_the_right_scheme_passes_and_wrong_ones_do_not():
    right, wide, still = two_level(GIVEN, "right", ["right", "wide", "still"], fit, **SMALL)
    assert right.p > 0.05 > max(wide.p, still.p)
    assert max(abs(right.energy), 0.01) < min(wide.energy, still.energy)


def test_too_wide_a_scheme_is_too_unlikely_under_the_law_of_level_one():
    right, wide = two_level(GIVEN, "right", ["right", "wide"], fit, **SMALL)
    gap = [np.mean(row.qq[:, 1] - row.qq[:, 0]) for row in (right, wide)]
    assert right.qq.shape == (60, 2) and abs(gap[0]) < 0.3 * abs(gap[1]) and gap[1] < -40


def test_a_row_does_not_depend_on_the_other_schemes_and_repeats():
    alone = two_level(GIVEN, "right", ["wide"], fit, **SMALL)[0]
    among = two_level(GIVEN, "right", ["still", "wide"], fit, **SMALL)[1]
    other = two_level(GIVEN, "right", ["wide"], fit, seed=1, **SMALL)[0]
    assert (alone.p, alone.energy) == (among.p, among.energy) and np.array_equal(alone.qq, among.qq)
    assert alone.energy != other.energy


def test_schemes_see_the_training_only():
    seen = []

    def watching(name, given):
        seen.append((name, len(given)))
        return fit(name, given)

    two_level(GIVEN, "right", ["wide"], watching, **SMALL)
    assert seen == [("right", 30), ("wide", 120)]


@pytest.mark.slow
def test_at_the_papers_size_the_right_scheme_passes_for_most_seeds():
    p = [two_level(GIVEN, "right", ["right"], fit, seed=seed)[0].p for seed in range(10)]
    assert np.sum(np.array(p) > 0.05) >= 7
