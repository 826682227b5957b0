"""Stretches in metres become times on the line's clock; a station of a line has the room that the line gives it."""

from math import inf

import pytest
from plans import loaded, plan

from opsim.plan import compile_plan, station_loads
from opsim.plan.warnings import hour_risks

TEXT = """
opsim: 1
name: line
run: {horizon: 1000 s}
layout: {places: {a: [0 m, 0 m]}}
tasks: {t: {fixed: 50 s}}
stations: {s1: {at: a, tasks: [t]}, s2: {at: a, tasks: [t]}, z: {at: a, tasks: [t]}}
lines:
  final:
    {kind: moving, length: 6 m, lengths: {s2: 9 m}, stations: [s1, s2], takt: 60 s, upstream: 2 m, drift: 1 m}
products: {x: {route: [s1, s2, z]}}
release: {kind: poisson, every: 100 s}
workers: {ana: {skills: {s1: 1.0, s2: 1.0, z: 1.0}}, joker: {skills: {s1: 1.0}}}
"""
INDEXED = TEXT.replace("moving, length: 6 m, lengths: {s2: 9 m},", "indexed,").replace(
    ", upstream: 2 m, drift: 1 m", ""
)


def test_without_a_speed_jobs_are_a_stretch_apart():
    (line,) = plan(TEXT).lines
    assert line.speed_m_per_s == pytest.approx(0.1)
    assert line.start_m == (0.0, 6.0)
    assert line.reach_s == (0.0, 40.0)
    assert line.limit_s == (70.0, 160.0)
    assert line.exit_s == 150.0
    assert (line.start_s(1), line.reach_m(1)) == (60.0, pytest.approx(4.0))


def test_stations_have_the_room_of_their_line_and_others_their_own():
    assert [station.buffer for station in plan(TEXT).stations] == [inf, inf, inf]
    indexed = plan(INDEXED)
    assert [station.buffer for station in indexed.stations] == [0, 0, inf]
    assert indexed.lines[0].start_m == ()


def test_lines_come_in_natural_order_and_their_floaters_by_rank():
    text = INDEXED.replace("  final:\n", "  l10: {kind: indexed, stations: [z], takt: 9 s}\n  l2:\n")
    p = plan(
        text.replace("takt: 60 s}", "takt: 60 s, unfinished: send_on, andon: {workers: [joker], at: 50 s, does: help}}")
    )
    assert [line.name for line in p.lines] == ["l2", "l10"]
    assert (p.lines[0].floaters, p.lines[0].call_s, p.lines[0].helps, p.lines[0].sends_on) == ((1,), 50.0, True, True)


def test_no_station_of_a_line_does_more_than_a_job_a_takt():
    for text in (TEXT, INDEXED):
        loads = {load.station: load for load in station_loads(plan(text))}
        assert loads["s1"].most_per_h == pytest.approx(60)
        assert loads["s1"].load == pytest.approx(0.6)
        assert loads["z"].most_per_h == pytest.approx(72)


def test_jobs_that_come_faster_than_takt_are_more_than_the_line_can_do():
    read = loaded(INDEXED.replace("every: 100 s", "every: 55 s"))
    loads = {load.station: load.load for load in station_loads(compile_plan(read))}
    assert loads["s1"] == pytest.approx(60 / 55)


def test_work_that_takes_longer_than_takt_is_told():
    assert any(
        "s1 does not keep the takt of line final" in risk
        for risk in hour_risks(plan(INDEXED.replace("fixed: 50 s", "fixed: 61 s")))
    )
