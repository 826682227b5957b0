"""A store that is kept filled: pieces are begun for those that were taken, wanted or scrapped."""

import pytest
from plans import plan

from opsim.engine.floor import run_plan
from opsim.laws import audit
from opsim.log import CREATE, FINISH, SCRAP, WORK

STOCK = """
opsim: 1
name: stock
run: {horizon: 100 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {make: {fixed: 3 s, automatic: true}}
stations: {s1: {at: hall, tasks: [make]}, out: {at: hall, tasks: [], servers: 9}}
stores: {rack: {at: hall, initial: 2}}
products: {piece: {route: [s1, rack]}, order: {route: [out], parts: {out: {piece: 1}}}}
"""
ORDERS = "orders: {kind: renewal, every: {fixed: 20 s}, products: [order]}"


def run(text):
    made = plan(text)
    log = run_plan(made)
    audit(log, made)
    return log


@pytest.mark.parametrize(("level", "starts"), [
    (2, [20, 40, 60, 80]),
    (3, [0, 20, 40, 60, 80]),
    (0, [60, 80]),  # two orders are met from what lies there
])  # fmt: skip
def test_a_base_stock_makes_a_piece_whenever_stock_and_what_is_on_the_way_are_below_its_level(level, starts):
    refill = f"refill: {{kind: base_stock, store: rack, level: {level}}}"
    log = run(f"{STOCK}sources: {{{ORDERS}, {refill}}}\n")
    assert log.of(WORK)["start_s"].tolist() == starts


def test_a_base_stock_follows_demand_that_it_cannot_meet_at_once():
    """Five orders at once on a stock of two: five pieces are begun at once, one for each order."""
    burst = ORDERS.replace("every: {fixed: 20 s}", "every: {fixed: 60 s}, at_once: 5")
    log = run(f"{STOCK}sources: {{{burst}, refill: {{kind: base_stock, store: rack, level: 2}}}}\n")
    created = log.where((log["kind"] == CREATE) & (log["product"] == 1) & (log["end_s"] > 0))
    assert created["end_s"].tolist() == [60.0] * 5
    assert log.of(FINISH)["end_s"].tolist() == [60.0, 60.0, 63.0, 66.0, 69.0]


def test_scrap_on_the_way_is_made_again_by_a_base_stock():
    text = STOCK.replace("s1: {at: hall, tasks: [make]}", "s1: {at: hall, tasks: [make], scrap: 0.6}")
    log = run(f"{text}sources: {{{ORDERS}, refill: {{kind: base_stock, store: rack, level: 3}}}}\n")
    scrapped, created = log.of(SCRAP)["end_s"], log.where((log["kind"] == CREATE) & (log["product"] == 1))
    assert scrapped.size >= 5
    assert set(scrapped) <= set(created["end_s"])
