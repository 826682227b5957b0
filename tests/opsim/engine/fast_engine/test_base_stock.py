"""Stores that are kept filled, as SimPy's engine asks for pieces."""

from twins import twins

from opsim.log import CREATE, SCRAP

STOCK = """
opsim: 1
name: stock
run: {horizon: 1500 s, seed: 4}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {make: {dist: exponential, mean: 4 s}, pack: {fixed: 3 s, automatic: true}}
stations:
  s1: {at: hall, tasks: [make], buffer: 2, inspect: {finds: 0.9, false_alarms: 0.2, then: scrap}}
  s2: {at: hall, tasks: [make]}
  out: {at: hall, tasks: [pack], servers: 2}
stores: {rack: {at: hall, initial: 1}, shelf: {at: hall}}
products:
  piece: {route: [s1, rack], lot: 3}
  lid: {route: [s2, shelf]}
  order: {route: [out], parts: {out: {piece: 2, lid: 1}}}
sources:
  orders: {kind: poisson, every: 12 s, at_once: 2, products: [order]}
  lids: {kind: base_stock, store: shelf, level: 3}
  refill: {kind: base_stock, store: rack, level: 4}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 1.0}}}
"""


def test_pieces_are_begun_for_what_was_taken_is_waited_for_or_was_scrapped():
    log = twins(STOCK)
    assert len(log.of(SCRAP)) > 10 and len(log.of(CREATE)) > 300
