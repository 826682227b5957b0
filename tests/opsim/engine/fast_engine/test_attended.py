"""Attended runs: the station's time and a worker who stays, also where somebody else does the rest of it."""

from twins import twins

from opsim.log import WORK

CELL = """
opsim: 1
name: attended
run: {horizon: 900 s, seed: 6}
layout: {places: {a: [0 m, 0 m]}}
tasks: {bake: {dist: lognormal, mean: 10 s, cv: 0.4, automatic: attended}, fill: {fixed: 3 s}}
stations: {s: {at: a, tasks: [fill, bake], servers: 2, buffer: 2, STOP}}
products: {p: {route: [s]}}
release: {kind: saturated}
workers: {w1: {skills: {s: 1.0}}, w2: {skills: {s: 0.5}}}
"""


def test_a_run_that_is_broken_off_is_gone_on_with_by_anybody():
    log = twins(CELL, ("STOP", "maintenance: {wash: {every: 21 s, lasts: 4 s, when: at_once}}"))
    work = log.of(WORK)
    assert len(work.where(work["progress_from"] > 0)) > 10


def test_a_run_that_is_lost_is_another_one():
    jam = "breakdowns: {jam: {every: {fixed: 19 s}, by: busy, repair: {fixed: 4 s}, job: restart}}"
    assert len(twins(CELL, ("STOP", jam)).of(WORK)) > 50
