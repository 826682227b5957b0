import numpy as np
import pytest
from plans import CELL, line

from opsim.report.sections.wip import Steps, _grows, jobs_inside
from opsim.report.sections.wip import wip_section as section
from tests.made_result import SCRIPT
from tests.opsim.report.made_floor import charts, floor, renamed, strings, words

STEADY = line(3, 1, horizon="4000 s")


@pytest.fixture(scope="module")
def cell():
    return floor(CELL)


def test_the_line_is_how_many_were_inside(cell):
    (trace,) = charts(section(cell))["wip-inside"]["data"]
    inside = jobs_inside(cell.log)
    assert trace["line"]["shape"] == "hv" and len(trace["x"]) <= 602
    assert (max(trace["y"]), trace["y"][-1]) == (inside.level.max(), inside.level[-1])


def test_the_mean_stands_in_the_window_and_the_warm_up_is_shaded(cell):
    figure = charts(section(cell))["wip-inside"]
    shade, mean = figure["layout"]["shapes"]
    row = next(row for row in cell.rows("work_in_progress") if not row["subject"])
    assert (shade["x1"], mean["y0"]) == (mean["x0"], row["mean"])


def test_each_point_has_a_strip_that_says_its_highest_level_and_its_room(cell):
    figure = charts(section(cell))["wip-points"]
    names = figure["layout"]["yaxis"]["ticktext"]
    assert [name.split("<br>")[0] for name in names] == ["unload", "repack1", "repack2", "store"]
    for trace, name in zip(figure["data"], names):
        most, room = name.split("<br>")[1].split(" of ")
        assert max(trace["customdata"]) == int(most) <= int(room)
        assert max(trace["y"]) - min(trace["y"]) <= 1


def test_a_floor_that_fills_up_is_told_of():
    slow = floor(CELL, ("every: 40 s, when_full: lose", "every: 20 s"), ("buffer: 3", "buffer: 5000"))
    assert "They grow" in words(section(slow)) and "They grow" not in words(section(floor(STEADY)))


def test_two_jobs_more_or_a_fifth_more_is_no_growth(cell):
    low_s, high_s = cell.plan.window_s
    for first, second, grows in ((2, 3, False), (20, 24, False), (20, 26, True)):
        steps = Steps(np.array([0.0, (low_s + high_s) / 2]), np.array([first, second]), cell.plan.horizon_s)
        assert bool(list(_grows(cell, steps))) is grows


def test_where_no_room_is_left_is_said_but_not_of_a_station_that_is_full_by_plan():
    jammed = floor(STEADY.replace("t3: {dist: exponential, mean: 1 s}", "t3: {fixed: 4 s}"))
    said = words(section(jammed))
    assert "No room is left at s2 (" in said and "s3 (" in said and "s1 (" not in said


def test_jobs_that_are_as_many_all_the_time_are_said_once():
    cards = floor(line(2, 1, horizon="2000 s") + "\ncards: {loop: {n: 2, products: [part]}}")
    assert words(section(cards)).startswith("In the first replication there are always 2 jobs inside.")


def test_without_rows_there_is_nothing_over_the_clock():
    assert section(floor(CELL, keeps_rows=False)) is None


def test_hostile_names_are_no_markup():
    made = section(renamed(floor(CELL), unload=SCRIPT))
    assert not any("<script" in text for figure in charts(made).values() for text in strings(figure))
