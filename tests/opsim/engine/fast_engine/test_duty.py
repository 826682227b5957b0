"""Calendars on both engines: shifts, pauses one after the other, absence, midnight, weeks."""

import pytest
from twins import twins

from opsim.log import ABSENT, BREAK, FINISH, OFF, WORK

CELL = """
opsim: 1
name: duty
run: {start: Mon 05:30, horizon: 4 d, seed: 6}
layout: {places: {bay: [0 m, 0 m], shed: [20 m, 0 m], canteen: [0 m, 40 m]}}
tasks: {weld: {dist: lognormal, mean: 40 min, cv: 0.3}, file: {fixed: 25 min}}
stations: {bench: {at: bay, tasks: [weld], servers: 2, buffer: 3}, vice: {at: shed, tasks: [file]}}
products: {part: {route: [bench, vice]}}
sources: {s: {kind: poisson, every: 30 min, products: [part]}}
shifts:
  early:
    from: 06:00
    to: 14:00
    at_end: AT_END
    breaks:
      tea: {at: 06:00, lasts: 5 min}
      rest: {at: 06:05, lasts: 20 min, place: canteen}
      last: {at: 13:40, lasts: 20 min}
    meetings: {board: {at: 10:00, lasts: 15 min}}
  late: {from: 14:00, to: 22:00, overtime: {most: 90 min}, breaks: {tea: {at: 18:00, lasts: 30 s, place: canteen}}}
  night: {from: 22:00, to: 06:00, at_end: AT_END, days: [Mon, Tue, Wed]}
workers:
  ana: {shift: early, absence: 0.3, walk: 1 m/s, home: shed, skills: {bench: 1, vice: 1}}
  ben: {shift: [early, late], absence: 0.3, walk: 1 m/s, skills: {bench: 1, vice: 1}}
  cem: {shift: late, absence: 0.6, walk: 1 m/s, skills: {bench: 1}}
  dora: {shift: night, walk: 1 m/s, skills: {bench: 1, vice: 1}}
"""


@pytest.mark.parametrize("rule", ["finish", "resume", "finish_job"])
@pytest.mark.parametrize("replication", [0, 3])
def test_people_come_and_go_by_their_calendars(rule, replication):
    log = twins(CELL, ("AT_END", rule), replication=replication)
    assert min(len(log.of(kind)) for kind in (ABSENT, BREAK, FINISH, OFF, WORK)) >= 5


def test_shifts_that_follow_at_once_may_be_missed():
    double = ("  late: {from: 14:00", "  second: {from: 14:00, to: 21:00}\n  late: {from: 14:00")
    both = ("ana: {shift: early, absence: 0.3", "ana: {shift: early, absence: 0.7")
    log = twins(CELL, ("AT_END", "finish"), double, both, ("days: [Mon, Tue, Wed]", "days: [Mon, Tue, Wed, Thu, Fri]"))
    assert len(log.of(ABSENT)) >= 5
