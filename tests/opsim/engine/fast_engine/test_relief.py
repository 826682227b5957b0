"""Hand-over on both engines: somebody is wanted, comes and takes over, or not."""

import pytest
from twins import twins

from opsim.log import BREAK, FINISH, WALK

CELL = """
opsim: 1
name: relief
run: {start: Mon 06:00, horizon: 55 min, seed: 2}
layout: {places: {bay: [0 m, 0 m], shed: [30 m, 0 m], canteen: [0 m, 20 m]}}
tasks: {weld: {fixed: 100 s}, file: {dist: lognormal, mean: 50 s, cv: 0.3}}
stations: {bench: {at: bay, tasks: [weld, file], servers: 2, buffer: 2}, press: {at: shed, tasks: [file], servers: 2}}
products: {part: {route: [bench, press]}, top: {route: [press, bench], priority: 2}}
sources: {s: {kind: saturated, products: [part]}, t: {kind: poisson, every: 90 s, products: [top]}}
shifts:
  early:
    from: 06:00
    to: 06:30
    at_end: hand_over
    at_break: hand_over
    breaks: {tea: {at: 06:05, lasts: 3 min}, rest: {at: 06:17, lasts: 2 min, place: canteen}}
  late: {from: 06:20, to: 07:00, at_break: hand_over, breaks: {tea: {at: 06:31, lasts: 90 s}}}
workers:
  ana: {shift: early, walk: 1 m/s, skills: {bench: 1.0, press: 1.0}}
  ben: {shift: early, walk: 1 m/s, skills: {bench: 0.9}}
  cem: {shift: late, walk: 1 m/s, skills: {bench: 1.1, press: 1.0}}
  dora: {walk: 2 m/s, home: shed, skills: {bench: 0.7, press: 1.0}}
allocation: {rule: nearest, idle: home}
"""
PATROL = (
    ("idle: home", "idle: patrol"),
    ("walk: 2 m/s, home: shed,", "walk: 2 m/s, home: shed, patrol: [press, bench],"),
    ("cem: {shift: late, walk: 1 m/s,", "cem: {shift: late, walk: 1 m/s, patrol: [bench, press],"),
    ("ana: {shift: early, walk: 1 m/s,", "ana: {shift: early, walk: 1 m/s, patrol: [bench, press],"),
    ("ben: {shift: early, walk: 1 m/s,", "ben: {shift: early, walk: 1 m/s, patrol: [bench],"),
)


@pytest.mark.parametrize("rule", ["nearest", "longest_queue", "best_skill"])
def test_who_comes_and_when_he_takes_over(rule):
    log = twins(CELL, ("rule: nearest", f"rule: {rule}"))
    assert min(len(log.of(kind)) for kind in (FINISH, WALK, BREAK)) >= 4


def test_on_patrol_only_who_stands_there_takes_over():
    log = twins(CELL, *PATROL)
    assert min(len(log.of(kind)) for kind in (FINISH, WALK, BREAK)) >= 4


def test_who_is_on_the_way_may_have_to_go_himself():
    """The breaks of the second are a minute after those of the first, and he is a minute away."""
    other = ("ben: {shift: early, walk: 1 m/s,", "ben: {shift: other, walk: 0.5 m/s, home: shed,")
    tea = "at_break: hand_over, breaks: {tea: {at: 06:06, lasts: 2 min}}"
    shift = ("  late: {", f"  other: {{from: 06:00, to: 06:30, {tea}}}\n  late: {{")
    assert len(twins(CELL, other, shift, ("walk: 2 m/s, home: shed", "walk: 0.3 m/s, home: shed")).of(BREAK)) >= 4
