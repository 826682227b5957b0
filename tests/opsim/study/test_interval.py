import math

import numpy as np
import pytest

from opsim.study.intervals import quantile_interval, t_interval


def test_the_textbook_interval():
    """Law, Simulation Modeling and Analysis, example 9.14: mean 2.03, half-width 0.32 at 90 %."""
    found = t_interval([1.53, 1.66, 1.24, 2.34, 2.00, 1.69, 2.69, 2.86, 1.70, 2.60], 0.90)
    assert found.mean == pytest.approx(2.031, abs=1e-9)
    assert found.half_width == pytest.approx(0.3222834049417794, abs=1e-9)


def test_one_value_has_no_interval_and_none_has_no_mean():
    assert t_interval([3.0]).mean == 3.0 and np.isnan(t_interval([3.0]).half_width)
    assert t_interval([]).n == 0 and np.isnan(t_interval([]).mean)


def test_unknown_values_are_left_out_and_show():
    assert t_interval([1.0, np.nan, 3.0]).n == 2
    assert t_interval([1.0, np.nan, 3.0]).mean == 2.0


def test_the_interval_covers_as_often_as_it_says():
    rng = np.random.default_rng(0)
    hits = sum(abs(i.mean) <= i.half_width for i in (t_interval(rng.normal(size=8)) for _ in range(4000)))
    assert abs(hits / 4000 - 0.95) < 4 * np.sqrt(0.95 * 0.05 / 4000)


@pytest.mark.parametrize(
    "n, q, low, high, coverage",
    [
        (100, 0.5, 40, 61, 0.9648),  # the classical interval of a median
        (10, 0.5, 2, 9, 0.9785),
        (6, 0.5, 1, 6, 0.96875),
    ],
)
def test_order_statistics_that_bound_a_median_are_those_of_the_tables(n, q, low, high, coverage):
    found = quantile_interval(np.arange(1, n + 1), q)
    assert (found.low, found.high) == (low, high)
    assert found.coverage == pytest.approx(coverage, abs=5e-5)


@pytest.mark.parametrize("n, q", [(37, 0.3), (100, 0.1), (20, 0.5), (200, 0.9)])
def test_the_interval_of_a_quantile_is_the_narrowest_that_keeps_each_side(n, q):
    found = quantile_interval(np.arange(1, n + 1), q)
    chance = [math.comb(n, i) * q**i * (1 - q) ** (n - i) for i in range(n + 1)]
    low, high = int(found.low), int(found.high)
    assert sum(chance[:low]) <= 0.025 < sum(chance[: low + 1])
    assert sum(chance[high:]) <= 0.025 < sum(chance[high - 1 :])
    assert found.coverage == pytest.approx(sum(chance[low:high]))


def test_too_few_values_do_not_bound_a_far_quantile():
    found = quantile_interval(range(10), 0.9)
    assert found.high == np.inf and np.isfinite(found.low) and found.coverage >= 0.95
    assert quantile_interval([], 0.5).n == 0 and quantile_interval([np.nan, 1.0], 0.5).n == 1
    with pytest.raises(ValueError, match="between 0 and 1"):
        quantile_interval([1.0], 1.0)


def test_the_interval_of_a_quantile_covers_as_often_as_it_says():
    rng = np.random.default_rng(1)
    found = [quantile_interval(rng.exponential(size=40), 0.75) for _ in range(4000)]
    hits = np.mean([i.low <= np.log(4) <= i.high for i in found])
    assert abs(hits - found[0].coverage) < 4 * np.sqrt(0.95 * 0.05 / 4000)


@pytest.mark.slow
def test_intervals_of_mean_waiting_times_cover_the_truth_of_a_queue(capsys):
    """M/M/1 at load 0.5, begun in its steady state: mean wait 1 service. 2,000 studies of 10 replications each."""
    rng, load, studies, replications, customers = np.random.default_rng(2026), 0.5, 2000, 10, 2000
    shape = (studies, replications)
    wait = np.where(rng.random(shape) < load, rng.exponential(1 / (1 - load), shape), 0.0)
    total = np.zeros(shape)
    for _ in range(customers):  # Lindley 1952
        total += wait
        wait = np.maximum(wait + rng.exponential(1.0, shape) - rng.exponential(1 / load, shape), 0.0)
    intervals = [t_interval(row) for row in total / customers]
    covered = np.mean([i.low <= load / (1 - load) <= i.high for i in intervals])
    with capsys.disabled():
        print(f"\ncoverage of the 95 % interval: {covered:.4f}", end="")
    assert 0.935 <= covered <= 0.965
