"""What becomes of what somebody is at when he has to go, on both engines: all rules, alone, in teams, with tools."""

import pytest
from twins import twins

from opsim.engine.rules import INTERRUPTION_RULES
from opsim.log import BREAK, FINISH

CELL = """
opsim: 1
name: leaving
run: {start: Mon 06:00, horizon: 55 min, seed: 3}
layout: {places: {bay: [0 m, 0 m], shed: [20 m, 0 m]}}
tools: {crane: {n: 1}, gun: {n: 2}}
tasks:
  lift: {fixed: 70 s, team: 2, repeat: 2}
  weld: {dist: lognormal, mean: 40 s, cv: 0.3, needs: {gun: 1}, INTERRUPTED}
  turn: {fixed: 25 s, needs: {crane: 1, gun: 1}}
stations:
  bench: {at: bay, tasks: [weld, turn, weld], servers: 2, buffer: 2}
  frame: {at: shed, tasks: [weld, lift, lift], servers: 2, setup: {otherwise: 30 s}}
products: {part: {route: [bench, frame]}, top: {route: [frame], carried: true}}
sources: {s: {kind: saturated, products: [part]}, t: {kind: poisson, every: 150 s, products: [top]}}
shifts:
  early:
    from: 06:00
    to: 06:30
    at_end: END
    at_break: BREAK
    breaks: {tea: {at: 06:05, lasts: 3 min}, rest: {at: 06:10, lasts: 2 min}, late: {at: 06:21, lasts: 2 min}}
  late: {from: 06:30, to: 07:00, at_break: BREAK, breaks: {tea: {at: 06:41, lasts: 90 s}}}
workers:
  ana: {shift: early, walk: 1 m/s, skills: {bench: 1.0, frame: 1.0}}
  ben: {shift: [early], walk: 1 m/s, skills: {bench: 0.9, frame: 1.0}}
  cem: {shift: late, walk: 1 m/s, skills: {bench: 1.1, frame: 1.0}}
  dora: {walk: 2 m/s, home: shed, skills: {bench: 0.7, frame: 1.0}}
"""


def left(at_break, at_end, interrupted=""):
    edits = (("BREAK", at_break), ("END", at_end), (", INTERRUPTED", interrupted))
    log = twins(CELL, *edits)
    assert len(log.of(BREAK)) >= 4 and len(log.of(FINISH)) >= 4
    return log


@pytest.mark.parametrize("rule", INTERRUPTION_RULES)
def test_by_the_rule_of_the_shift(rule):
    left(rule, rule)


@pytest.mark.parametrize(
    ("rule", "of_task"), [*zip(INTERRUPTION_RULES, [*[*INTERRUPTION_RULES][2:], "finish", "resume"])]
)
def test_by_the_rule_of_the_task(rule, of_task):
    left(rule, "resume_any", f", interruption: {of_task}")
