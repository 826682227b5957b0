"""Jobs come in as SimPy's engine lets them in: some at once, where nothing else happens, others by their claims."""

import pytest
from twins import twins

from opsim.log import BLOCKED, FINISH

LINE = """
opsim: 1
name: line
run: {horizon: 2000 s, seed: 6}
layout: {places: {hall: [0 m, 0 m], far: [4 m, 0 m]}}
tasks:
  cut: {TIME, automatic: true}
  bend: {TIME, automatic: true}
  check: {TIME}
stations:
  saw: {at: hall, tasks: [cut], buffer: 1}
  oven: {at: hall, tasks: [bend], buffer: ROOM, servers: 2}
  press: {at: far, tasks: [bend], buffer: ROOM}
  bench: {at: far, tasks: [check], buffer: ROOM}
products:
  plate: {route: [saw, oven, press, bench]}
  sheet: {route: [oven, press, press, bench]}
sources:
  plates: {kind: saturated, products: [plate]}
  sheets: {kind: poisson, every: 40 s, products: [sheet]}
workers: {w1: {skills: {bench: 1.0}}}
allocation: {when_blocked: HELD}
"""
TIMES = {"ties": "fixed: 8 s", "hardly any ties": "dist: exponential, mean: 8 s"}


@pytest.mark.parametrize("held", ["free", "held"])
@pytest.mark.parametrize("room", [0, 2, 50])
@pytest.mark.parametrize("time", TIMES)
def test_who_comes_in_when_is_the_same(time, room, held):
    log = twins(LINE.replace("TIME", TIMES[time]).replace("ROOM", str(room)).replace("HELD", held))
    assert len(log.of(FINISH)) > 40
    assert room or len(log.of(BLOCKED)) > 40
