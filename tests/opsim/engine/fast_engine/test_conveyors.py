"""Conveyors on both engines: those that accumulate, and those that stand as a whole."""

import pytest
from twins import twins

from opsim.log import FINISH, QUEUE, TRANSPORT

BELT = """
opsim: 1
name: belt
run: {horizon: 400 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [9 m, 0 m]}}
tasks: {feed: {dist: exponential, mean: 3 s, automatic: true}, pack: {dist: exponential, mean: 4 s, automatic: true}}
stations: {feeder: {at: a, tasks: [feed], servers: 2, buffer: 2}, packer: {at: c, tasks: [pack], buffer: 1}}
conveyors:
  belt: {from: a, to: b, speed: 0.5 m/s, pitch: 1 m, accumulating: FIRST}
  then: {from: b, to: c, speed: 0.7 m/s, pitch: 1.3 m, accumulating: SECOND}
products: {x: {route: [feeder, belt, then, packer]}, y: {route: [then, packer], priority: 1}}
sources: {s: {kind: saturated, products: [x]}, t: {kind: poisson, every: 25 s, products: [y]}}
"""
PACE = (
    ("feed: {dist: exponential, mean: 3 s,", "feed: {fixed: 2 s,"),
    ("pack: {dist: exponential, mean: 4 s,", "pack: {fixed: 2 s,"),
)


@pytest.mark.parametrize("first", ["true", "false"])
@pytest.mark.parametrize("second", ["true", "false"])
def test_jobs_ride_queue_and_get_off(first, second):
    log = twins(BELT, ("FIRST", first), ("SECOND", second))
    assert min(len(log.of(kind)) for kind in (FINISH, QUEUE, TRANSPORT)) > 40


@pytest.mark.parametrize("kind", ["true", "false"])
def test_what_gets_on_and_off_at_one_instant_does_so_in_one_order(kind):
    log = twins(BELT, ("FIRST", kind), ("SECOND", kind), ("0.7 m/s, pitch: 1.3 m", "0.5 m/s, pitch: 1 m"), *PACE)
    assert len(log.of(FINISH)) > 80


def test_a_belt_before_a_station_that_breaks_down_fills_and_empties():
    jam = "buffer: 1, breakdowns: {jam: {every: {fixed: 60 s}, repair: {fixed: 30 s}}}"
    log = twins(BELT, ("FIRST", "true"), ("SECOND", "false"), ("buffer: 1", jam))
    assert len(log.of(FINISH)) > 30
