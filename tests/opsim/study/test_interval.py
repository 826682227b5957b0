"""Statistics against the cases of ``known_answers.json``."""

import json
import math

import numpy as np
import pytest
from plans import CELL, loaded
from recordings import reference

from opsim.kpi import Figure
from opsim.study import run_scenario
from opsim.study.intervals import (
    NoSuchFigure,
    Precision,
    quantile_interval,
    read_precision,
    replicate_until,
    t_interval,
)
from opsim.study.long_run.warm_up import mser
from opsim.study.replication import Replicated


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


WANTED = Precision("throughput_per_h", "", "", 0.05)


def until(values, most=1000, wanted=(WANTED,)):
    """(number used, numbers run, what was reached) where replication r gives values[r]."""
    ran = []

    def run(first, upto):
        ran.extend(range(first, upto))
        return [Replicated(r, [Figure("throughput_per_h", "", "", "1/h", values[r])], {}) for r in range(first, upto)]

    done, reached = replicate_until(wanted, most, run)
    return len(done), ran, reached


def naive(values, relative, most):
    for n in range(10, most + 1):
        interval = t_interval(values[:n])
        if interval.half_width / abs(interval.mean) <= relative / (1 + relative):
            return n
    return most


@pytest.mark.parametrize("seed", range(12))
def test_it_stops_at_the_first_number_that_is_enough_however_they_came_in_batches(seed):
    values = np.random.default_rng(seed).normal(100, 30, 1000)
    n, ran, (reached,) = until(values)
    assert n == naive(values, 0.05, 1000) and ran == list(range(len(ran))) and len(ran) >= n
    assert reached.reached and reached.n == n


def test_ten_are_run_even_where_two_would_do():
    assert until([100.0, 100.1] * 20)[0] == 10
    n, _, (reached,) = until([5.0] * 20)
    assert n == 10 and reached.found == 0 and reached.reached


def test_the_most_that_is_allowed_ends_it_and_is_said():
    n, ran, (reached,) = until(np.random.default_rng(0).normal(100, 90, 60), most=60)
    assert n == 60 == len(ran) and not reached.reached and reached.words.endswith("not reached")
    assert until([100.0] * 20, most=4)[0] == 4 and not until([100.0] * 20, most=4)[2][0].reached


@pytest.mark.parametrize("value", [0.0, np.nan])
def test_a_mean_of_nothing_is_known_only_where_it_never_varies(value):
    n, _, (reached,) = until([value, -value, *[value] * 30] + [1.0, -1.0] * 10, most=40)
    assert (n, reached.reached) == ((10, True) if value == 0 else (40, False))


def test_every_precision_that_is_wanted_must_be_reached():
    values = np.random.default_rng(1).normal(100, 30, 1000)
    loose = Precision("throughput_per_h", "", "", 0.2)
    assert until(values, wanted=(loose, WANTED))[0] == until(values)[0] > until(values, wanted=(loose,))[0]


def test_a_figure_that_the_run_does_not_have_is_named():
    with pytest.raises(NoSuchFigure, match="did you mean 'throughput_per_h'"):
        until([1.0] * 20, wanted=(Precision("throughput_per_h", "carton", "", 0.1),))


@pytest.mark.parametrize(
    "text, found",
    [
        ("throughput_per_h=1%", Precision("throughput_per_h", "", "", 0.01)),
        ("worker_states/ana/work = 2.5 %", Precision("worker_states", "ana", "work", 0.025)),
    ],
)
def test_a_precision_is_read(text, found):
    assert read_precision(text) == found


@pytest.mark.parametrize(
    "text, said",
    [
        ("throughput_per_h", "expected FIGURE=PER CENT"),
        ("throughput_per_h=1", "expected FIGURE=PER CENT"),
        ("throughput_per_h=0%", "expected FIGURE=PER CENT"),
        ("throughput_per_h=1.2.3%", "expected FIGURE=PER CENT"),
        ("troughput_per_h=1%", "did you mean 'throughput_per_h'"),
    ],
)
def test_a_precision_that_cannot_be_meant_is_refused(text, said):
    with pytest.raises(ValueError, match=said):
        read_precision(text)


def test_a_run_to_a_precision_says_how_many_it_took_and_why(tmp_path):
    cell = loaded(CELL.replace("horizon: 2 h", "horizon: 30 min"))
    wanted = [Precision("throughput_per_h", "", "", 0.3)]
    result = run_scenario(cell, folder=tmp_path, processes=1, precision=wanted)
    n = result.summary["replications"]
    (found,) = result.summary["precision"]
    assert n > 10 and found["reached"] and found["found"] <= 0.3 / 1.3
    assert f"replications: {n}" in (tmp_path / "scenario.resolved.yaml").read_text()
    assert any(f"replications: {n}, as many as needed" in line["says"] for line in result.summary["assumptions"])
    fixed = run_scenario(cell, folder=tmp_path, processes=1, replications=n)
    assert fixed.summary["kpis"] == result.summary["kpis"]


def case(name: str) -> dict:
    entries = json.loads(reference("known_answers.json").read_text())
    return next(entry for entry in entries if entry["name"] == name)


def test_mser_cuts_the_step_series_where_the_reference_does():
    expected = case("MSER-5, step series")["expected"]["truncation"]
    series = np.r_[np.full(100, 10.0), np.tile([0.0, 1.0, 0.0, 1.0, 0.5], 180)]
    assert mser(series) == expected


def test_the_t_interval_is_that_of_the_reference():
    expected = case("t interval from 10 replications")["expected"]
    interval = t_interval([1.53, 1.66, 1.24, 2.34, 2.00, 1.69, 2.69, 2.86, 1.70, 2.60], 0.90)
    assert interval.mean == pytest.approx(expected["mean"], abs=1e-9)
    assert interval.half_width == pytest.approx(expected["half_width"], abs=1e-9)
