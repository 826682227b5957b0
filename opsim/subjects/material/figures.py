"""What lies in stores, and in which of them, or in what else, the ways of products end.

The law of cards: no more jobs are in a loop than it has cards; where on its way a job has one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import SECONDS_PER_HOUR, any_s, by_rank, created_s, in_window, inside_s, mean, window_length_s
from opsim.laws.jobs import Stays, peak
from opsim.log import JOIN, QUEUE, STOCK, EventLog
from opsim.plan.plan import Plan
from opsim.subjects.material.plan import CardPlan
from opsim.subjects.routes.plan import ProductPlan
from opsim.subjects.stations.plan import STORE


def stores(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each store:

    stock       : jobs that lie there, averaged over the window; of each product where several end there
    stock_empty : share of the window in which there is none; of each product where several end there
    And parts_used_per_h of each product that others are made of, in units; what ``stored`` says of those that come.
    """
    for rank, store in enumerate(plan.stations):
        if store.kind != STORE:
            continue
        here = np.flatnonzero((log["station"] == rank) & (log["kind"] == QUEUE) & (log["cause"] == STOCK))
        yield from _stock(log, plan, here, store.name, "")
        ends = [product for product in range(len(plan.products)) if rank in stores_of(plan, product)]
        for product in ends if len(ends) > 1 else ():
            of_it = here[log["product"][here] == product]
            yield from _stock(log, plan, of_it, store.name, plan.products[product].name)
    yield from stored(log, plan)
    used = np.flatnonzero((log["kind"] == JOIN) & in_window(log["end_s"], plan))
    for product in sorted({part for kit in plan.kits for part, _ in kit.parts}):
        units = int((log["product"][used] == product).sum()) * plan.products[product].lot
        per_h = units / (window_length_s(plan) / SECONDS_PER_HOUR)
        yield figure("parts_used_per_h", plan.products[product].name, "", per_h)


def _stock(log: EventLog, plan: Plan, rows: np.ndarray, store: str, product: str) -> Iterator[Figure]:
    length_s = window_length_s(plan)
    yield figure("stock", store, product, inside_s(log, rows, plan).sum() / length_s)
    yield figure("stock_empty", store, product, 1.0 - any_s(log, plan, rows) / length_s)


def stored(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each product that ends in a store: stored_per_h, units that came there in an hour of the window, and
    time_to_store_s, their mean time from creation. What is taken as it comes is counted too, initial stock is not.
    """
    lying = np.flatnonzero((log["kind"] == QUEUE) & (log["cause"] == STOCK))
    used = np.flatnonzero(log["kind"] == JOIN)
    used = used[~np.isin(log["job"][used], log["job"][lying])]
    rows = np.r_[lying, used]
    came_s = np.r_[log["start_s"][lying], log["end_s"][used]]
    took_s = came_s - created_s(log, log["job"][rows])
    counted = in_window(came_s, plan) & (took_s > 0)
    by_product = by_rank(took_s[counted], log["product"][rows][counted], len(plan.products))
    for rank, (product, times_s) in enumerate(zip(plan.products, by_product)):
        if stores_of(plan, rank):
            per_h = times_s.size * product.lot / (window_length_s(plan) / SECONDS_PER_HOUR)
            yield figure("stored_per_h", product.name, "", per_h)
            yield figure("time_to_store_s", product.name, "", mean(times_s))


def cards_in_use(plan: Plan, stays: Stays) -> Iterator[str]:
    """No more jobs are in a loop than it has cards."""
    for card in plan.cards:
        found = _most_cards(stays.rows, plan, card)
        if found > card.n:
            yield f"loop {card.name}: {found} jobs in it at once on {card.n} cards"


def _most_cards(rows: EventLog, plan: Plan, card: CardPlan) -> int:
    """The most jobs at once that were seen to have a card: from a point where one is taken until they left its end."""
    wanted = [rank for rank, steps in enumerate(card.steps) if steps]
    here = np.flatnonzero(np.isin(rows["product"], wanted) & (rows["station"] >= 0))
    here = here[np.argsort(rows["job"][here], kind="stable")]
    firsts = np.flatnonzero(np.diff(rows["job"][here], prepend=-1))
    has = np.zeros(here.size, dtype=bool)
    for first, last in zip(firsts, [*firsts[1:], here.size]):
        product = int(rows["product"][here[first]])
        has[first:last] = has_card(card, product, plan, rows["station"][here[first:last]].tolist())
    return peak(rows.where(here[has]))


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
