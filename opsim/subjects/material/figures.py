"""What lies in stores.

The law of cards: no more jobs are in a loop than it has cards.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import SECONDS_PER_HOUR, any_s, by_rank, created_s, in_window, inside_s, mean, window_length_s
from opsim.laws.jobs import Stays, peak
from opsim.log import JOIN, QUEUE, STOCK, EventLog
from opsim.plan import Plan
from opsim.plan.compile import has_card, stores_of
from opsim.subjects.material.plan import CardPlan
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
