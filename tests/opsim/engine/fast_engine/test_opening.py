"""Hours of stations and sources, on both engines."""

import pytest
from twins import twins

from opsim.log import CLOSED, CREATE, HELD, OFF, WORK

ONE = """
opsim: 1
name: two machines
run: {start: Mon 06:00, horizon: 400 s, seed: 2}
layout: {places: {hall: [0 m, 0 m]}}
shifts:
  a: {from: 06:00:20, to: 06:00:55}
  b: {from: 06:01:20, to: 06:01:50}
  c: {from: 06:02:10, to: 06:05:00}
tasks: {press: {dist: exponential, mean: 7 s, automatic: true}, trim: {dist: exponential, mean: 6 s}}
stations:
  m: {at: hall, tasks: [press], servers: 2, buffer: 2, shift: [b, a, c], at_close: HOW}
  n: {at: hall, tasks: [trim, press], buffer: 1, shift: [a, c], at_close: HOW}
products: {part: {route: [m, n]}}
release: {kind: saturated, shift: [a, b]}
workers: {ana: {skills: {n: 1.0}}}
"""
GAPS = "{kind: saturated, shift: [a, b]}", "{kind: poisson, every: 9 s, shift: [a, b, c]}"
EACH = (
    "release: {kind: saturated, shift: [a, b]}",
    (
        "sources: {x: {kind: saturated, shift: [a], products: [part]}, y: {kind: saturated, products: [part]}, "
        "z: {kind: poisson, every: 20 s, shift: [c], products: [part]}}"
    ),
)


@pytest.mark.parametrize("how", ["finish", "resume"])
@pytest.mark.parametrize("sources", [(), (GAPS,), (EACH,)])
def test_stations_and_sources_open_and_close(how, sources):
    log = twins(ONE, ("HOW", how), *sources)
    assert len(log.of(OFF)) == 7 and len(log.of(WORK)) > 20 and len(log.of(CREATE)) > 5
    assert CLOSED in log.of(HELD)["cause"]


def test_who_is_pre_empted_at_a_station_that_closes_waits_until_it_opens():
    log = twins(
        ONE,
        ("HOW", "finish"),
        GAPS,
        ("servers: 2, buffer: 2,", "servers: 1, buffer: 5, preempt: resume,"),
        ("part: {route: [m, n]}", "part: {route: [m, n], share: 0.6}, hot: {route: [m, n], priority: 1, share: 0.4}"),
    )
    assert CLOSED in log.of(HELD)["cause"]
