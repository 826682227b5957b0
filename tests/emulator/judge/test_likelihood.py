import numpy as np
import pytest

from emulator.judge.likelihood import LOWEST, compare_likelihood, qq_points
from emulator.model.gaussian import LowRankNormal


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
