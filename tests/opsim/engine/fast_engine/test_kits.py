"""Bills of material: who has his parts first, as SimPy's engine gives them out."""

from twins import twins

from opsim.log import HELD, JOIN, NO_PARTS

BENCH = """
opsim: 1
name: kits
run: {horizon: 900 s, seed: 6}
layout: {places: {here: [0 m, 0 m]}}
tasks: {join: {dist: exponential, mean: 6 s}, pack: {fixed: 4 s, automatic: true}}
stores: {rack: {at: here}, shelf: {at: here, initial: 4}}
stations:
  join: {at: here, tasks: [join], servers: 3, buffer: 4MORE}
  pack: {at: here, tasks: [pack], servers: 2, buffer: 2}
products:
  bolt: {route: [rack], lot: 4}
  plate: {route: [rack]}
  box: {route: [shelf]}
  small: {route: [join, pack], parts: {join: {bolt: 2}, pack: {box: 1}}}
  large: {route: [join, pack], lot: 2, priority: 1, parts: {join: {bolt: 3, plate: 1}, pack: {box: 1}}}
  plain: {route: [join]}
sources:
  parts: {kind: poisson, every: 6 s, products: [bolt, plate]}
  boxes: {kind: poisson, every: 9 s, products: [box]}
  jobs: {kind: poisson, every: 7 s, products: [small, large, plain]}
workers: {w1: {skills: {join: 1.0}}, w2: {skills: {join: 1.5}}}
"""


def bench(more=""):
    return BENCH.replace("MORE", more)


def waited(log):
    return int((log.of(HELD)["cause"] == NO_PARTS).sum())


def test_one_that_cannot_be_met_does_not_hold_up_those_behind_it():
    log = twins(bench())
    assert waited(log) > 40 and len(log.of(JOIN)) > 80


def test_the_jobs_of_a_batch_have_their_parts_together():
    log = twins(bench(", batch: {size: 2, most_wait: 30 s}"))
    assert waited(log) > 20 and len(log.of(JOIN)) > 60


def test_who_was_taken_off_his_server_asks_again():
    log = twins(bench(", preempt: resume"))
    assert waited(log) > 40
