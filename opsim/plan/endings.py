"""Where the ways of products end: out of the floor, in a store, or in the pieces they are split into."""

from opsim.plan.plan import Plan
from opsim.plan.station import STORE


def finishes(plan: Plan, product: int) -> bool:
    """Whether jobs of a product can leave the floor as something finished."""
    apart = {split.station for split in plan.splits if split.product == product}
    return any(plan.stations[rank].kind != STORE and rank not in apart for rank in _last_points(plan, product))


def stores_of(plan: Plan, product: int) -> list[int]:
    """The stores in which the ways of a product end, by rank."""
    return sorted(rank for rank in _last_points(plan, product) if plan.stations[rank].kind == STORE)


def _last_points(plan: Plan, product: int) -> set[int]:
    made = plan.products[product]
    ends = (step for step, onward in zip(made.route, made.onward) if any(to < 0 for _, to in onward))
    return {rank for step in ends for rank in step.stations}
