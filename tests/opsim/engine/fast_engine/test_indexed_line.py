"""Indexed lines in the compiled engine: late jobs, calls, and whatever makes the line stand."""

import pytest
from twins import twins

from opsim.log import AWAY, FINISH, FULL, IS_DOWN, SENT_ON, STANDS, UNFINISHED

LINE = """
opsim: 1
name: indexed
run: {start: Mon 06:00, horizon: 3000 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m]}}
tasks: {t1: {fixed: 30 s}, t2: {dist: lognormal, mean: 50 s, cv: 0.3}, t3: {fixed: 20 s, repeat: 2}}
stations: {s1: {at: a, tasks: [t1]}, s2: {at: b, tasks: [t2]}, s3: {at: a, tasks: [t3]}}
lines: {final: {kind: indexed, stations: [s1, s2, s3], takt: 60 s}}
products: {x: {route: [s1, s2, s3]}}
release: {kind: saturated}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 1.0}}, w3: {skills: {s3: 1.0}}}
"""
ON = ("takt: 60 s", "takt: 60 s, unfinished: send_on")


def causes(log):
    """Why the line stood."""
    return set(log.of(STANDS)["cause"].tolist())


def test_a_line_waits_for_the_last_one_alike():
    assert causes(twins(LINE)) == {UNFINISHED}


def test_jobs_are_sent_on_alike():
    log = twins(LINE, ON)
    assert log.of(SENT_ON)["job"].size > 3
    assert causes(log) == set()


def test_a_station_that_is_down_and_a_full_one_behind_stop_the_line_alike():
    jam = "breakdowns: {jam: {every: {fixed: 400 s}, repair: {fixed: 70 s}}}"
    log = twins(
        LINE,
        ON,
        ("s2: {at: b, tasks: [t2]}", f"s2: {{at: b, tasks: [t2], {jam}}}, after: {{at: b, tasks: [t4], buffer: 0}}"),
        ("t1: {", "t4: {fixed: 75 s, automatic: true}, t1: {"),
        ("{route: [s1, s2, s3]}", "{route: [s1, s2, s3, after]}"),
    )
    assert causes(log) >= {IS_DOWN, FULL}


def test_a_line_on_which_nobody_is_stands_alike():
    shift = "shifts: {early: {from: 06:00, to: 14:00, at_break: resume, breaks: {tea: {at: 06:20, lasts: 5 min}}}}\n"
    log = twins(
        LINE + shift, *((f"{name}: {{skills", f"{name}: {{shift: early, skills") for name in ("w1", "w2", "w3"))
    )
    assert causes(log) >= {AWAY}


@pytest.mark.parametrize("cards", ["", "cards: {conwip: {n: 2}}\n"])
def test_jobs_that_arrive_between_two_moves_come_on_alike(cards):
    log = twins(LINE + cards, ("kind: saturated", "kind: poisson, every: 80 s"), ON)
    assert log.of(FINISH)["job"].size > 15
