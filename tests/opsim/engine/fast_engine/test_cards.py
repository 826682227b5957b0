"""Loops of cards: who takes one, who waits for one and why, as SimPy's engine says."""

import pytest
from twins import twins

from opsim.log import BLOCKED, FINISH, HELD, LOST, NO_CARD, REWORK

LINE = """
opsim: 1
name: loops
run: {horizon: 1200 s, seed: 7}
layout: {places: {hall: [0 m, 0 m], far: [4 m, 0 m]}}
tasks: {quick: {dist: exponential, mean: 4 s, automatic: true}, slow: {dist: exponential, mean: 7 s}}
stations:
  s1: {at: hall, tasks: [quick], servers: 2, buffer: 9MORE}
  s2: {at: far, tasks: [slow], servers: 2, buffer: 9MORE}
  s3: {at: far, tasks: [quick], buffer: 9, inspect: {finds: 0.8, false_alarms: 0.2, then: {rework: s2}, most: 2}}
products:
  p: {route: [s1, s2, s3]}
  q: {routing: {start: {s1: 0.6, s2: 0.4}, s1: {s2: 0.8, s1: 0.2}, s2: {s3: 0.9, s1: 0.1}, s3: out}, due: 60 s}
RELEASE
cards: {all: {n: 9}, front: {n: 7, from: s1, to: s2}, back: {n: 2, from: s2, to: s3, products: [p]}}
workers: {u: {skills: {s2: 1.0}}, v: {skills: {s2: 0.8}}}
"""
SATURATED = "sources: {jobs: {kind: saturated, products: [p, q]}}"
LATE = "sources: {jobs: {kind: poisson, every: 4 s, products: [p, q]}}"
BOTH = "sources: {a: {kind: saturated, products: [p]}, b: {kind: poisson, every: 20 s, products: [q]}}"


def line(release=SATURATED, more=""):
    return LINE.replace("RELEASE", release).replace("MORE", more)


@pytest.mark.parametrize("release", [SATURATED, LATE, BOTH])
def test_cards_are_taken_all_at_once_or_none(release):
    log = twins(line(release))
    assert (log.of(BLOCKED)["cause"] == NO_CARD).any() and len(log.of(FINISH)) > 60
    assert len(log.of(REWORK)) > 10


def test_hundreds_wait_outside_with_the_same_words():
    log = twins(line(LATE, "").replace("every: 4 s", "every: 1.5 s"))
    assert (log.of(HELD)["cause"] == NO_CARD).sum() > 400


def test_jobs_of_higher_priority_are_asked_first():
    log = twins(line(LATE).replace("p: {route", "p: {priority: 2, route"))
    assert (log.of(HELD)["cause"] == NO_CARD).sum() > 50


def test_who_finds_no_card_is_lost_where_the_source_does_not_wait():
    log = twins(line(LATE.replace("4 s", "4 s, when_full: lose")))
    assert (log.of(LOST)["cause"] == NO_CARD).sum() > 10


@pytest.mark.parametrize("more", [", blocking: before", ", buffer_after: 1", ", preempt: resume"])
def test_cards_taken_with_a_place_that_is_kept_go_back_with_it(more):
    log = twins(line(LATE, more).replace("p: {route", "p: {priority: 2, route"))
    assert len(log.of(FINISH)) > 40


STOCKED = """
opsim: 1
name: kanban
run: {horizon: 1200 s, seed: 2}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {make: {dist: exponential, mean: 5 s, automatic: true}, pack: {fixed: 3 s, automatic: true}}
stations: {s1: {at: hall, tasks: [make]}, s2: {at: hall, tasks: [make], servers: 2}, out: {at: hall, tasks: [pack]}}
stores: {rack: {at: hall, initial: {x: 2, y: 1}}, bin: {at: hall, initial: 2}}
products:
  x: {route: [s1, rack], lot: 2}
  y: {route: [s1, s2, rack]}
  z: {route: [s2, bin]}
  order: {route: [out], parts: {out: {x: 1, y: 1, z: 1}}}
sources:
  orders: {kind: poisson, every: 9 s, products: [order]}
  make: {kind: saturated, products: [x]}
  other: {kind: saturated, products: [y]}
  more: {kind: saturated, products: [z]}
cards:
  xs: {n: 3, to: rack, products: [x]}
  ys: {n: 3, from: s1, to: rack, products: [y]}
  zs: {n: 2, products: [z]}
"""


def test_pieces_that_lie_in_a_store_at_the_start_have_their_cards():
    assert len(twins(STOCKED).of(FINISH)) > 60
