"""Tools, holds, teams and attended runs together, on one floor with stops and people who go: one log."""

import pytest
from twins import twins

from opsim.log import HELD, NO_TOOL, TEAM, TOOL, WAIT

CELL = """
opsim: 1
name: hands
run: {start: Mon 06:00, horizon: 1800 s, seed: 8}
layout: {places: {p: [0 m, 0 m], q: [3 m, 0 m], r: [3 m, 4 m]}}
tools: {gun: {n: 1}, jig: {n: 2}}
tasks:
  bolt: {fixed: 8 s, hold: {tool: gun, from: 0.25, to: 0.75}, needs: {jig: 1}, repeat: 2}
  press: {fixed: 6 s, automatic: attended, hold: {tool: gun, from: 0.5, to: 1}}
  lift: {fixed: 5 s, team: 2, needs: {jig: 1}}
  spin: {fixed: 7 s, automatic: true, needs: {jig: 1}}
  pack: {fixed: 4 s}
defaults: {stations: {buffer: 4}}
stations:
  a: {at: p, tasks: [pack, bolt], servers: 2, setup: {otherwise: 5 s, by: product}}
  b: {at: q, tasks: [press, spin], yield: 0.8, needs: {jig: 1}, STOP}
  c: {at: r, tasks: [lift, pack], servers: 2, inspect: {finds: 0.9, then: {rework: a}, most: 1}}
products: {x: {share: 0.5, priority: 1, route: [a, b, c]}, y: {share: 0.5, lot: 2, route: [b, c]}}
release: {kind: renewal, every: {fixed: 20 s}}
workers:
  k: {walk: 1 m/s, skills: {a: 1.0, b: 1.0, c: 1.0}}
  l: {walk: 1 m/s, skills: {a: 0.8, c: 1.0}}
  m: {walk: 1 m/s, skills: {b: 1.2, c: 1.0}}
"""
STOPS = {
    "nothing": "servers: 1",
    "jam": "breakdowns: {jam: {every: {fixed: 25 s}, by: busy, repair: {fixed: 12 s}, job: resume}}",
    "preemption": "preempt: restart",
    "hours": "shift: open, at_close: finish",
}
SHIFTS = """
shifts:
  open: {from: 06:00, to: 06:15}
  day: {from: 06:00, to: 14:00, at_break: RULE, breaks: {tea: {at: 06:03, lasts: 2 min}, rest: {at: 06:10, lasts: 9 s}}}
"""


@pytest.mark.parametrize("stop", STOPS)
def test_hands_of_all_kinds_go_together(stop):
    log = twins(CELL + SHIFTS.replace("RULE", "finish"), ("STOP", STOPS[stop]))
    assert len(log.where((log["kind"] == HELD) & (log["cause"] == NO_TOOL))) > 20
    assert len(log.where((log["kind"] == WAIT) & (log["cause"] == TEAM))) > 5 and len(log.of(TOOL)) > 50


@pytest.mark.parametrize("rule", ["finish", "finish_job", "resume", "resume_any", "hand_over", "restart"])
def test_hands_of_who_has_to_go(rule):
    text = CELL.replace("STOP", "servers: 1") + SHIFTS.replace("RULE", rule)
    log = twins(text, *((f"{w}: {{walk", f"{w}: {{shift: day, walk") for w in "kl"))
    assert len(log.of(TOOL)) > 50
