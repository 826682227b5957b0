"""Which station holds up the floor.

Active periods of stations.
"""

from itertools import pairwise

import numpy as np
import pytest
from plans import CELL, line, plan

from opsim.engine.floor.run import run_plan
from opsim.kpi.states import Periods, active_periods, active_time, bottleneck, longest_under_way
from opsim.log import WORK
from tests.opsim.kpi.made_logs import made, work

THREE = line(3, 0, horizon="40 s", warm_up="0 s")
ROWS = [work(0, 10, 0), work(6, 20, 1), work(12, 16, 2), work(30, 35, 1, job=1), work(32, 34, 2, job=1)]
"""The first station 0-10, the second 6-20 and 30-35, the third within the second's."""


def shares(log, p):
    return {(f.subject, f.part): f.value for f in bottleneck(log, p)}


def seconds(text, rows=ROWS):
    p = plan(text)
    length_s = p.window_s[1] - p.window_s[0]
    return {key: round(value * length_s, 9) for key, value in shares(made(rows, p), p).items() if value}


def naive_bottleneck(periods, p):
    """Seconds by (station, part), asking between any two moments at which something begins or ends."""
    low, high = p.window_s
    every = list(zip(periods.station.tolist(), periods.start_s.tolist(), periods.end_s.tolist()))
    edges = sorted({low, high, *(at for _, *ends in every for at in ends if low < at < high)})

    def under_way(at_s):
        return [period for period in every if period[1] < at_s < period[2]]

    def longest(some):
        return max(some, key=lambda period: (period[2] - period[1], -period[0]))

    all_edges = sorted({at for _, *ends in every for at in ends})
    middles = [(a + b) / 2 for a, b in pairwise(all_edges)]
    chosen = {longest(some) for at_s in middles if (some := under_way(at_s))}
    spent: dict = {}
    for start, end in pairwise(edges):
        some = under_way((start + end) / 2)
        parts = [("", "none")] if not some else [(longest(some)[0], "momentary")]
        rivals = [period for period in some if period in chosen]
        parts += [(period[0], "sole" if len(rivals) == 1 else "shifting") for period in rivals]
        parts += [("", "shifting")] if len(rivals) > 1 else []
        for part in parts:
            spent[part] = spent.get(part, 0.0) + end - start
    return spent


def test_three_stations_by_hand():
    assert seconds(THREE) == {
        ("s1", "momentary"): 6,
        ("s1", "sole"): 6,
        ("s1", "shifting"): 4,
        ("s2", "momentary"): 19,
        ("s2", "sole"): 15,
        ("s2", "shifting"): 4,
        ("", "shifting"): 4,
        ("", "none"): 15,
    }


def test_a_period_counts_whole_but_its_time_only_in_the_window():
    assert seconds(THREE.replace("warm_up: 0 s", "warm_up: 8 s")) == {
        ("s1", "shifting"): 2,
        ("s2", "momentary"): 17,
        ("s2", "sole"): 15,
        ("s2", "shifting"): 2,
        ("", "shifting"): 2,
        ("", "none"): 15,
    }


def test_of_equally_long_periods_the_first_station_is_taken():
    found = seconds(THREE, [work(0, 10, 1), work(0, 10, 0)])
    assert (found["s1", "sole"], found["", "none"]) == (10, 30)


def test_nobody_at_work_is_no_bottleneck():
    assert seconds(THREE, []) == {("", "none"): 40}


@pytest.mark.parametrize("seed", range(20))
def test_shares_are_those_of_the_naive_twin(seed):
    rng = np.random.default_rng(seed)
    p = plan(line(5, 0, horizon="200 s", warm_up="40 s"))
    ends = [np.sort(rng.choice(201, 2 * rng.integers(1, 12), replace=False)) for _ in p.stations]
    rows = [work(a, b, rank, job=rank) for rank, at in enumerate(ends) for a, b in at.reshape(-1, 2)]
    log = made(rows, p)
    naive = naive_bottleneck(active_periods(log, p), p)
    names = {name: rank for rank, name in enumerate(s.name for s in p.stations)}
    for (station, part), share in shares(log, p).items():
        assert share * 160 == pytest.approx(naive.get((names.get(station, ""), part), 0.0), abs=1e-9), (station, part)


