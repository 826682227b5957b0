"""Work that two neighbours share, as SimPy's engine leaves it from one to the other."""

import pytest
from twins import twins

from opsim.log import REWORK, WORK

LINE = """
opsim: 1
name: chain
run: {horizon: 1500 s, seed: 1}
layout: {places: {hall: [0 m, 0 m], far: [6 m, 0 m]}}
tasks:
  base: {dist: exponential, mean: 4 s}
  lid: {dist: exponential, mean: 5 s, repeat: 2}
  cap: {fixed: 2 s}
  close: {dist: exponential, mean: 6 s}
  look: {fixed: 3 s}
stations:
  front: {at: hall, tasks: [base, lid, cap], buffer: 1, servers: 2, share: {tasks: [lid, cap], with: back, when: RULE}}
  back: {at: far, tasks: [close, look], buffer: 2MORE, share: {tasks: [look], with: end, when: RULE}}
  end: {at: far, tasks: [look], buffer: 1}
products: {part: {route: [front, back, end]}, other: {route: [front, back, end], lot: 2}}
sources: {jobs: {kind: saturated, products: [part, other]}}
workers: {w1: {skills: {front: 1.0}}, w2: {skills: {back: 1.0, end: 0.8}}, w3: {skills: {front: 0.7, end: 1.0}}}
"""


@pytest.mark.parametrize("rule", ["half_full", "full"])
def test_the_same_tasks_are_left_to_the_partner(rule):
    log = twins(LINE.replace("RULE", rule).replace("MORE", ""))
    lid = log.names["task"].index("lid")
    rows = log.of(WORK)
    assert {log.names["station"][rank] for rank in rows["station"][rows["task"] == lid]} == {"front", "back"}


def test_a_job_that_comes_back_gets_the_partners_own_work_alone():
    more = ", inspect: {finds: 0.9, false_alarms: 0.3, then: {rework: back}, most: 2}"
    log = twins(LINE.replace("RULE", "half_full").replace("MORE", more))
    assert len(log.of(REWORK)) > 10
