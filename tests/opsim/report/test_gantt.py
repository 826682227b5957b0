"""Variants that differ in nothing but ``run: variability``."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from plans import CELL, line, plan, ran

from opsim.kpi.states import STATES, states_of_rows
from opsim.log import BLOCKED, CREATE, DOWN, HELD, IDLE, JOB_KINDS, LEAVING_KINDS, NO_WORKER, WAIT, WALK
from opsim.report.plot.plotly import at_ms
from opsim.report.sections.gantt import MOST_BARS, shown_s
from opsim.report.sections.gantt import gantt_section as section
from opsim.report.sections.gantt_rows import NOT_DRAWN, of_workers, on_servers, standing, typical_hour_s
from opsim.report.sections.variability import switched_variants
from opsim.report.sections.wip import Steps, jobs_at, jobs_inside, share_full, steps_of, thinned
from opsim.study.resolved_scenario import resolved_text
from opsim.subjects.material.plan import jobs_on_a_server
from opsim.subjects.stations.figures import ON_SERVER
from tests.made.result import BOLD, SCRIPT
from tests.opsim.kpi.made_logs import made, row, work
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


TWO = line(2, 0, horizon="100 s", warm_up="0 s")
ROWS = [
    work(0, 10, 0, job=0, worker=0),
    work(10, 15, 0, job=0, worker=0, task=1),
    row(BLOCKED, 15, 20, station=0, job=0),
    row(HELD, 20, 22, station=1, job=0, cause=NO_WORKER),
    work(22, 40, 1, job=0, worker=1),
    work(20, 60, 0, job=1, worker=0),
    row(DOWN, 70, 90, station=1),
    row(WALK, 15, 18, worker=0, places=(0, 0)),
    row(WAIT, 40, 100, worker=1, cause=IDLE),
]


@pytest.fixture(scope="module")
def gantt_rows_cell():
    return ran(CELL)


def test_a_state_of_a_job_is_one_bar_whatever_its_tasks():
    p = plan(TWO)
    found = [
        (s.row, s.what, s.start_s, s.end_s, s.job, s.cause) for s in on_servers(made(ROWS, p), p, 5, 90).between(5, 90)
    ]
    assert found == [
        (0, "work", 5, 15, 0, ""),
        (0, "blocked", 15, 20, 0, ""),
        (0, "work", 20, 60, 1, ""),
        (1, "held", 20, 22, 0, "worker"),
        (1, "work", 22, 40, 0, ""),
    ]


def test_a_station_that_is_down_is_a_bar_of_its_own():
    p = plan(TWO)
    assert [(s.row, s.what, s.start_s, s.end_s) for s in standing(made(ROWS, p), p, 0, 80)] == [(1, "down", 70, 80)]


def test_workers_show_work_and_walks_and_no_idleness():
    p = plan(TWO)
    found = [(s.row, s.what, s.start_s, s.end_s) for s in of_workers(made(ROWS, p), 0, 100).between(0, 100)]
    assert found == [(0, "work", 0, 15), (0, "walk", 15, 18), (0, "work", 20, 60), (1, "work", 22, 40)]


def test_bars_of_a_station_never_overlap_in_a_lane_nor_have_more_lanes_than_servers(gantt_rows_cell):
    log, p = gantt_rows_cell
    lanes = {}
    for one in on_servers(log, p, 0, p.horizon_s).between(0, p.horizon_s):
        most = p.stations[one.row].servers * jobs_on_a_server(p, one.row)
        assert one.lane < one.lanes <= most
        lanes.setdefault((one.row, one.lane), []).append((one.start_s, one.end_s))
    assert len(lanes) == sum(station.servers for station in p.stations)
    for spans in lanes.values():
        spans.sort()
        assert all(end <= start + 1e-6 for (_, end), (start, _) in pairwise(spans))


def test_bars_hold_all_the_time_that_the_rows_have(gantt_rows_cell):
    log, p = gantt_rows_cell
    on = np.isin(log["kind"], ON_SERVER) & (log["job"] >= 0) & (log["station"] >= 0)
    drawn = sum(s.end_s - s.start_s for s in on_servers(log, p, 0, p.horizon_s).between(0, p.horizon_s))
    assert drawn == pytest.approx((log["end_s"] - log["start_s"])[on].sum())
    rows, state = states_of_rows(log)
    shown = ~np.isin(state, [STATES.index(name) for name in NOT_DRAWN])
    people = sum(s.end_s - s.start_s for s in of_workers(log, 0, p.horizon_s).between(0, p.horizon_s))
    assert people == pytest.approx((log["end_s"] - log["start_s"])[rows[shown]].sum())


def test_as_many_are_counted_as_are_made(gantt_rows_cell):
    log, p = gantt_rows_cell
    for found in (on_servers(log, p, 0, p.horizon_s), of_workers(log, 0, p.horizon_s)):
        for span in ((0.0, 600.0), (1000.0, 1010.0), (0.0, p.horizon_s)):
            assert found.count(*span) == len(found.between(*span))


def test_the_hour_is_the_first_one_with_as_much_work_as_is_usual():
    hours = line(2, 0, horizon="6 h", warm_up="30 min")
    p = plan(hours)
    shares = [3000, 100, 900, 1000, 1100, 900]
    rows = [work(3600 * n, 3600 * n + s, 0, job=n, worker=0) for n, s in enumerate(shares)]
    assert typical_hour_s(made(rows, p), p) == (3600 * 2, 3600 * 3)
    assert typical_hour_s(made([], p), p) == (3600, 7200)
    short = plan(line(2, 0, horizon="40 min", warm_up="10 min"))
    assert typical_hour_s(made(rows[:1], short), short) == (600, 2400)


@pytest.fixture(scope="module")
def steps_cell():
    return ran(CELL)


def test_jobs_that_come_and_go_at_one_instant_are_one_step():
    steps = steps_of(np.array([0.0, 5.0, 7.0]), np.array([5.0, 9.0]), 10.0)
    assert (steps.at_s.tolist(), steps.level.tolist()) == ([0, 7, 9], [1, 2, 1])
    assert steps.mean == pytest.approx((7 * 1 + 2 * 2 + 1 * 1) / 10)


def test_jobs_inside_are_those_created_less_those_who_left(steps_cell):
    log, plan = steps_cell
    inside = jobs_inside(log)
    for at_s, level in zip(inside.at_s, inside.level):
        come = np.count_nonzero(log["end_s"][log["kind"] == CREATE] <= at_s)
        gone = np.count_nonzero(log["end_s"][np.isin(log["kind"], LEAVING_KINDS)] <= at_s)
        assert level == come - gone
    assert inside.end_s == plan.horizon_s


def test_those_at_points_and_those_nowhere_are_all_jobs_inside(steps_cell):
    log, plan = steps_cell
    rows = (log["job"] >= 0) & (log["station"] < 0) & np.isin(log["kind"], JOB_KINDS)
    nowhere_s = (log["end_s"][rows] - log["start_s"][rows]).sum()
    there_s = sum((steps.level * steps.seconds).sum() for steps in jobs_at(log, len(plan.stations)))
    inside = jobs_inside(log)
    assert there_s + nowhere_s == pytest.approx((inside.level * inside.seconds).sum())


def test_a_window_cuts_the_first_and_the_last_level():
    steps = Steps(np.array([0.0, 4.0, 8.0]), np.array([1, 3, 0]), 10.0).within(2.0, 6.0)
    assert (steps.at_s.tolist(), steps.level.tolist(), steps.seconds.tolist()) == ([2, 4], [1, 3], [2, 2])


def test_a_thinned_line_keeps_every_peak_and_both_ends():
    rng = np.random.default_rng(2)
    level = np.abs(np.cumsum(rng.choice([-1, 1], 20_000)))
    steps = Steps(np.sort(np.r_[0.0, rng.uniform(0, 900, 19_999)]), level, 1000.0)
    at_s, shown = thinned(steps, 600)
    assert at_s.size <= 602 and (at_s[0], at_s[-1]) == (0.0, 1000.0) and shown[-1] == level[-1]
    assert (shown.min(), shown.max()) == (level.min(), level.max())
    assert np.all(np.diff(at_s) >= 0)
    few = Steps(np.array([0.0, 1.0]), np.array([0, 1]), 2.0)
    assert [part.tolist() for part in thinned(few, 600)] == [[0, 1, 2], [0, 1, 1]]


def test_the_share_without_room_is_of_the_window():
    steps = Steps(np.array([0.0, 4.0, 8.0]), np.array([1, 3, 0]), 10.0)
    assert share_full(steps, 3, (5.0, 10.0)) == pytest.approx(0.6)
    assert share_full(steps, np.inf, (5.0, 10.0)) == 0


RUN = {"start": "Mon 06:00", "horizon": "12 h", "replications": 3, "seed": 11}


def switched_variants_made(folder, **variants):
    found = {}
    for name, (run, rest) in variants.items():
        (folder / name).mkdir()
        text = resolved_text({"opsim": 1, "name": "cell", "run": run, "layout": rest})
        (folder / name / "scenario.resolved.yaml").write_text(text, encoding="utf-8")
        found[name] = SimpleNamespace(folder=folder / name)
    return found


@pytest.mark.parametrize("last", [True, False])
def test_they_are_found_wherever_the_switch_stands(tmp_path, last):
    def run(switch):
        return {**RUN, "variability": switch} if last else {"variability": switch, **RUN}

    here = {"distance": "euclidean"}
    siblings = switched_variants_made(
        tmp_path,
        base=(RUN, here),
        alike=(run("within_only"), here),
        calm=(run("none"), here),
        elsewhere=(run("between_only"), {"distance": "rectilinear"}),
    )
    assert switched_variants(siblings, "base") == {"full": "base", "within_only": "alike", "none": "calm"}
    assert switched_variants(siblings, "calm") == {"none": "calm", "full": "base", "within_only": "alike"}
    assert switched_variants(siblings, "elsewhere") == {"between_only": "elsewhere"}


def test_a_variant_in_a_folder_of_another_name_has_none(tmp_path):
    siblings = switched_variants_made(tmp_path, base_old=(RUN, {}), calm=({**RUN, "variability": "none"}, {}))
    assert switched_variants(siblings, "base") == {}


def test_a_study_that_varies_it_is_no_switch(tmp_path):
    studies = {"vary": {"run.variability": ["none", "full"]}}
    siblings = switched_variants_made(tmp_path, base=(RUN, studies), other=({**RUN, "variability": "none"}, studies))
    assert switched_variants(siblings, "base") == {"full": "base", "none": "other"}
