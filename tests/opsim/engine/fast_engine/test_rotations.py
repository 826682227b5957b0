"""Job rotation on both engines: by the clock, by count, by rule, with people who come and go."""

import pytest
from twins import twins

from opsim.log import BREAK, FINISH, WALK

CELL = """
opsim: 1
name: rotation
run: {start: Mon 06:00, horizon: 40 min, seed: 1}
layout: {places: {here: [0 m, 0 m], there: [6 m, 0 m]}}
tasks: {do: {dist: lognormal, mean: 9 s, cv: 0.4}, look: {fixed: 6 s}}
stations:
  a: {at: here, tasks: [do], buffer: 1}
  b: {at: there, tasks: [do, look], buffer: 1}
  c: {at: here, tasks: [look], buffer: 1}
  d: {at: there, tasks: [look], buffer: 2}
products: {p: {share: 0.6, route: [a, c]}, q: {share: 0.4, route: [b, d]}}
sources: {s: {kind: saturated, products: [p]}, t: {kind: poisson, every: 20 s, products: [q]}}
shifts:
  early: {from: 06:00, to: 06:20, overtime: {most: 5 min}, breaks: {tea: {at: 06:07, lasts: 2 min}}}
  late: {from: 06:15, to: 07:00, breaks: {tea: {at: 06:31, lasts: 90 s, place: there}}}
workers:
  u: {walk: 2 m/s, shift: early, skills: {a: 1, b: 1, c: 1, d: 1}}
  v: {walk: 1 m/s, shift: late, skills: {a: 0.8, b: 1, c: 1, d: 1}}
  w: {walk: 2 m/s, skills: {b: 1, c: 1.2, d: 1}}
  x: {like: w, absence: 0.5, shift: early}
rotations: {turn: {workers: [w, u, x, v], posts: [a, [b, c], []], every: 100 s}}
"""
CHANGES = {
    "by the clock": "every: 100 s",
    "by count": "after: 7",
    "by count, to whom it was shortest": "after: 5, rule: least_time",
    "to whom it was shortest": "every: 64 s, rule: least_time",
    "in turn": "rule: in_turn",
    "to the least exposed": "every: 100 s, rule: least_exposed",
}


@pytest.mark.parametrize("how", CHANGES)
def test_people_change_posts_as_they_do_in_the_reference(how):
    log = twins(CELL, ("every: 100 s", CHANGES[how]))
    assert len(log.of(FINISH)) > 100 and len(log.of(BREAK)) and len(log.of(WALK))


def test_two_rotations_leave_each_his_own_stations_and_posts_are_fewer_or_more_than_people():
    one, other = "workers: [w, u], posts: [a, d, []], every: 70 s", "workers: [x, v], posts: [[b, d], c], after: 3"
    two = f"{{turn: {{{one}}}, other: {{{other}}}}}"
    log = twins(CELL, ("{turn: {workers: [w, u, x, v], posts: [a, [b, c], []], every: 100 s}}", two))
    assert len(log.of(FINISH)) > 100
