"""Batches that are not full: what could still fill them."""

from collections.abc import Sequence
from math import inf

from opsim.kpi.waits.graph import Pool, Way
from opsim.kpi.waits.inside import Inside
from opsim.log import BATCH, QUEUE
from opsim.plan import Plan
from opsim.plan.assembly import BatchPlan

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