@pytest.mark.parametrize("text", [CELL, line(6, 2, horizon="2000 s")])
def test_shares_sum_to_one_in_both_ways(text):
    p = plan(text)
    found = shares(run_plan(p), p)
    for part, rest in (("momentary", 0.0), ("sole", found["", "shifting"])):
        assert sum(v for (of, what), v in found.items() if of and what == part) + rest + found["", "none"] == (
            pytest.approx(1, abs=1e-12)
        )
    assert all(value >= 0 for value in found.values())


def test_the_slowest_station_is_the_bottleneck():
    slow = "t4: {dist: exponential, mean: 2 s}"
    p = plan(line(5, 1, horizon="4000 s").replace("t4: {dist: exponential, mean: 1 s}", slow))
    log = run_plan(p)
    found = shares(log, p)
    active_s = {f.subject: f.value for f in active_time(log, p)}
    assert active_s["s4"] > 2 * max(value for name, value in active_s.items() if name != "s4")
    for part in ("momentary", "sole"):
        assert found["s4", part] > sum(v for (of, what), v in found.items() if what == part and of not in ("", "s4"))


def test_one_long_period_over_many_short_ones_is_the_longest_everywhere():
    short = np.arange(1, 1000.0)
    periods = Periods(np.r_[np.zeros(999, int), 1], np.r_[short, 0.0], np.r_[short + 0.5, 2000.0])
    edges_s, longest = longest_under_way(periods)
    assert edges_s.size == 2000 and set(longest) == {999}


TWO_SERVERS = """
opsim: 1
name: two servers and one
run: {horizon: 100 s, warm_up: 20 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {a: {at: here, tasks: [t], servers: 2, buffer: 0}, b: {at: here, tasks: [t], buffer: 0}}
products: {p: {route: [a, b]}}
release: {kind: saturated}
"""


def periods(rows, p):
    found = active_periods(made(rows, p), p)
    return list(zip(found.station.tolist(), found.start_s.tolist(), found.end_s.tolist()))


def test_a_period_runs_from_job_to_job_and_ends_with_a_wait():
    p = plan(TWO_SERVERS)
    assert periods([work(0, 10, 1), work(10, 15, 1, job=1), work(16, 30, 1, job=2)], p) == [(1, 0, 15), (1, 16, 30)]


def test_a_station_of_two_servers_is_active_while_both_work():
    p = plan(TWO_SERVERS)
    rows = [work(0, 10, 0), work(5, 15, 0, job=1), work(10, 12, 0, job=2), work(14, 20, 0, job=3)]
    assert periods(rows, p) == [(0, 5, 12), (0, 14, 15)]


def test_no_work_is_no_period():
    p = plan(TWO_SERVERS)
    assert periods([], p) == []
    assert all(np.isnan(figure.value) for figure in active_time(made([], p), p))


def test_periods_that_end_in_the_warm_up_do_not_count_and_others_count_whole():
    p = plan(TWO_SERVERS)
    rows = [work(0, 5, 1), work(10, 30, 1, job=1), work(50, 60, 1, job=2)]
    assert {f.subject: f.value for f in active_time(made(rows, p), p)}["b"] == 15


@pytest.mark.parametrize("text", [CELL, line(4, 1, horizon="1500 s")])
def test_of_one_server_the_periods_hold_all_of_its_work_and_do_not_meet(text):
    p = plan(text)
    log = run_plan(p)
    found = active_periods(log, p)
    for rank, station in enumerate(p.stations):
        here = found.station == rank
        assert np.all(found.start_s[here][1:] > found.end_s[here][:-1])
        if station.servers == 1:
            worked_s = log.duration_s[(log["kind"] == WORK) & (log["station"] == rank)].sum()
            assert (found.end_s - found.start_s)[here].sum() == pytest.approx(worked_s)
