"""People through the day: what fills a strip, where somebody mostly was, and a picture that reads no names as marks.

Where people are: all the time that they are on the floor, once.

Why times differ: what lies between people and what within each.
"""

import xml.etree.ElementTree as ET
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from plans import CELL, line, loaded, plan, ran

from opsim.log import ABSENT, BREAK, MEETING, OFF, REPAIR, WAIT, WALK
from opsim.report.page import Svg
from opsim.report.plot.plotly import STATE_COLOURS as STATES
from opsim.report.sections import variability as time_spread
from opsim.report.sections.common import of_open, open_share, presence, staffed_h, with_closed
from opsim.report.sections.learning_fatigue import Curve, curves_figure, curves_legend, thinned, ticks_s
from opsim.report.sections.variability import Spread, spreads
from opsim.report.sections.wip import Steps, _grows, jobs_inside
from opsim.report.sections.wip import wip_section as section
from opsim.report.sections.worker_timeline import Strip, cell_s, day_of, draw_day, in_cells, legend, strips_of
from opsim.streams import stream
from tests.made.result import BOLD, SCRIPT
from tests.opsim.kpi.made_logs import made, row, work
from tests.opsim.report.made_floor import charts, floor, renamed, strings, words
from tests.opsim.report.made_material import hostile, of_log
from tests.opsim.study.layout.made_floor import FLOOR as FLOOR_of_open_time
from tests.opsim.study.layout.made_floor import FLOOR as FLOOR_of_presence
from tests.opsim.study.layout.made_floor import FLOOR as FLOOR_of_time_spread

H = 3600
FLOOR = """
opsim: 1
name: days
run: {start: Mon 06:00, horizon: 4 h}
layout: {places: {here: [0 m, 0 m]}}
shifts: {day: {from: 07:00, to: 09:00}}
tasks: {t: {fixed: 10 s}}
stations: {press: {at: here, tasks: [t]}, saw: {at: here, tasks: [t]}}
products: {p: {route: [press, saw]}}
release: {kind: poisson, every: 60 s}
workers: {ana: {shift: day, skills: {press: 1.0, saw: 1.0}}, ben: {skills: {saw: 1.0}}}
"""
ROWS = [
    row(OFF, 0, H, worker=0),
    row(BREAK, H, H + 600, worker=0, cause=MEETING),
    work(H + 600, 2 * H, 0, worker=0),
    row(BREAK, 2 * H, 2 * H + 600, worker=0),
    work(2 * H + 600, 3 * H - 600, 1, job=1, worker=0),
    row(WAIT, 3 * H - 600, 3 * H, worker=0),
    row(OFF, 3 * H, 4 * H, worker=0),
    *(row(WALK, 60 * i, 60 * i + 30, worker=1, places=(0, 0)) for i in range(240)),
    *(row(WAIT, 60 * i + 30, 60 * i + 60, worker=1) for i in range(240)),
]


@pytest.fixture(scope="module")
def strips():
    p = plan(FLOOR)
    return strips_of(made(ROWS, p), p, 0, 4 * H)


def test_each_stretch_of_a_strip_is_full(strips):
    for strip in strips:
        assert np.sum(list(strip.shares.values()), axis=0) == pytest.approx(1)


