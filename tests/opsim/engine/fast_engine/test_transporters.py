"""Vehicles on both engines: who is fetched by which, in what order, and where they go."""

import pytest
from twins import twins

from opsim.log import BLOCKED, FINISH, HELD, PICKUP, TRANSPORT, WAIT

TRUCK = """
opsim: 1
name: trucks
run: {horizon: 900 s, seed: 4}
layout: {places: {a: [0 m, 0 m], b: [20 m, 0 m], c: [30 m, 0 m], dock: [0 m, 10 m]}}
tasks: {cut: {dist: exponential, mean: 9 s}, pack: {dist: exponential, mean: 7 s, automatic: true}}
stations:
  saw: {at: a, tasks: [cut], servers: 2, buffer: 4, BEHIND}
  packer: {at: b, tasks: [pack], buffer: 3}
  store: {at: c, tasks: [pack], buffer: 3}
transporters:
  truck: {at: dock, n: 2, speed: 2 m/s, load: 3 s, unload: 2 s, capacity: LOAD, legs: [[saw, packer], [saw, store]]}
  cart: {at: c, speed: 1 m/s, load: 0 s, unload: 0 s, legs: [[packer, store]], idle: home}
products: {x: {route: [saw, packer, store], share: 0.6}, y: {route: [saw, store], priority: 1, share: 0.4}}
release: {kind: poisson, every: 14 s, at_once: 2}
workers: {ana: {skills: {saw: 1.0}}, ben: {skills: {saw: 0.8}}}
allocation: {when_blocked: free}
"""
PLAIN = "buffer: 4, BEHIND", "buffer: 4"
AFTER = "BEHIND", "buffer_after: 2"


@pytest.mark.parametrize("load", ["1", "3"])
@pytest.mark.parametrize("held", ["free", "held"])
@pytest.mark.parametrize("behind", [PLAIN, AFTER])
def test_vehicles_fetch_and_bring_what_calls_for_them(load, held, behind):
    log = twins(TRUCK, ("LOAD", load), behind, ("when_blocked: free", f"when_blocked: {held}"))
    assert len(log.of(FINISH)) > 20 and PICKUP in log.of(HELD)["cause"]
    assert set(log.of(TRANSPORT)["k"].tolist()) == {-1, 0, 1, 2}


def test_a_station_away_from_which_nobody_drives_for_nothing():
    """All places of one spot: vehicles come, load and unload in no time, and go home by no way."""
    log = twins(
        TRUCK, ("LOAD", "2"), PLAIN, ("load: 3 s, unload: 2 s", "load: 0 s, unload: 0 s"), ("[20 m, 0 m]", "[0 m, 0 m]")
    )
    assert len(log.of(FINISH)) > 20


def test_a_job_waits_for_room_before_it_calls_and_its_worker_is_free():
    log = twins(TRUCK, ("LOAD", "1"), PLAIN, ("mean: 7 s, automatic: true", "mean: 20 s, automatic: true"))
    assert len(log.of(BLOCKED)) and len(log.of(WAIT))
