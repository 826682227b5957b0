import pytest
from plans import CELL

from opsim.kpi.cycle_times import cycle_times
from opsim.report.sections.yamazumi import yamazumi_section as section
from opsim.report.sections.yamazumi_stacks import LINE, PACE, TAKT, WALKING, station_stacks, worker_stacks
from tests.made_result import BOLD, SCRIPT
from tests.opsim.report.made_floor import charts, floor, renamed, strings, words

TWO = """
opsim: 1
name: two
run: {horizon: 2 h, warm_up: 10 min, seed: 5}
layout: {places: {here: [0 m, 0 m], there: [12 m, 0 m]}}
tasks: {pick: {fixed: 20 s}, turn: {fixed: 25 s, repeat: 2}, run: {fixed: 90 s, automatic: true}}
stations:
  saw:  {at: here, tasks: [pick, turn], buffer: 4}
  mill: {at: there, tasks: [pick, run], servers: 2, buffer: 4}
products: {part: {route: [saw, mill]}}
release: {kind: renewal, every: {fixed: 80 s}}
workers: {ana: {skills: {saw: 1.0}}, ben: {skills: {mill: 1.0}, home: there}}
"""


@pytest.fixture(scope="module")
def cell():
    return floor(CELL)


def test_the_tasks_of_a_bar_sum_to_the_mean_work_of_the_table(cell):
    stacks = station_stacks(cell)
    means = {row["subject"]: row["mean"] for row in cell.rows("cycle_time_s")}
    assert {stack.name for stack in stacks} == set(means)
    for stack in stacks:
        assert stack.work_s * stack.share_of == pytest.approx(means[stack.name])


def test_a_line_by_hand_task_by_task_and_over_its_servers():
    saw, mill = station_stacks(floor(TWO))
    assert saw.tasks == pytest.approx({"pick": 20, "turn": 50}) and saw.share_of == 1
    assert mill.tasks == pytest.approx({"pick": 10, "run": 45}) and mill.share_of == 2
    assert (saw.p10, saw.p90) == pytest.approx((70, 70))
    assert (saw.allowed_s, saw.by, mill.allowed_s) == (80, TAKT, 80)


def test_who_is_over_takt_is_said_and_drawn():
    over = section(floor(TWO, ("every: {fixed: 80 s}", "every: {fixed: 65 s}")))
    assert "Over takt on average: saw (70 s of 65 s)." in words(over)
    assert any(trace["name"].startswith("takt") for trace in charts(over)["yamazumi-stations"]["data"])
    kept = section(floor(TWO))
    assert "every station keeps takt; the fullest is saw with 70 s of 80 s" in words(kept)


def test_where_the_floor_takes_what_it_can_the_pace_stands_for_takt():
    made = floor(TWO, ("release: {kind: renewal, every: {fixed: 80 s}}", "release: {kind: saturated}"))
    saw, _ = station_stacks(made)
    assert saw.by == PACE and saw.allowed_s == pytest.approx(70, rel=0.02)
    assert "Nothing asks for a takt" in words(section(made))


SATURATED = ("release: {kind: renewal, every: {fixed: 80 s}}", "release: {kind: saturated}")


def test_scrap_does_not_slow_the_pace_that_a_station_is_held_against():
    made = floor(TWO, SATURATED, ("turn], buffer: 4", "turn], buffer: 4, scrap: 0.5"))
    saw, mill = station_stacks(made)
    assert saw.allowed_s == pytest.approx(70, rel=0.02) and mill.allowed_s == pytest.approx(140, rel=0.15)
    assert "nearest to it is saw, at work 100 % of the time" in words(section(made))


def test_with_jobs_by_time_and_others_as_there_is_room_nothing_is_held_against_takt():
    sources = "sources: {s1: {kind: saturated}, s2: {kind: renewal, every: {fixed: 300 s}}}"
    made = floor(TWO, (SATURATED[0], sources))
    saw, _ = station_stacks(made)
    assert saw.by == PACE and saw.allowed_s == pytest.approx(70, rel=0.02)
    said = words(section(made))
    assert "Takt is asked for some jobs alone" in said and "keeps takt" not in said


def test_what_feeds_a_paced_line_is_held_against_the_takt_of_the_line():
    line = ("release: {kind: renewal, every: {fixed: 80 s}}", "release: {kind: saturated}\nlines: {l: {kind: indexed, ")
    made = floor(TWO, (line[0], line[1] + "stations: [saw], takt: 90 s}}"), ("turn], buffer: 4", "turn]"))
    assert [(stack.allowed_s, stack.by) for stack in station_stacks(made)] == [(90, LINE), (90, LINE)]


def test_workers_work_as_long_a_job_as_the_rows_say(cell):
    stacks = {stack.name: stack for stack in worker_stacks(cell.log, cell.plan)}
    out = next(row["mean"] for row in cell.rows("throughput_per_h"))
    jobs = out * (cell.plan.window_s[1] - cell.plan.window_s[0]) / 3600
    spent = {row["subject"]: row["mean"] for row in cell.rows("worker_states") if row["part"] == "work"}
    length_s = cell.plan.window_s[1] - cell.plan.window_s[0]
    for name, stack in stacks.items():
        assert stack.work_s * jobs == pytest.approx(spent[name] * length_s)
    assert any(WALKING in stack.beside for stack in stacks.values())


def test_without_rows_tasks_share_as_planned_and_nobody_is_told_of():
    made = floor(TWO, keeps_rows=False)
    saw, _ = station_stacks(made)
    assert saw.tasks == pytest.approx({"pick": 20, "turn": 50})
    assert list(charts(section(made))) == ["yamazumi-stations"]


def test_one_station_has_nothing_to_be_compared_with():
    assert section(floor(TWO, ("route: [saw, mill]", "route: [saw]"))) is None


def test_bars_end_where_the_sum_says_and_whiskers_are_those_of_the_visits(cell):
    figure = charts(section(cell))["yamazumi-stations"]
    ends, parts = {}, []
    for trace in figure["data"]:
        if trace["type"] == "bar":
            parts += zip(trace["y"], trace["base"], trace["x"])
    for row, base, length in sorted(parts):
        assert ends.get(row, 0.0) == pytest.approx(base, abs=1e-3)
        ends[row] = base + length
    stacks = station_stacks(cell)
    assert [ends[row] for row in range(len(stacks))] == pytest.approx([stack.total_s for stack in stacks], abs=1e-3)
    assert sum(len(seconds) for seconds in cycle_times(cell.log, cell.plan).values()) > 100


def test_hostile_names_are_no_markup():
    made = renamed(floor(TWO), saw=SCRIPT, pick=BOLD, ana=SCRIPT)
    for figure in charts(section(made)).values():
        assert not any("<script" in text or "<b>bold" in text for text in strings(figure))
