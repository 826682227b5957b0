import numpy as np
import pytest
from plans import CELL, line

from opsim.report.plot.plotly import at_ms
from opsim.report.sections.bottleneck import CELLS, _bars, bottleneck_rows, moments
from opsim.report.sections.bottleneck import bottleneck_section as section
from tests.made_result import SCRIPT
from tests.opsim.kpi.made_logs import work
from tests.opsim.report.made_floor import bars, charts, floor, renamed, strings, words

THREE = line(3, 0, horizon="40 s", warm_up="0 s")
ROWS = [work(0, 10, 0), work(6, 20, 1), work(12, 16, 2), work(30, 35, 1, job=1), work(32, 34, 2, job=1)]
"""The first station 0-10, the second 6-20 and 30-35, the third within the second's."""


@pytest.fixture(scope="module")
def slow():
    text = line(3, 1, horizon="6000 s").replace("t2: {dist: exponential, mean: 1 s}", "t2: {fixed: 3 s}")
    return floor(text)


def test_the_strip_shows_who_was_it_when():
    made = floor(THREE, rows=ROWS)
    edges_s, rank = moments(made.log, made.plan)
    assert [(a, b, r) for a, b, r in zip(edges_s, edges_s[1:], rank.tolist())] == [
        (0, pytest.approx(6), 0),
        (pytest.approx(6), pytest.approx(20), 1),
        (pytest.approx(20), pytest.approx(30), -1),
        (pytest.approx(30), pytest.approx(35), 1),
        (pytest.approx(35), 40, -1),
    ]
    drawn = [(row, begin, end) for row, begin, end, _ in bars(charts(section(made))["bottleneck-strip"])]
    start = made.plan.start_s
    assert drawn == [(row, *at_ms(start, span).tolist()) for row, span in ((0, (0, 6)), (1, (6, 20)), (1, (30, 35)))]


def test_bars_are_the_shares_of_the_table_and_sum_to_one_with_what_is_left(slow):
    figure = charts(section(slow))["bottleneck-shares"]
    rows = {(row["subject"], row["part"]): row["mean"] for row in slow.rows("bottleneck")}
    sole = sum(end - begin for _, begin, end, name in bars(figure) if name.startswith("alone"))
    assert sole / 100 + rows["", "shifting"] + rows["", "none"] == pytest.approx(1, abs=0.02)


def test_moments_tile_the_run(slow):
    edges_s, rank = moments(slow.log, slow.plan)
    assert (edges_s[0], edges_s[-1]) == (0, slow.plan.horizon_s) and rank.size <= CELLS
    assert np.all(np.diff(edges_s) > 0) and np.all(rank[1:] != rank[:-1])


def test_the_slowest_station_is_named_with_what_it_means(slow):
    said = words(section(slow))
    assert said.startswith("s2 is the bottleneck for") and "So it sets the pace: time saved at s2" in said
    assert "Ahead of it stations are blocked for" in said and "behind it they have no job for" in said


DEMAND = """
opsim: 1
name: Demand limited
run: {horizon: 8 h, warm_up: 30 min, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [4 m, 0 m]}}
tasks: {t1: {fixed: 60 s, automatic: true}, t2: {fixed: 20 s, automatic: true}}
stations: {one: {at: a, tasks: [t1], buffer: 6}, two: {at: b, tasks: [t2], buffer: 6}}
products: {pump: {route: [one, two]}}
release: {kind: poisson, every: 100 s}
"""
SHIFTS = """
opsim: 1
name: Closed
run: {start: Mon 06:00, horizon: 24 h, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [4 m, 0 m]}}
shifts: {early: {from: 06:00, to: 10:00, days: [Mon, Tue]}}
tasks: {t1: {fixed: 60 s}, t2: {fixed: 30 s}}
stations: {one: {at: a, tasks: [t1], buffer: 6}, two: {at: b, tasks: [t2], buffer: 6}}
products: {pump: {route: [one, two]}}
release: {kind: saturated}
workers: {ann: {home: a, shift: early, skills: {one: 1.0}}, bob: {home: b, shift: early, skills: {two: 1.0}}}
"""


def test_where_the_floor_keeps_up_with_what_comes_demand_sets_the_pace():
    said = words(section(floor(DEMAND)))
    assert "Yet demand sets the pace" in said and "So it sets the pace" not in said
    full = words(section(floor(DEMAND, ("every: 100 s", "every: 30 s"), ("buffer: 6", "buffer: 5000"))))
    assert "So it sets the pace" in full and "demand" not in full, "more comes than can leave"


def test_shares_are_of_the_time_for_which_the_floor_is_open():
    made = floor(SHIFTS)
    said, figure = words(section(made)), charts(section(made))["bottleneck-shares"]
    assert "one is the bottleneck for 100.0 % of the open time" in said and "So it sets the pace" in said
    assert "no station is busy" not in said
    assert sum(end - begin for row, begin, end, _ in bars(figure) if row == 0) == pytest.approx(100, abs=0.1)
    rows = {(row["subject"], row["part"]): row["mean"] for row in bottleneck_rows(made)}
    assert rows["one", "momentary"] == pytest.approx(1, abs=1e-3) and rows["", "none"] == pytest.approx(0, abs=1e-3)
    table = {(row["subject"], row["part"]): row["mean"] for row in made.rows("bottleneck")}
    assert table["one", "momentary"] == pytest.approx(4 / 24, abs=1e-3)


def test_the_axis_does_not_make_much_of_small_shares():
    seldom = _bars({"a": {"sole": 0.08}}, ["a"])
    often = _bars({"a": {"sole": 0.7, "shifting": 0.1}}, ["a"])
    assert seldom["layout"]["xaxis"]["range"] == [0, 25]
    assert often["layout"]["xaxis"]["range"] == [0, pytest.approx(83.2)]


def test_blocking_is_told_of_what_comes_before_and_starving_of_what_comes_behind():
    """Three stations of 1, 3 and 1 s without a wobble: the first blocked, the last without a job, for 2 s of every 3"""
    text = line(3, 1, horizon="6000 s")
    for n, seconds in ((1, 1), (2, 3), (3, 1)):
        text = text.replace(f"t{n}: {{dist: exponential, mean: 1 s}}", f"t{n}: {{fixed: {seconds} s}}")
    assert (
        "Ahead of it stations are blocked for 67 % of the time on average, behind it they have no job for 67 % and "
        "s2 itself is blocked for 0 % and without a job for 0 %."
    ) in words(section(floor(text)))


def test_one_that_is_so_for_three_fifths_of_the_time_is_still_the_one():
    rows = [work(0, 24, 0), work(24, 40, 1)]
    assert "So it sets the pace" in words(section(floor(THREE, rows=rows)))


def test_where_it_moves_that_is_said():
    said = words(section(floor(line(3, 1, horizon="6000 s"))))
    assert "No station holds up the floor by itself: it moves between" in said


def test_where_nobody_is_busy_no_station_is_blamed():
    calm = floor(CELL, ("every: 40 s", "every: 200 s"))
    assert "no station is busy on all its servers" in words(section(calm))


def test_one_station_cannot_be_narrower_than_others():
    assert section(floor(line(1, 1, horizon="600 s", warm_up="10 s"))) is None


def test_without_rows_the_shares_stand_alone():
    assert list(charts(section(floor(CELL, keeps_rows=False)))) == ["bottleneck-shares"]


def test_hostile_names_are_no_markup():
    made = section(renamed(floor(CELL), unload=SCRIPT, repack1=SCRIPT + "2"))
    assert not any("<script" in text for figure in charts(made).values() for text in strings(figure))