def test_a_state_fills_a_stretch_by_its_share_of_it(strips):
    ana, ben = strips
    n = ana.shares["work"].size
    assert ana.shares["work"].mean() == pytest.approx((3000 + 2400) / (4 * H))
    assert np.flatnonzero(ana.shares["break"]).tolist() == list(range(n * 2 // 4, n * 2 // 4 + n // 24))
    assert ben.shares["walk"] == pytest.approx(np.full(n, 0.5))
    assert list(ana.shares) == ["work", "wait", "meeting", "break", "off"]


def test_below_the_strip_stands_where_somebody_mostly_was(strips):
    ana, ben = strips
    assert [words for _, _, words in ana.posts] == ["press", "saw"] and not ben.posts
    (_, first_end, _), (second_begin, _, _) = ana.posts
    assert first_end == pytest.approx(0.5, abs=0.06) and second_begin == pytest.approx(0.5, abs=0.06)


def test_a_shift_is_marked_where_it_was_planned(strips):
    assert strips[0].shifts == [(0.25, 0.75)] and strips[1].shifts == []


def test_stretches_are_cut_at_the_edges_of_cells():
    assert in_cells(np.array([5.0, 1.0]), np.array([9.0, 2.0]), np.arange(0.0, 13.0, 3)).tolist() == [1, 1, 3, 0]
    assert in_cells(np.array([2.0]), np.array([20.0]), np.arange(4.0, 13.0, 4)).tolist() == [4, 4]


@pytest.mark.parametrize(("hours", "seconds"), [(0.5, 10), (2, 30), (8, 120), (16, 300), (24, 300), (400, 300)])
def test_stretches_are_as_short_as_the_picture_can_show(hours, seconds):
    assert cell_s(hours * H) == seconds


def test_of_a_long_run_the_first_day_after_the_warm_up_is_shown():
    p = plan(FLOOR.replace("horizon: 4 h", "horizon: 80 h, warm_up: 2 h"))
    section = day_of(made([row(WAIT, 0, 80 * H, worker=w) for w in range(2)], p), p, "Mon 06:00")
    assert section["cut"] and b"Mon 08:00" in section["picture"] and b"Tue 00:00" in section["picture"]
    assert section["alt"] == "ana: idle 100.0 %; ben: idle 100.0 %"


def test_of_many_workers_some_are_counted_only():
    names = ", ".join(f"w{i}: {{skills: {{saw: 1.0, press: 1.0}}}}" for i in range(45))
    p = plan(FLOOR[: FLOOR.index("workers:")] + f"workers: {{{names}}}")
    section = day_of(made([row(WAIT, 0, 4 * H, worker=w) for w in range(45)], p), p, "Mon 06:00")
    assert section["more"] == 5 and section["picture"].count(b"<text") >= 40 and not section["shifts"]


def texts(picture):
    return [each.text for each in ET.fromstring(picture).iter("{http://www.w3.org/2000/svg}text")]


def test_the_picture_says_hours_names_and_posts_and_takes_no_name_for_a_mark():
    shares = {"work": np.full(8, 0.5), "wait": np.full(8, 0.5)}
    picture = draw_day([Strip(BOLD, shares, [(0.0, 0.9, SCRIPT)], [(0.0, 1.0)])], "Mon 06:00", 0, 8 * H)
    found = texts(picture)
    assert found[:3] == ["Mon 06:00", "06:30", "07:00"] and found[16] == "14:00"
    assert SCRIPT in found and any(text.startswith(BOLD[:15]) for text in found)
    assert b"<script" not in picture and picture == draw_day(
        [Strip(BOLD, shares, [(0.0, 0.9, SCRIPT)], [(0.0, 1.0)])], "Mon 06:00", 0, 8 * H
    )


def test_words_that_have_no_room_are_left_out():
    strip = Strip("ana", {"work": np.ones(8)}, [(0.0, 0.01, "quality control")])
    assert "quality control" not in texts(draw_day([strip], "Mon 06:00", 0, 8 * H))


@pytest.mark.parametrize("hours", [1, 5, 8, 16, 17, 24])
def test_labels_of_the_clock_do_not_run_into_each_other(hours):
    picture = ET.fromstring(draw_day([], "Mon 07:00", 0, hours * H))
    ends = []
    for each in picture.iter("{http://www.w3.org/2000/svg}text"):
        wide = 6.5 * len(each.text)
        left = float(each.get("x")) - (wide if each.get("text-anchor") == "end" else wide / 2)
        ends.append((left, left + wide))
    assert len(ends) > 4 and all(one[1] < other[0] for one, other in pairwise(ends))


def test_a_start_without_a_clock_is_told_in_hours():
    assert texts(draw_day([], "2026-11-23T06:00", 0, 8 * H))[:3] == ["0 h", "0.5 h", "1 h"]


def test_the_legend_has_the_colours_of_the_strips_and_nothing_that_is_not_there():
    made_strips = [Strip("ana", {"work": np.ones(3), "absent": np.zeros(3)}), Strip("ben", {"wait": np.ones(3)})]
    assert legend(made_strips) == [(STATES["work"][0], "work"), (STATES["wait"][0], "idle")]


def test_who_is_absent_fills_his_shift_and_who_is_off_is_a_line():
    p = plan(FLOOR)
    rows = [row(OFF, 0, H, worker=0), row(ABSENT, H, 3 * H, worker=0), row(OFF, 3 * H, 4 * H, worker=0)]
    ana = strips_of(made(rows, p), p, 0, 4 * H)[0]
    assert ana.shares["absent"].sum() / ana.shares["absent"].size == 0.5
    picture = draw_day([ana], "Mon 06:00", 0, 4 * H).decode()
    heights = {
        colour: {d.split("v")[1].split("H")[0] for d in [line]}
        for colour in (STATES["absent"][0], STATES["off"][0])
        for line in [next(line for line in picture.splitlines() if colour in line)]
    }
    assert heights == {STATES["absent"][0]: {"22.0"}, STATES["off"][0]: {"5.3"}}


def test_thinning_keeps_the_ends_and_the_peak():
    at_s, value = np.arange(10_000.0), np.sin(np.arange(10_000.0))
    value[4321] = 5.0
    some_s, some = thinned(at_s, value)
    assert some_s.size <= 700 and some.max() == 5.0 and (some_s[0], some_s[-1]) == (0.0, 9999.0)
    assert thinned(at_s[:5], value[:5])[0].size == 5


def test_ticks_stand_at_round_times_of_the_clock():
    assert ticks_s("Mon 06:10", 0.0, 4 * 3600.0) == [3000.0, 6600.0, 10200.0, 13800.0]
    words = curves_figure([Curve("ana", np.array([0.0, 3 * 86400.0]), np.array([0.0, 0.5]))], "Mon 06:00", "%")
    assert "Tue 00:00" in words["layout"]["xaxis"]["ticktext"]


def test_neighbouring_curves_differ_in_colour_and_in_dashes():
    looks = curves_legend([Curve(name, np.zeros(1), np.zeros(1)) for name in "abcdefgh"])
    assert len({colour for colour, *_ in looks}) == 8 and all(a[1] != b[1] for a, b in pairwise(looks[:3]))


KEPT = "shifts: {s: {from: '00:10', to: '00:50'}}\nworkers: {ana: {shift: s, "
SHIFT = FLOOR_of_open_time.replace("workers: {ana: {", KEPT).replace("{horizon: 1 h", "{start: Mon 00:00, horizon: 2 h")


def test_a_shift_of_forty_minutes_is_a_third_of_two_hours():
    made = plan(SHIFT)
    assert open_share(made) == pytest.approx(1 / 3) and staffed_h(made) == pytest.approx(2 / 3)
    assert with_closed(made) == " of the 2 h counted, closed ones too"


def test_the_open_time_is_no_shorter_than_what_was_done_in_overtime():
    assert open_share(plan(SHIFT), active=0.4) == 0.4


def test_a_floor_without_hours_is_open_all_the_time():
    made = plan(CELL)
    assert (open_share(made), with_closed(made)) == (1.0, "") and staffed_h(made) == pytest.approx(110 / 60)


def test_an_interval_is_scaled_as_its_mean_is():
    row = {"kpi": "x", "mean": 0.1, "low": 0.08, "high": 0.12, "half_width": None}
    assert of_open(row, 0.25) == {"kpi": "x", "mean": 0.4, "low": 0.32, "high": 0.48, "half_width": None}


PRESENCE_SHIFT = (("workers: {ana: {", "shifts: {s: {from: '00:10', to: '00:50'}}\nworkers: {ana: {shift: s, "),)
STARTS = (("run: {horizon: 1 h", "run: {start: Mon 00:00, horizon: 1 h, warm_up: 5 min"),)


@pytest.fixture(scope="module")
def shift():
    return ran(FLOOR_of_presence, *PRESENCE_SHIFT, *STARTS)


def test_the_time_of_all_is_the_time_that_they_are_there(shift):
    log, plan = shift
    found = presence(log, plan)
    low, high = plan.window_s
    gone = log.where(np.isin(log["kind"], (OFF, ABSENT)) & (log["worker"] >= 0)).clipped_s(low, high).sum()
    assert gone > 0
    there_s = len(plan.workers) * (high - low) - gone
    assert found.total == pytest.approx(there_s * 3600 / (40 * 60)), "an hour of the 40 min of the shift"


def test_an_hour_is_one_in_which_somebody_is_on_duty_or_the_floor_is_open():
    log, plan = ran(FLOOR_of_presence, *PRESENCE_SHIFT, ("run: {horizon: 1 h", "run: {start: Mon 00:00, horizon: 20 h"))
    assert staffed_h(plan) == pytest.approx(40 / 60)
    assert 2 * 3600 <= presence(log, plan).total < 2.1 * 3600, "two people, all the shift"


def test_repair_is_work():
    made_plan = plan(FLOOR_of_presence)
    at = made_plan.stations[0].place
    rows = [row(REPAIR, 0, 600, worker=0, station=0, places=(at, at))]
    found = presence(made(rows, made_plan), made_plan)
    assert found.work[at] == pytest.approx(600) and found.work.sum() == pytest.approx(600)


def test_work_is_where_the_stations_are(shift):
    log, plan = shift
    found = presence(log, plan)
    at = {plan.places[rank] for rank in np.flatnonzero(found.work)}
    assert at == {"p1", "p3", "p5"} and (found.work <= found.at_place + 1e-9).all()
    assert found.on_way and all(a != b for a, b in found.on_way)


TEXT = FLOOR_of_time_spread.replace(
    "tasks: {t: {dist: lognormal, mean: 20 s, cv: 0.2}}",
    "tasks: {t: {dist: lognormal, mean: 20 s, cv: 0.2}, u: {dist: gamma, mean: 9 s, cv: 0.4, between_share: 0.6}, "
    "v: {fixed: 3 s}}",
).replace("pack:  {at: p3, tasks: [t]", "pack:  {at: p3, tasks: [u, v]")


def time_spread_made(text=TEXT):
    return of_log(SimpleNamespace(), plan(text), loaded(text), [{"kpi": ""}])


def test_both_parts_together_are_the_whole():
    one = Spread("u", 0.4, 0.6)
    assert (1 + one.between**2) * (1 + one.within**2) == pytest.approx(1 + 0.4**2)


def test_the_parts_are_what_is_drawn():
    p = plan(TEXT)
    model = next(task.model for task in p.tasks if task.name == "u")
    rng = stream(3, 0, "test")
    means = [model.mean_duration_s(model.draw_worker(rng)) for _ in range(20_000)]
    one = next(one for one in spreads(p, "full") if one.task == "u")
    assert np.std(means) / np.mean(means) == pytest.approx(one.between, rel=0.03)


@pytest.mark.parametrize(
    "switch, found",
    [
        ("full", {"u": (0.4, 0.6), "t": (0.2, 0.0)}),
        ("within_only", {"u": (0.2473, 0.0), "t": (0.2, 0.0)}),
        ("between_only", {"u": (0.3052, 1.0)}),
        ("none", {}),
    ],
)
def test_what_the_run_switches_off_is_left_out(switch, found):
    told = {one.task: (one.cv, one.share) for one in spreads(plan(TEXT), switch)}
    assert told == {task: pytest.approx(of, abs=2e-4) for task, of in found.items()}


def test_who_differs_most_is_said_and_where_nobody_differs_nothing_is():
    section = time_spread.time_spread_section(time_spread_made())
    assert section.blocks[0].text.startswith(
        "The times of u differ most between people: their means lie about 31 % (standard deviation) around that of all"
    )
    assert time_spread.time_spread_section(time_spread_made(FLOOR_of_time_spread)) is None


def test_hostile_names_do_no_harm():
    section = time_spread.time_spread_section(
        of_log(SimpleNamespace(), hostile(plan(TEXT), SCRIPT), loaded(TEXT), [{"kpi": ""}])
    )
    svg = next(block for block in section.blocks if isinstance(block, Svg))
    assert "<script" not in svg.text and "&lt;script" in svg.text


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
