import pytest
from plans import CELL, line

from opsim.report.plot.plotly import at_ms
from opsim.report.sections.gantt import MOST_BARS, shown_s
from opsim.report.sections.gantt import gantt_section as section
from opsim.report.sections.gantt_rows import of_workers, on_servers, typical_hour_s
from tests.made_result import BOLD, SCRIPT
from tests.opsim.report.made_floor import bars, charts, floor, renamed, strings, words


@pytest.fixture(scope="module")
def cell():
    return floor(CELL)


def test_bars_of_a_row_lie_within_the_time_that_can_be_moved_to(cell):
    figure = charts(section(cell))["gantt-clock"]
    axis = figure["layout"]["xaxis"]
    found = bars(figure)
    assert 100 < len(found) <= MOST_BARS and axis["fixedrange"] is False
    assert axis["minallowed"] <= axis["range"][0] < axis["range"][1] <= axis["maxallowed"]
    assert all(axis["minallowed"] <= begin <= end <= axis["maxallowed"] for _, begin, end, _ in found)


def test_stations_stand_along_the_flow_above_the_people(cell):
    axis = charts(section(cell))["gantt-clock"]["layout"]["yaxis"]
    assert axis["ticktext"] == ["unload", "repack1", "repack2", "store", "ana", "ben", "cai"]
    assert axis["tickvals"] == [0, 1, 2, 3, 5, 6, 7]


def test_as_much_time_is_in_the_page_as_it_has_room_for():
    busy = floor(line(5, 1, horizon="3000 s", warm_up="100 s"))
    hour = typical_hour_s(busy.log, busy.plan)
    both = on_servers(busy.log, busy.plan, 0, 3000), of_workers(busy.log, 0, 3000)
    low_s, high_s = shown_s(*both, busy.plan.window_s, hour)
    assert high_s - low_s < 3000 and sum(one.count(low_s, high_s) for one in both) <= MOST_BARS
    calm = floor(CELL)
    both = on_servers(calm.log, calm.plan, 0, 7200), of_workers(calm.log, 0, 7200)
    assert shown_s(*both, calm.plan.window_s, typical_hour_s(calm.log, calm.plan)) == calm.plan.window_s


def test_the_stretch_that_is_shown_is_said(cell):
    assert "The first replication from " in words(section(cell)) and "names in bars those of stations" in words(
        section(cell)
    )


def test_only_where_there_are_hours_to_choose_from_one_is_called_usual(cell):
    assert "of an hour with as much work as is usual;" in words(section(floor(CELL, ("horizon: 2 h", "horizon: 4 h"))))
    assert "usual" not in words(section(floor(line(3, 1, horizon="1500 s"))))


def test_times_are_those_of_the_rows():
    made = floor(CELL)
    starts = {begin for _, begin, _, _ in bars(charts(section(made))["gantt-clock"])}
    rows = made.log["start_s"]
    assert starts <= {*at_ms(made.plan.start_s, rows).tolist(), *at_ms(made.plan.start_s, made.plan.window_s).tolist()}


def test_without_rows_there_is_no_chart():
    assert section(floor(CELL, keeps_rows=False)) is None


def test_hostile_names_are_no_markup():
    made = renamed(floor(CELL), unload=SCRIPT, ana=BOLD, carton=f"{SCRIPT} x")
    found = charts(section(made))["gantt-clock"]
    assert not any("<script" in text or "<b>bold" in text for text in strings(found))
