"""Which waiting job is next, and which of several stations it goes to: as SimPy's engine decides."""

import pytest
from twins import twins

from opsim.engine.fast_engine.sequencing import ROUTING, SEQUENCING
from opsim.log import SETUP, WORK

SHOP = """
opsim: 1
name: shop
run: {horizon: 900 s, seed: 5}
layout: {places: {p: [0 m, 0 m], q: [4 m, 0 m], r: [8 m, 3 m]}}
tasks: {quick: {dist: exponential, mean: 4 s}, slow: {fixed: 7 s, repeat: 2}, cut: {fixed: 5 s}}
stations:
  m1: {at: p, tasks: [cut], buffer: 2}
  m2: {at: q, tasks: [slow], servers: 2, buffer: 3, setup: {otherwise: 3 s}}
  m3: {at: r, tasks: [quick], buffer: 2, setup: {times: {a: {c: 1 s}}, otherwise: 2 s, attended: false}}
  end: {at: r, tasks: [quick], setup: {otherwise: 2 s, by: family}}
products:
  a: {route: [[m3, m1, m2], end], due: 60 s, family: x}
  b: {route: [[m2, m3], m1, end], priority: 1, family: x, lot: 2}
  c: {route: [[m1, m3, m2], end], due: 30 s}
sources: {jobs: {kind: poisson, every: 8 s, products: [a, b, c]}}
flow: {dispatch: fifo, routing: shortest_queue}
workers:
  u: {walk: 1 m/s, skills: {m1: 1.0, m2: 0.8, end: 1.0}}
  v: {walk: 2 m/s, skills: {m2: 1.0, m3: 1.2, end: 1.0}}
  w: {walk: 2 m/s, skills: {m1: 1.0, m3: 1.0}}
"""


@pytest.mark.parametrize("rule", SEQUENCING)
def test_every_rule_takes_the_same_job_out_of_a_queue(rule):
    log = twins(SHOP, ("dispatch: fifo", f"dispatch: {rule}"))
    assert len(log.of(WORK)) > 150 and len(log.of(SETUP)) > 20


@pytest.mark.parametrize("rule", ROUTING)
def test_every_rule_takes_the_same_station(rule):
    log = twins(SHOP, ("routing: shortest_queue", f"routing: {rule}"))
    assert set(log.of(WORK)["station"]) == {0, 1, 2, 3}


def test_jobs_put_away_behind_a_station_do_not_count_against_it():
    log = twins(SHOP, ("buffer: 3,", "buffer: 3, buffer_after: 2,"), ("every: 8 s", "every: 5 s"))
    assert len(log.of(WORK)) > 150
