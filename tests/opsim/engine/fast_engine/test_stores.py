"""Stores: what came first is taken first, and of lots in part, as SimPy's engine does."""

from twins import twins

from opsim.log import BAD, JOIN, QUEUE, STOCK

BENCH = """
opsim: 1
name: bench
run: {horizon: 800 s, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
tasks: {join: {dist: exponential, mean: 9 s}, make: {dist: exponential, mean: 5 s}}
stores: {wheels: {at: here, capacity: 4, initial: 2}, frames: {at: here, initial: {frame: 3, heavy: 1}}}
stations: {press: {at: here, tasks: [make], buffer: 2, yield: 0.8}, join: {at: here, tasks: [join], buffer: 2}}
products:
  wheel: {route: [press, wheels], lot: 5}
  frame: {route: [frames]}
  heavy: {route: [frames], lot: 3}
  bike: {route: [join], parts: {join: {wheel: 2, frame: 1, heavy: 2}}}
sources:
  wheels: {kind: saturated, products: [wheel]}
  frames: {kind: poisson, every: 8 s, products: [frame, heavy]}
  bikes: {kind: poisson, every: 10 s, products: [bike]}
workers: {w1: {skills: {press: 1.0}}, w2: {skills: {join: 1.0}}}
"""


def test_lots_are_taken_in_part_and_what_is_bad_makes_bad():
    log = twins(BENCH)
    assert len(log.of(JOIN)) > 30 and STOCK in log.of(QUEUE)["cause"]
    finished = log.where(log["product"] == log.names["product"].index("bike"))
    assert BAD in finished["cause"]


def test_a_full_store_blocks_who_makes_for_it():
    log = twins(BENCH, ("capacity: 4", "capacity: 2"), ("every: 10 s", "every: 30 s"))
    assert len(log.of(JOIN)) > 10
