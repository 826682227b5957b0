"""What a Plan uses of sources, products and their ways, stores, cards and transport."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import isfinite

from opsim.plan import Plan
from opsim.subjects.release.plan import ANY
from opsim.subjects.stations.plan import STORE

MATERIAL_WORDS = (
    *(f"source: {kind}" for kind in ("saturated", "poisson", "renewal", "schedule", "base_stock", "inside")),
    *("source: drawn gaps", "source: several", "source: loses", "source: at_once", "source: sequence", "source: mix"),
    *("source: unequal shares", "source: hours", "order: quantity", "order: priority", "order: due", "order: any"),
    *("product: several", "product: priority", "product: due", "product: lot", "product: carried", "product: mass"),
    *("product: too heavy at once", "way: parallel", "way: drawn", "way: back to a station", "way: twice in a row"),
    *("way: rework detour", "store", "store: initial", "store: capacity", "parts", "parts: several of one", "split"),
    *("cards: whole way", "cards: loop", "cards: several loops", "cards: to a store", "batch: most_wait"),
    *("batch: full only", "batch: any", "batch: by class", "conveyor: accumulating", "conveyor: rigid"),
    *("transporter", "transporter: several", "transporter: capacity", "transporter: home", "transporter: roads"),
    *(f"routing: {rule}" for rule in ("shortest_queue", "least_loaded", "first_free", "in_order")),
)


def reached(plan: Plan) -> set[int]:
    """Points of the flow to which the products that some source makes can come."""
    made = {product for source in plan.sources for product, _ in source.mix}
    return {rank for product in made for step in plan.products[product].route for rank in step.stations}


def material_of(plan: Plan) -> set[str]:
    """Its words of ``MATERIAL_WORDS``."""
    return {*_sources(plan), *_products(plan), *_ways(plan), *_stores(plan), *_cards(plan), *_transport(plan)}


def _sources(plan: Plan) -> Iterator[str]:
    outside = [source for source in plan.sources if source.kind != "inside"]
    yield from ("source: several",) if len(outside) > 1 else ()
    for source in plan.sources:
        yield f"source: {source.kind}"
        said = {
            "drawn gaps": source.gap is not None and type(source.gap).__name__ != "Fixed",
            "loses": source.when_full == "lose",
            "at_once": source.at_once > 1,
            "sequence": bool(source.sequence),
            "mix": source.kind != "inside" and len(source.mix) > 1 and not source.sequence,
            "unequal shares": source.kind != "inside" and len({share for _, share in source.mix}) > 1,
            "hours": source.open_s is not None,
        }
        yield from (f"source: {word}" for word, is_so in said.items() if is_so)
        yield from ("order: quantity",) if any(order.quantity > 1 for order in source.orders) else ()
        yield from ("order: priority",) if any(order.priority for order in source.orders) else ()
        yield from ("order: due",) if any(isfinite(order.due_s) for order in source.orders) else ()
        yield from ("order: any",) if any(order.product == ANY for order in source.orders) else ()


def _products(plan: Plan) -> Iterator[str]:
    yield from ("product: several",) if len(plan.products) > 1 else ()
    most_kg = [worker.most_load_kg for worker in plan.workers if worker.most_load_kg is not None]
    for one in plan.products:
        heavy = one.carried and one.mass_kg is not None
        said = {
            "priority": one.priority != 0,
            "due": isfinite(one.due_s),
            "lot": one.lot > 1,
            "carried": one.carried,
            "mass": heavy,
            "too heavy at once": heavy and any(one.lot * (one.mass_kg or 0.0) > kg for kg in most_kg),
        }
        yield from (f"product: {word}" for word, is_so in said.items() if is_so)


def _ways(plan: Plan) -> Iterator[str]:
    choices = [step for product in plan.products for step in product.route if step.listed]
    if choices:
        yield "way: parallel"
        yield f"routing: {plan.routing}"
    for product in plan.products:
        steps = [step.stations for step in product.route]
        drawn = any(len(ways) > 1 for ways in (product.start, *product.onward))
        entered = {step for ways in (product.start, *product.onward) for _, step in ways}
        said = {
            "drawn": drawn,
            "back to a station": drawn
            and any(0 <= to <= at for at, ways in enumerate(product.onward) for _, to in ways),
            "twice in a row": not drawn and any(a == b for a, b in pairwise(steps)),
            "rework detour": not drawn and any(step not in entered for step in range(len(steps))),
        }
        yield from (f"way: {word}" for word, is_so in said.items() if is_so)


def _stores(plan: Plan) -> Iterator[str]:
    yield from ("store",) if plan.stores else ()
    yield from ("store: initial",) if any(store.initial for store in plan.stores) else ()
    yield from ("store: capacity",) if any(one.kind == STORE and isfinite(one.buffer) for one in plan.stations) else ()
    yield from ("parts",) if plan.kits else ()
    yield from ("parts: several of one",) if any(n > 1 for kit in plan.kits for _, n in kit.parts) else ()
    yield from ("split",) if plan.splits else ()
    for batch in plan.batches:
        yield "batch: most_wait" if isfinite(batch.most_wait_s) else "batch: full only"
        yield "batch: by class" if len(set(batch.class_of)) > 1 else "batch: any"


def _cards(plan: Plan) -> Iterator[str]:
    loops = [card for card in plan.cards if card.back and any(card.steps)]
    yield from ("cards: whole way",) if any(not card.back and any(card.steps) for card in plan.cards) else ()
    yield from ("cards: loop",) if loops else ()
    yield from ("cards: several loops",) if len(loops) > 1 else ()
    if any(plan.stations[rank].kind == STORE for card in loops for rank in card.back):
        yield "cards: to a store"


def _transport(plan: Plan) -> Iterator[str]:
    here = reached(plan)
    for belt in plan.conveyors:
        if belt.station in here:
            yield "conveyor: accumulating" if belt.accumulating else "conveyor: rigid"
    for truck in plan.transporters:
        if any({leg.before, leg.after} <= here for leg in truck.legs):
            yield "transporter"
            yield from ("transporter: several",) if truck.n > 1 else ()
            yield from ("transporter: capacity",) if truck.capacity > 1 else ()
            yield from ("transporter: home",) if truck.goes_home else ()
            yield from ("transporter: roads",) if truck.distance_m != plan.distance_m else ()
