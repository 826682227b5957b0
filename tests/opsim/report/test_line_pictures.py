import numpy as np
import pytest
from plans import CELL, line, queue

from opsim.kpi.cycle_times import cycle_times
from opsim.report.plot.plotly import at_ms
from opsim.report.sections.bottleneck import CELLS, FIND_OUT, _bars, bottleneck_rows, moments
from opsim.report.sections.bottleneck import bottleneck_section as section_of_bottleneck_picture
from opsim.report.sections.summary import keeps_up
from opsim.report.sections.yamazumi import yamazumi_section as section
from opsim.report.sections.yamazumi_stacks import (
    LINE,
    PACE,
    SETTING_UP,
    TAKT,
    WALKING,
    Stack,
    person_sentences,
    station_stacks,
    worker_stacks,
)
from tests.made.result import BOLD, SCRIPT
from tests.opsim.kpi.made_logs import work
from tests.opsim.report.made_floor import bars, charts, floor, renamed, strings, words

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


@pytest.mark.parametrize(("people", "sentence"), [
    ([("ana", 95, {}), ("ben", 100, {WALKING: 9})],
     "For a finished job ben spends 109 s on work and walking, ana 95 s."),
    ([("ana", 95, {}), ("ben", 40, {}), ("eva", 60, {SETTING_UP: 5, WALKING: 5})],
     "For a finished job ana spends 95 s on work, set-up and walking, ben 40 s; the others lie between."),
    ([("ana", 95, {}), ("ben", 95, {})], "For a finished job everybody spends about as long on work, 95 s at most."),
])  # fmt: skip
def test_of_people_only_what_there_is_is_said(people, sentence):
    assert list(person_sentences([Stack(name, {"saw": work_s}, beside) for name, work_s, beside in people])) == [
        sentence
    ]


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


@pytest.mark.parametrize("every, up", [("100 s", True), ("30 s", False)])
def test_a_floor_keeps_up_where_as_much_leaves_as_comes_in(every, up):
    assert keeps_up(floor(queue(horizon="100 h", warm_up="1 h", every=every, mean="60 s"))) is up


def test_where_the_floor_decides_what_comes_in_there_is_nothing_to_keep_up_with():
    assert not keeps_up(floor(line(2, 1, horizon="2000 s")))


def test_without_rows_it_is_not_known():
    made = queue(horizon="10 h", warm_up="1 h", every="100 s", mean="60 s")
    assert not keeps_up(floor(made, keeps_rows=False))


def test_jobs_turned_away_are_jobs_not_kept_up_with():
    """As much leaves as is let in, yet of jobs every 100 s that take 60 s many find no room."""
    made = queue(horizon="50 h", warm_up="1 h", every="100 s, when_full: lose", mean="60 s")
    tight = floor(made, ("servers: 1}", "servers: 1, buffer: 1}"))
    assert tight.rows("lost_share")[0]["mean"] > 0.1 and not keeps_up(tight)


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
    drawn = [
        (row, begin, end)
        for row, begin, end, _ in bars(charts(section_of_bottleneck_picture(made))["bottleneck-strip"])
    ]
    start = made.plan.start_s
    assert drawn == [(row, *at_ms(start, span).tolist()) for row, span in ((0, (0, 6)), (1, (6, 20)), (1, (30, 35)))]


def test_bars_are_the_shares_of_the_table_and_sum_to_one_with_what_is_left(slow):
    figure = charts(section_of_bottleneck_picture(slow))["bottleneck-shares"]
    rows = {(row["subject"], row["part"]): row["mean"] for row in slow.rows("bottleneck")}
    sole = sum(end - begin for _, begin, end, name in bars(figure) if name.startswith("alone"))
    assert sole / 100 + rows["", "shifting"] + rows["", "none"] == pytest.approx(1, abs=0.02)


def test_moments_tile_the_run(slow):
    edges_s, rank = moments(slow.log, slow.plan)
    assert (edges_s[0], edges_s[-1]) == (0, slow.plan.horizon_s) and rank.size <= CELLS
    assert np.all(np.diff(edges_s) > 0) and np.all(rank[1:] != rank[:-1])


def test_the_slowest_station_is_named_with_what_it_means(slow):
    said = words(section_of_bottleneck_picture(slow))
    assert said.startswith("s2 is the bottleneck for") and "the longest of all stations" in said
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


def test_where_the_floor_keeps_up_with_what_comes_that_is_said():
    said = words(section_of_bottleneck_picture(floor(DEMAND)))
    assert "As much leaves as comes in" in said
    full = words(
        section_of_bottleneck_picture(floor(DEMAND, ("every: 100 s", "every: 30 s"), ("buffer: 6", "buffer: 5000")))
    )
    assert "As much leaves" not in full, "more comes than can leave"


def test_shares_are_of_the_time_for_which_the_floor_is_open():
    made = floor(SHIFTS)
    said, figure = (
        words(section_of_bottleneck_picture(made)),
        charts(section_of_bottleneck_picture(made))["bottleneck-shares"],
    )
    assert "one is the bottleneck for 100.0 % of the open time" in said
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
    ) in words(section_of_bottleneck_picture(floor(text)))


def test_what_is_said_of_a_bottleneck_was_seen_and_what_would_help_is_left_to_a_study():
    said = words(section_of_bottleneck_picture(floor(line(3, 1, horizon="6000 s"))))
    assert "; next is s" in said or "; next are s" in said
    assert FIND_OUT in said and not any(claim in said for claim in ("gains little", "helps", "sets the pace"))


def test_the_busiest_worker_and_tool_stand_beside_the_stations():
    gun = ("t1: {fixed: 60 s}", "t1: {fixed: 60 s, needs: {gun: 1}}"), ("shifts:", "tools: {gun: {n: 2}}\nshifts:")
    said = words(section_of_bottleneck_picture(floor(SHIFTS, *gun)))
    assert "The busiest worker is ann: at work or on the way for 100" in said
    assert "The busiest tool is gun: in use, or kept for a job, for 50" in said and "of the open time" in said


def test_where_nobody_is_busy_no_station_is_blamed():
    calm = floor(CELL, ("every: 40 s", "every: 200 s"))
    assert "no station is busy on all its servers" in words(section_of_bottleneck_picture(calm))


def test_one_station_cannot_be_narrower_than_others():
    assert section_of_bottleneck_picture(floor(line(1, 1, horizon="600 s", warm_up="10 s"))) is None


def test_without_rows_the_shares_stand_alone():
    assert list(charts(section_of_bottleneck_picture(floor(CELL, keeps_rows=False)))) == ["bottleneck-shares"]


def test_hostile_names_are_no_markup_of_bottleneck_picture():
    made = section_of_bottleneck_picture(renamed(floor(CELL), unload=SCRIPT, repack1=SCRIPT + "2"))
    assert not any("<script" in text for figure in charts(made).values() for text in strings(figure))
