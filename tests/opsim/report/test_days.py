"""People through the day: what fills a strip, where somebody mostly was, and a picture that reads no names as marks."""

import xml.etree.ElementTree as ET
from itertools import pairwise

import numpy as np
import pytest
from plans import plan

from opsim.log import ABSENT, BREAK, MEETING, OFF, WAIT, WALK
from opsim.report.plot.plotly import STATE_COLOURS as STATES
from opsim.report.sections.worker_timeline import Strip, cell_s, day_of, draw_day, in_cells, legend, strips_of
from tests.made_result import BOLD, SCRIPT
from tests.opsim.kpi.made_logs import made, row, work

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
