"""Batches that are not full: what could still fill them.

Sources: which of them may still bring something, and those that wait for what lies in a store for good.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf

import numpy as np

from opsim.kpi.wait_graph import Inside, Pool, Way
from opsim.log import BATCH, JOB_KINDS, QUEUE, EventLog
from opsim.plan import Plan
from opsim.subjects.release.plan import BASE_STOCK, INSIDE, SCHEDULE, SourcePlan
from opsim.subjects.stations.plan import BatchPlan

TO_FILL = "its batch to fill"


def filling(product: int, station: int) -> str:
    """The pool of jobs of a product that are still to come to a batch."""
    return f"filling {product} {station}"


def endless(plan: Plan) -> list[BatchPlan]:
    """The batches that begin only when they are full."""
    return [batch for batch in plan.batches if batch.most_wait_s == inf]


def fillers(plan: Plan, batch: BatchPlan) -> list[int]:
    """The products that come to a station of batches, in natural order."""
    return [
        rank
        for rank, made in enumerate(plan.products)
        if any(batch.station in operation.stations for operation in made.route)
    ]


def spaces_of(plan: Plan, inside: Sequence[Inside]) -> dict[str, Pool]:
    """Of each station of batches the places in which jobs wait for one, ``space 3``."""
    pools = {}
    for batch in endless(plan):
        place = plan.stations[batch.station]
        queue = {one.name: one.n for one in inside if one.station == batch.station and one.kind == QUEUE}
        free = max(0.0, place.capacity - place.servers - sum(queue.values()))
        what = f"{TO_FILL}, and there is no place at {place.name}"
        pools[f"space {batch.station}"] = Pool(what, free, queue)
    return pools


def ways_to_fill(one: Inside, plan: Plan, inside: Sequence[Inside]) -> tuple[Way, ...] | None:
    """Somebody of its class who comes, with room for all that are missing; None where waiting ends by time."""
    batch = next((batch for batch in endless(plan) if batch.station == one.station), None)
    if batch is None:
        return None
    kind = batch.class_of[one.product]
    here = sum(
        other.n
        for other in inside
        if other.station == one.station and other.waits(QUEUE, BATCH) and batch.class_of[other.product] == kind
    )
    space, missing = f"space {one.station}", batch.size - here
    alike = [product for product in fillers(plan, batch) if batch.class_of[product] == kind]
    return tuple(((space, missing), (filling(product, one.station), 1)) for product in alike)


NOBODY = "somebody to take it, and nothing does"


def outside_at_end(log: EventLog) -> frozenset[int]:
    """The products of which jobs wait outside when the run ends."""
    rows = np.isin(log["kind"], JOB_KINDS) & (log["job"] >= 0) & (log["station"] < 0) & (log["end_s"] == log.horizon_s)
    return frozenset(log["product"][rows].tolist())


def bringing(
    plan: Plan, product: int, starts: Sequence[Way], outside: frozenset[int]
) -> Iterator[tuple[SourcePlan, tuple[Way, ...]]]:
    """Each source that may bring more of a product, with the ways by which it comes in, given its starts.

    One of a time of its own may do so at any time, a schedule while it has orders, and a store that is kept filled asks
    for more once somebody takes a piece, or when its hours begin. Jobs that wait outside were brought already.
    """
    for source in plan.sources:
        if source.kind == INSIDE or all(product != made for made, _ in source.mix):
            continue
        if source.kind == BASE_STOCK and product not in outside and source.is_open_at(plan.horizon_s):
            yield source, tuple(((f"taker {product}", 1), *start) for start in starts)
        elif source.kind != SCHEDULE or source.n_late or product in outside:
            yield source, tuple(starts)


def cards_before(plan: Plan, product: int, step: int) -> Way:
    """The cards that a job takes before a step."""
    return tuple((f"card {rank}", 1) for rank, card in enumerate(plan.cards) if step in card.steps[product])


def add_sources(
    pools: dict[str, Pool], waits: dict[str, tuple[Way, ...]], plan: Plan, outside: frozenset[int]
) -> dict[str, str]:
    """Add the sources that have something to bring in as those who wait for room and cards; returns them in words.

    What lies in a store from which nothing takes stays there whatever happens. That is as it should be, but where the
    source can bring nothing more because of it: so the source stands for who would take it.
    """
    words: dict[str, str] = {}
    taken = {part for kit in plan.kits for part, _ in kit.parts}
    dead_ends = [product for product in range(len(plan.products)) if product not in taken]
    for rank, source in enumerate(plan.sources):
        made = [product for product, _ in source.mix]
        asked_for = source.kind in (BASE_STOCK, SCHEDULE)
        if source.kind == INSIDE or (asked_for and not source.n_late and outside.isdisjoint(made)):
            continue
        name = f"~source {rank}"
        words[name], waits[name] = f"source {source.name}", tuple(_entries(pools, plan, made))
        for product in dead_ends:
            pools[f"taker {product}"].give_to(name)
    return words


def _entries(pools: dict[str, Pool], plan: Plan, products: Sequence[int]) -> Iterator[Way]:
    """A place at a first station, where somebody has those there are, and the cards that are taken before it."""
    for product in products:
        for _, step in plan.products[product].start:
            for station in plan.products[product].route[step].stations:
                room = f"room {station}"
                yield (*(((room, 1),) if pools[room].holders else ()), *cards_before(plan, product, step))
