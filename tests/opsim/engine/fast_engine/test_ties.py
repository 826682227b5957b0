"""Jobs that wait for one worker, on both engines: what he began, and what he has to carry."""

import pytest
from twins import twins

from opsim.log import AWAY, BREAK, FINISH, HELD, TRANSPORT

CELL = """
opsim: 1
name: ties
run: {start: Mon 06:00, horizon: 70 min, seed: 4}
layout: {places: {bay: [0 m, 0 m], shed: [20 m, 0 m]}}
tasks: {weld: {fixed: 50 s}, pack: {fixed: 80 s, automatic: true}}
stations:
  bench: {at: bay, tasks: [weld], servers: 2, buffer: 2}
  packer: {at: shed, tasks: [pack], servers: 1, buffer: 0}
products: {part: {route: [bench, packer], carried: true}, big: {route: [bench, packer], carried: true, priority: 1}}
sources: {s: {kind: saturated, products: [part]}, t: {kind: poisson, every: 300 s, products: [big]}}
shifts:
  early:
    from: 06:00
    to: 06:20
    at_end: RULE
    at_break: RULE
    breaks: {tea: {at: 06:05, lasts: 3 min}, rest: {at: 06:11, lasts: 2 min}}
  late: {from: 06:25, to: 07:30, at_break: RULE, breaks: {tea: {at: 06:41, lasts: 90 s}}}
workers:
  ana: {shift: early, walk: 1 m/s, skills: {bench: 1.0}}
  ben: {shift: [early], walk: 1 m/s, skills: {bench: 0.9}}
  cem: {shift: late, walk: 1 m/s, skills: {bench: 1.1}}
  dora: {shift: late, walk: 2 m/s, home: shed, absence: 0.4, skills: {bench: 0.7}}
allocation: {when_blocked: BLOCKED}
"""


@pytest.mark.parametrize("blocked", ["held", "free"])
@pytest.mark.parametrize("rule", ["resume", "restart", "finish_job"])
def test_what_he_has_to_carry_waits_for_him_or_for_anybody_once_he_is_off(rule, blocked):
    log = twins(CELL, ("RULE", rule), ("BLOCKED", blocked))
    assert len(log.of(TRANSPORT)) > 5 and len(log.of(BREAK)) > 3


def test_what_he_began_waits_for_him():
    log = twins(CELL, ("RULE", "resume"), ("BLOCKED", "free"), ("weld: {fixed: 50 s}", "weld: {fixed: 500 s}"))
    assert (log.of(HELD)["cause"] == AWAY).any() and len(log.of(FINISH))


@pytest.mark.parametrize("at_close", ["finish", "resume"])
def test_what_he_began_is_for_anybody_where_its_station_has_closed(at_close):
    hours = ("tasks: [weld], servers: 2,", f"tasks: [weld], servers: 2, shift: early, at_close: {at_close},")
    log = twins(CELL, ("RULE", "resume"), ("BLOCKED", "free"), ("weld: {fixed: 50 s}", "weld: {fixed: 200 s}"), hours)
    assert (log.of(HELD)["cause"] == AWAY).any()
