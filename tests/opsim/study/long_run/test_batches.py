import numpy as np
import pytest

from opsim.study.intervals import t_interval
from opsim.study.long_run import batch_means
from opsim.study.long_run.batching import overlapping_half_width, pieces
from tests.opsim.study.long_run.waits import autoregressions, mm1_waits, naive_waits, variance_of_mean


def naive_overlapping_variance(series, size):
    """Of the mean of one series, from every window of ``size`` values."""
    n = len(series)
    windows = [np.mean(series[i : i + size]) for i in range(n - size + 1)]
    return size / ((n - size) * len(windows)) * sum((one - np.mean(series)) ** 2 for one in windows)


def test_pieces_are_means_and_what_is_left_over_is_at_the_front():
    assert pieces([9, 1, 3, 5, 7], 2).tolist() == [[2, 6]]
    assert pieces([[1, 3], [5, 7]], 1).tolist() == [[2], [6]]


def test_independent_values_make_forty_batches_with_students_interval():
    values = np.random.default_rng(1).normal(10, 1, 1003)
    found = batch_means(values)
    assert (found.n, found.batch_size, found.left_over, found.independent) == (40, 25, 3, True)
    by_hand = t_interval(values[3:].reshape(40, 25).mean(axis=1))
    assert (found.mean, found.half_width) == (by_hand.mean, by_hand.half_width) and found.longer == 1


def test_the_overlapping_half_width_is_the_naive_one():
    from scipy.special import stdtrit

    series = autoregressions(0.5, 90, 1, 4)[0]
    expected = stdtrit(1.5 * (90 / 9 - 1), 0.975) * np.sqrt(naive_overlapping_variance(series.tolist(), 9))
    assert overlapping_half_width(series, 9) == pytest.approx(expected)
    assert np.isnan(overlapping_half_width(series, 60))


def test_overlapping_batches_of_replications_have_the_variance_of_theory():
    """AR(1) 0.5, four replications of 500 in batches of 50: half-width over the known one, 200 times."""
    from scipy.special import stdtrit

    made = autoregressions(0.5, 500, 800, 6).reshape(200, 4, 500)
    known = stdtrit(1.5 * 39, 0.975) * np.sqrt(variance_of_mean(0.5, 500) / 4)
    assert np.mean([overlapping_half_width(one, 50) for one in made]) / known == pytest.approx(1.0, abs=0.04)


@pytest.mark.parametrize("phi, n", [(0.0, 1000), (0.5, 2000), (0.9, 5000)])
def test_the_interval_of_an_autoregression_is_as_wide_as_theory_asks_and_covers_it(phi, n):
    """300 series each, known mean 0: coverage 0.95 with a standard error of 0.013."""
    found = [batch_means(one) for one in autoregressions(phi, n, 300, 5)]
    covered = np.mean([one.low <= 0 <= one.high for one in found])
    sd = np.sqrt(np.mean([(one.half_width / _t(one.n)) ** 2 for one in found]))
    assert 0.92 <= covered <= 0.98 and np.mean([one.independent for one in found]) > 0.95
    assert sd == pytest.approx(np.sqrt(variance_of_mean(phi, n)), rel=0.08)


def _t(n):
    from scipy.special import stdtrit

    return stdtrit(n - 1, 0.975)


def test_the_walk_is_lindleys_recursion():
    rng = np.random.default_rng(7)
    service, interarrival = rng.exponential(0.8, 99), rng.exponential(1.0, 99)
    assert mm1_waits(0.8, 100, 7) == pytest.approx(naive_waits(service, interarrival))


def test_the_interval_of_waits_in_a_queue_covers_theory():
    """M/M/1 at load 0.8: W = 0.8^2 / 0.2 = 3.2 services of 1/0.8; 300 runs, 2,000 customers left out, 20,000 kept."""
    found = [batch_means(mm1_waits(0.8, 22_000, seed)[2000:]) for seed in range(300)]
    assert 0.90 <= np.mean([one.low <= 3.2 <= one.high for one in found]) <= 0.98
    assert np.mean([one.independent for one in found]) > 0.9


def test_too_short_a_series_is_no_proof_and_says_how_long_it_should_be():
    found = [batch_means(one) for one in autoregressions(0.99, 1000, 40, 8)]
    assert not any(one.independent for one in found) and {one.n for one in found} == {10}
    assert 3 <= np.median([one.longer for one in found]) <= 20


def test_means_of_five_and_more_replications_are_independent_whatever_their_values():
    found = batch_means(autoregressions(0.999, 400, 6, 9))
    assert found.independent and found.means.shape == (6, 1)
    assert not found.long_enough and found.lag_one > 0.9 and found.longer == 20
    assert not batch_means(autoregressions(0.999, 400, 2, 9)).independent


def test_how_much_longer_replications_should_be_is_near_the_truth():
    """AR(1) 0.95 in ten of 200 values: pieces of 20 fade by e; 1.6 times that makes them 0.4 alike, so twice does."""
    found = [batch_means(one) for one in autoregressions(0.95, 200, 1000, 10).reshape(100, 10, 200)]
    assert np.mean([one.long_enough for one in found]) <= 0.2
    assert np.median([one.longer for one in found]) == 2
    twice = [batch_means(one) for one in autoregressions(0.95, 500, 1000, 11).reshape(100, 10, 500)]
    assert np.mean([one.long_enough for one in twice]) >= 0.8


def test_a_constant_is_known_exactly():
    found = batch_means(np.full(500, 0.1))
    assert found.half_width == pytest.approx(0, abs=1e-12) and found.independent and found.mean == pytest.approx(0.1)


def test_few_values_are_judged_as_not_proven_and_fewer_than_ten_refused():
    few = batch_means(np.arange(30.0) % 3)
    assert not few.independent and few.n == 10 and few.longer == pytest.approx(100 / 30)
    with pytest.raises(ValueError, match="9 values are too few"):
        batch_means(np.arange(9.0))
    with pytest.raises(ValueError, match="one axis, or two"):
        batch_means(np.zeros((2, 3, 4)))
