import numpy as np
import pytest

from emulator.geometry.flattening import SIEM
from emulator.judge.likelihood import LOWEST, compare_likelihood, qq_points, two_level
from emulator.model.gaussian import LowRankNormal
from tests.emulator.judge.made import sequences


def test_samples_of_one_size_are_sorted_against_one_another():
    assert np.array_equal(qq_points(np.array([3.0, 1, 2]), np.array([10.0, 30, 20])), [[1, 10], [2, 20], [3, 30]])


def test_the_larger_sample_is_read_at_the_shares_of_the_smaller():
    """Shares 1/4 and 3/4: of four values the means of neighbours, of two the values."""
    assert np.allclose(qq_points(np.array([4.0, 1, 2, 3]), np.array([0.0, 9.0])), [[1.5, 0], [3.5, 9]])


def test_a_likelihood_of_zero_is_a_point_far_below():
    found = qq_points(np.array([1.0, 2.0]), np.array([-np.inf, 5.0]))
    assert found[0, 1] == LOWEST and found[1, 1] == 5


@pytest.mark.parametrize("bad", [np.array([]), np.array([0.0, np.nan])])
def test_no_numbers_are_refused(bad):
    with pytest.raises(ValueError, match="other: found"):
        qq_points(np.array([1.0]), bad)


def test_a_gaussian_has_its_own_draws_on_the_diagonal_and_a_wider_one_below():
    rng = np.random.default_rng(0)
    given = rng.normal(size=(2000, 5))
    density = LowRankNormal.fit(given, rho=0.0)
    same, wider = (compare_likelihood(density, given, scale * density.sample(2000, rng)) for scale in (1.0, 1.5))
    assert same.gap < 0.1
    assert wider.gap > 1 and np.all(wider.qq[1000:-20, 1] < wider.qq[1000:-20, 0])


def test_equally_likely_items_have_no_scale():
    class Flat:
        def log_likelihood(self, scores):
            return np.zeros(len(scores))

    assert np.isnan(compare_likelihood(Flat(), np.ones((4, 2)), np.ones((4, 2))).gap)


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
