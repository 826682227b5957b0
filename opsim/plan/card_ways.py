"""Where on its way a job has a card of a loop."""

from collections.abc import Sequence

from opsim.plan.cards import CardPlan
from opsim.plan.material import ProductPlan
from opsim.plan.plan import Plan


def has_card(card: CardPlan, rank: int, plan: Plan, points: Sequence[int]) -> list[bool]:
    """(rows,) whether a job of a product had a card in each of its rows, from the points it was at in turn.

    Of a plain route the steps are told apart; else a card is taken wherever one ever is taken. What lies in a store at
    the start has a card of a loop that ends there, or on the way out. Where the loop may have ended at a station that
    is only passed, and leaves no row, the job has none.
    """
    product = plan.products[rank]
    steps, has, before, at = set(card.steps[rank]), False, -1, -1
    taken = {point for step in steps for point in product.route[step].stations}
    first = {point for _, step in product.start for point in product.route[step].stations}
    ends = {point for point in card.back if plan.stations[point].kind == "station" and not plan.stations[point].tasks}
    in_a_row = all(ways == ((1.0, step + 1),) for step, ways in enumerate(product.onward[:-1]))
    found = []
    for point in points:
        if point != before:
            came, at = at, _next_step(product, at, point) if in_a_row else -1
            enters = at in steps if at >= 0 else point in taken
            in_stock = bool(steps) and before < 0 and point in (card.back or (point,)) and point not in first
            left = before in card.back or _may_have_passed(product, ends, came, at)
            has = (has and not left) or enters or in_stock
            before = point
        found.append(has)
    return found


def _may_have_passed(product: ProductPlan, ends: set[int], came: int, at: int) -> bool:
    """Whether a job may have been at one of some points between two steps of its route; -1: at any step."""
    between = product.route[came + 1 : at] if min(came, at) >= 0 else product.route
    return bool(ends) and any(ends.intersection(operation.stations) for operation in between)


def _next_step(product: ProductPlan, at: int, point: int) -> int:
    """The first step after another at which a job can be at a point; -1 where there is none."""
    later = range(at + 1, len(product.route))
    return next((step for step in later if point in product.route[step].stations), -1)
