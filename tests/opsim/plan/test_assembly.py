"""Stores, kits, splits, batches and lots as numbers."""

from math import inf

from plans import plan

from opsim.plan.sources import INSIDE
from opsim.plan.stores import jobs_on_a_server

TEXT = """
opsim: 1
name: bikes
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {do: {fixed: 10 s, automatic: true, per: lot}}
stores: {rims: {at: here, initial: 3}, mixed: {at: here, capacity: 9, initial: {a: 1, b: 2}}}
stations:
  join: {at: here, tasks: [do], buffer: 4, batch: {size: 3, most_wait: 60 s, of: family}}
  saw: {at: here, tasks: [do], servers: 2}
products:
  a: {route: [mixed]}
  b: {routing: {start: saw, saw: {mixed: 0.5, out: 0.5}}}
  rim: {route: [rims]}
  bike: {lot: 5, family: big, route: [join], parts: {join: {rim: 2, a: 1}}}
  log: {lot: 2, family: big, route: [saw], split: {saw: {b: 3, chip: 1}}}
  chip: {lot: 4, route: [join], split: {join: {a: 2}}}
sources:
  logs: {kind: poisson, every: 60 s, products: [log]}
  bikes: {kind: poisson, every: 60 s, products: [bike]}
"""
PLAN = plan(TEXT)
PRODUCTS = [product.name for product in PLAN.products]
STATIONS = [station.name for station in PLAN.stations]
SOURCES = [source.name for source in PLAN.sources]


def test_named_sources_come_first_and_what_they_make_necessary_follows_in_natural_order():
    assert [*("bikes", "logs", "logs > b", "logs > chip", "logs > chip > a", "stock: mixed", "stock: rims")] == SOURCES
    assert {source.kind for source in PLAN.sources[2:]} == {INSIDE}
    mixed = PLAN.sources[SOURCES.index("stock: mixed")]
    assert mixed.mix == ((PRODUCTS.index("a"), 1 / 3), (PRODUCTS.index("b"), 2 / 3))


def test_a_number_alone_is_of_the_product_that_ends_there():
    rims = next(store for store in PLAN.stores if STATIONS[store.station] == "rims")
    assert rims.initial == ((PRODUCTS.index("rim"), 3),) and SOURCES[rims.source] == "stock: rims"


def test_a_store_is_a_point_without_servers():
    store = PLAN.stations[STATIONS.index("mixed")]
    assert (store.kind, store.servers, store.capacity, store.tasks) == ("store", 0, 9, ())
    assert PLAN.stations[STATIONS.index("rims")].capacity == inf


def test_parts_are_in_the_order_of_products():
    (kit,) = PLAN.kits
    assert (PRODUCTS[kit.product], STATIONS[kit.station]) == ("bike", "join")
    assert kit.parts == ((PRODUCTS.index("a"), 1), (PRODUCTS.index("rim"), 2))


def test_pieces_have_sources_of_their_own_by_the_source_of_the_job():
    """A lot of 2 logs is 6 single b, and 2 chips in one lot; 4 chips of a lot are 8 a."""
    found = {
        (PRODUCTS[split.product], SOURCES[of], PRODUCTS[piece], SOURCES[source], most)
        for split in PLAN.splits
        for of, piece, source, most in split.sources
    }
    assert found == {
        ("log", "logs", "b", "logs > b", 6),
        ("log", "logs", "chip", "logs > chip", 1),
        ("chip", "logs > chip", "a", "logs > chip > a", 8),
    }


def test_a_family_is_a_class_and_who_has_none_is_by_himself():
    (batch,) = PLAN.batches
    of = dict(zip(PRODUCTS, batch.class_of))
    assert of["bike"] == of["log"] and len(set(of.values())) == 5
    assert (batch.size, batch.most_wait_s) == (3, 60.0)


def test_a_routing_ends_in_a_store():
    b = PLAN.products[PRODUCTS.index("b")]
    assert [step.name for step in b.route] == ["mixed", "saw"]
    assert b.onward == (((1.0, -1),), ((0.5, 0), (1.0, -1))) and b.visits() == (0.5, 1.0)


def test_lots_and_what_is_done_once_for_them():
    assert [product.lot for product in PLAN.products] == [1, 1, 5, 4, 2, 1] and PLAN.tasks[0].per_lot


def test_so_many_jobs_may_share_a_server():
    """Three of a batch, each of which may become 8 pieces; 7 pieces of a log on the saw."""
    assert [jobs_on_a_server(PLAN, STATIONS.index(name)) for name in ("join", "saw", "rims")] == [24, 7, 1]
