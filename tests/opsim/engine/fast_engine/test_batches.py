"""Batches: who goes with whom and when, as SimPy's engine puts them together."""

import pytest
from twins import twins

from opsim.log import BATCH, HELD, QUEUE, WORK

OVEN = """
opsim: 1
name: oven
run: {horizon: 2000 s, seed: 8}
layout: {places: {here: [0 m, 0 m]}}
tasks: {bake: {dist: exponential, mean: 30 s, automatic: true}, load: {fixed: 5 s}}
stations:
  load: {at: here, tasks: [load], servers: 2, buffer: 3}
  oven: {at: here, tasks: [load, bake], servers: 2, buffer: 12, batch: {size: 4, of: product, most_wait: 60 s}}
products:
  a: {route: [load, oven], family: x, due: 200 s}
  b: {route: [load, oven], family: x, priority: 1}
  c: {route: [load, oven, load], due: 90 s, lot: 3}
sources: {jobs: {kind: poisson, every: 9 s, products: [a, b, c]}}
flow: {dispatch: fifo}
workers: {w1: {skills: {load: 1.0, oven: 1.0}}, w2: {skills: {load: 1.0}}}
"""


@pytest.mark.parametrize("of", ["any", "product", "family"])
def test_jobs_of_a_class_go_together(of):
    log = twins(OVEN, ("of: product", f"of: {of}"))
    assert (log.of(HELD)["cause"] == BATCH).sum() > 30 and (log.of(QUEUE)["cause"] == BATCH).sum() > 30


@pytest.mark.parametrize("rule", ["edd", "critical_ratio", "downstream_first"])
def test_a_rule_says_who_of_the_queue_goes_first(rule):
    assert len(twins(OVEN, ("dispatch: fifo", f"dispatch: {rule}")).of(WORK)) > 200


def test_batches_that_are_full_alone_wait_for_ever():
    assert len(twins(OVEN, (", most_wait: 60 s", "")).of(WORK)) > 200
