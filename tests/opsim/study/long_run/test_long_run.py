import numpy as np
import pytest

from opsim.study.intervals import t_interval
from opsim.study.long_run import batch_means, correlogram, lag_one, von_neumann, welch
from opsim.study.long_run.batching import overlapping_half_width, pieces
from opsim.study.long_run.diagnostics import beyond_luck, full_stations, growth, nobody_free
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


def naive_correlogram(series, most):
    mean = sum(series) / len(series)
    squares = sum((x - mean) ** 2 for x in series)
    return [
        sum((series[i] - mean) * (series[i + k] - mean) for i in range(len(series) - k)) / squares
        for k in range(most + 1)
    ]


def test_a_correlogram_by_hand():
    """1, 2, 3, 4: deviations -1.5, -0.5, 0.5, 1.5; products of neighbours 0.75, -0.25, 0.75 over squares of 5."""
    assert correlogram([1, 2, 3, 4], 2) == pytest.approx([1, 0.25, -0.3])


def test_it_is_the_naive_correlogram():
    series = np.random.default_rng(1).normal(size=50).cumsum()
    assert correlogram(series, 12) == pytest.approx(naive_correlogram(series.tolist(), 12))


def test_a_constant_has_no_correlation_but_with_itself():
    assert correlogram(np.full(9, 0.1), 3).tolist() == [1, 0, 0, 0]
    assert lag_one(np.full(9, 0.1)) == 0
    assert von_neumann(np.full(9, 0.1)) == (2.0, 1.0)


def test_replications_are_pooled_and_never_joined():
    """Two replications that are constant, one high, one low: neighbours within each are alike."""
    assert correlogram([[1.0] * 8, [-1.0] * 8], 1)[1] == pytest.approx(7 / 8)


def test_the_jackknife_takes_the_bias_of_short_series_away():
    """AR(1) with 0.5, 4,000 series of 60 (standard error 0.002): the plain estimate lies 0.05 too low."""
    rng = np.random.default_rng(2)
    state, values = rng.normal(0, np.sqrt(4 / 3), 4000), []
    for _ in range(60):
        values.append(state)
        state = 0.5 * state + rng.normal(size=4000)
    series = np.array(values).T
    plain = np.mean([correlogram(one, 1)[1] for one in series[:1500]])
    assert plain < 0.47 and np.mean([lag_one(one) for one in series[:1500]]) == pytest.approx(0.5, abs=0.015)


def test_von_neumanns_ratio_by_hand_and_its_size():
    """1, 2, 3, 4: squared steps 3 over squares 5; 2 on average where neighbours are independent."""
    assert von_neumann([1, 2, 3, 4])[0] == pytest.approx(0.6)
    rng = np.random.default_rng(3)
    found = np.array([von_neumann(one) for one in rng.normal(size=(2000, 20))])
    assert found[:, 0].mean() == pytest.approx(2.0, abs=0.03)
    assert 0.03 <= np.mean(found[:, 1] <= 0.05) <= 0.07


def test_values_that_are_not_finite_are_refused():
    with pytest.raises(ValueError, match="not finite"):
        correlogram([1.0, np.nan], 1)


def test_a_straight_line_grows_by_what_it_grows():
    by, p = growth(np.arange(1000.0))
    assert by == pytest.approx(1000) and p == 0
    assert growth(np.full(100, 3.0)) == (0.0, 1.0) and growth(-np.arange(1000.0))[1] == 1


@pytest.mark.parametrize("replications", [1, 5])
def test_luck_at_a_load_of_one_is_hardly_ever_taken_for_more(replications):
    """M/M/1 from empty, 4,000 customers, 300 times: at most 2 in 100."""
    made = np.reshape([mm1_waits(1.0, 4000, seed) for seed in range(300 * replications)], (300, replications, 4000))
    assert sum(beyond_luck(rows) for rows in made) <= 6


@pytest.mark.parametrize("load", [0.8, 0.95])
def test_a_stable_queue_is_never_beyond_luck(load):
    assert not any(beyond_luck(mm1_waits(load, 2000, seed)) for seed in range(300))


def test_an_overloaded_queue_is_beyond_luck_in_a_long_run():
    assert sum(beyond_luck(mm1_waits(1.1, 20_000, seed)) for seed in range(50)) >= 48


def test_a_steady_climb_is_beyond_luck_and_a_constant_or_a_fall_is_not():
    climb = np.arange(400.0)
    assert beyond_luck(climb) and beyond_luck([climb, climb + 1])
    assert not beyond_luck(-climb) and not beyond_luck(np.ones(400)) and not beyond_luck([1.0, 2.0, 9.0])


def naive_welch(replications, window):
    """Law's definition, word by word: (2w + 1) values about i, fewer near the start."""
    mean = [sum(values) / len(values) for values in zip(*replications)]
    smooth = []
    for i in range(1, len(mean) - window + 1):
        reach = window if i > window else i - 1
        about = [mean[i - 1 + s] for s in range(-reach, reach + 1)]
        smooth.append(sum(about) / len(about))
    return smooth


def test_smoothing_by_hand():
    """Means 1, 2, 6, 3, 4, 8; one value to either side: 1, (1+2+6)/3, (2+6+3)/3, (6+3+4)/3, (3+4+8)/3."""
    assert welch([[0, 2, 5, 3, 4, 7], [2, 2, 7, 3, 4, 9]], 1) == pytest.approx([1, 3, 11 / 3, 13 / 3, 5])


@pytest.mark.parametrize("window", [0, 1, 7, 25])
def test_it_is_the_naive_curve(window):
    made = np.random.default_rng(window).normal(size=(3, 100)).cumsum(axis=1)
    assert welch(made, window) == pytest.approx(naive_welch(made.tolist(), window))


def test_a_straight_line_stays_itself():
    assert welch(np.arange(40.0), 5) == pytest.approx(np.arange(35.0))


def test_a_window_that_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="expected 0 to 10, a quarter of 40"):
        welch(np.zeros(40), 11)


def summary(*rows):
    return {"kpis": [dict(zip(("kpi", "subject", "part", "mean"), row)) for row in rows]}


def test_stations_are_full_and_nobody_is_free_where_all_say_so():
    rows = [("station_states", "press", "starved", 0.004), ("station_states", "saw", "starved", 0.1)]
    busy, free = ("worker_states", "Ana", "wait", 0.0), ("worker_states", "Ben", "wait", 0.02)
    assert full_stations(summary(*rows, busy)) == ("press",) and nobody_free(summary(*rows, busy))
    assert not nobody_free(summary(busy, free))


def test_what_is_not_known_proves_nothing():
    unknown = summary(("station_states", "press", "starved", None), ("worker_states", "Ana", "wait", None))
    assert full_stations(unknown) == () and not nobody_free(unknown) and not nobody_free(summary())
