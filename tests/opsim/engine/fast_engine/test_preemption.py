"""Jobs that take servers from others, on both engines."""

import pytest
from twins import twins

from opsim.log import BLOCKED, HELD, PREEMPTED, QUEUE, REPAIR, SETUP, WALK

SAW = """
opsim: 1
name: saw
run: {horizon: 600 s, seed: 3}
layout: {places: {hall: [0 m, 0 m], far: [6 m, 0 m]}}
tasks: {cut: {dist: exponential, mean: 10 s, repeat: 2}, look: {fixed: 3 s}}
stations:
  saw: {at: hall, tasks: [cut, look], servers: 2, buffer: 6, preempt: HOW}
  end: {at: far, tasks: [look], buffer: 1}
products:
  low: {route: [saw, end], share: 0.5}
  mid: {route: [saw, end], share: 0.3, priority: 1}
  top: {route: [saw, end], share: 0.2, priority: 2}
release: {kind: poisson, every: 13 s}
workers:
  ana: {skills: {saw: 1.0, end: 1.0}, home: far, walk: 1 m/s}
  ben: {skills: {saw: 0.6}, home: far, walk: 2 m/s}
"""
AUTOMATIC = "repeat: 2}", "repeat: 2, automatic: true}"
SETUPS = "buffer: 6,", "buffer: 6, setup: {otherwise: 4 s, attended: true, by: product},"
JAMS = "buffer: 6,", "buffer: 6, breakdowns: {jam: {every: {dist: exponential, mean: 40 s}, repair: {fixed: 9 s}}},"


@pytest.mark.parametrize("how", ["resume", "restart"])
@pytest.mark.parametrize("edits", [(), (AUTOMATIC,), (SETUPS,), (JAMS,), (SETUPS, JAMS, AUTOMATIC)])
def test_servers_change_hands(how, edits):
    log = twins(SAW, ("HOW", how), *edits)
    assert PREEMPTED in log.of(QUEUE)["cause"]
    assert (len(log.of(SETUP)) > 0, len(log.of(REPAIR)) > 0) == (SETUPS in edits, JAMS in edits)


def test_who_walks_to_a_job_that_lost_its_server_comes_all_the_same():
    log = twins(SAW, ("HOW", "resume"), ("[6 m, 0 m]", "[20 m, 0 m]"))
    assert len(log.of(WALK)) > 10 and PREEMPTED in log.of(QUEUE)["cause"]


def test_who_loses_the_server_loses_the_place_downstream_too():
    log = twins(SAW, ("HOW", "resume"), ("buffer: 6,", "buffer: 6, blocking: before,"))
    assert len(log.of(HELD)) and not len(log.of(BLOCKED)) and PREEMPTED in log.of(QUEUE)["cause"]
