"""Stations in the order in which jobs come to them, so that a figure of all of them reads along the flow."""

from __future__ import annotations

from opsim.plan import Plan, ProductPlan
from opsim.plan.station import STATION


def flow_order(plan: Plan) -> list[int]:
    """Ranks of all points of the flow: product by product, what goes into another ahead of it, each from its first
    step on; a station that only some products visit stands behind the one they come from. What is on no route, such as
    where rework is done, comes last in natural order.
    """
    found: list[int] = []
    for product in _parts_first(plan):
        way = along(plan.products[product])
        behind = next((found.index(rank) for rank in way if rank in found), len(found))
        for rank in way:
            if rank in found:
                behind = found.index(rank) + 1
            else:
                found.insert(behind, rank)
                behind += 1
    return list(dict.fromkeys([*found, *range(len(plan.stations))]))


def worked_on(plan: Plan) -> list[int]:
    """Those of them where jobs get work."""
    return [rank for rank in flow_order(plan) if plan.stations[rank].kind == STATION and plan.stations[rank].tasks]


def along(product: ProductPlan) -> list[int]:
    """Ranks of the points on a route, or of a network by the fewest steps to them, each once."""
    steps = [step for _, step in product.start if step >= 0]
    for step in steps:  # grows as it goes
        steps += [onward for _, onward in product.onward[step] if onward >= 0 and onward not in steps]
    return list(dict.fromkeys(rank for step in steps for rank in product.route[step].stations))


def _parts_first(plan: Plan) -> list[int]:
    """Ranks of the products, those that go into another one ahead of it."""
    found: list[int] = []

    def add(product: int, above: frozenset[int]) -> None:
        parts = sorted({part for kit in plan.kits if kit.product == product for part, _ in kit.parts})
        for part in parts:
            if part not in above:
                add(part, above | {part})
        found.append(product)

    for product in range(len(plan.products)):
        add(product, frozenset({product}))
    return list(dict.fromkeys(found))
