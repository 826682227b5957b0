"""What lies in stores and on conveyors."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import SECONDS_PER_HOUR, by_rank, created_s, in_window, inside_s, mean, window_length_s
from opsim.log import BLOCKED, JOB_KINDS, JOIN, QUEUE, STOCK, EventLog
from opsim.plan import Plan
from opsim.plan.endings import stores_of
from opsim.plan.station import CONVEYOR, STORE


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
        yield Figure("parts_used_per_h", plan.products[product].name, "", "1/h", per_h)


def conveyors(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each conveyor: on_conveyor, jobs on it, averaged over the window; conveyor_blocked, the share of the window in
    which the job at its end finds no room.
    """
    for rank, belt in enumerate(plan.stations):
        if belt.kind != CONVEYOR:
            continue
        here = np.flatnonzero((log["station"] == rank) & (log["job"] >= 0) & np.isin(log["kind"], JOB_KINDS))
        blocked = here[log["kind"][here] == BLOCKED]
        length_s = window_length_s(plan)
        yield Figure("on_conveyor", belt.name, "", "jobs", inside_s(log, here, plan).sum() / length_s)
        yield Figure("conveyor_blocked", belt.name, "", "share", _any_s(log, plan, blocked) / length_s)


def _stock(log: EventLog, plan: Plan, rows: np.ndarray, store: str, product: str) -> Iterator[Figure]:
    length_s = window_length_s(plan)
    yield Figure("stock", store, product, "jobs", inside_s(log, rows, plan).sum() / length_s)
    yield Figure("stock_empty", store, product, "share", 1.0 - _any_s(log, plan, rows) / length_s)


def _any_s(log: EventLog, plan: Plan, rows: np.ndarray) -> float:
    """Seconds of the window in which any of some rows is open."""
    order = rows[np.argsort(log["start_s"][rows], kind="stable")]
    start_s, end_s = (np.clip(log[edge][order], *plan.window_s) for edge in ("start_s", "end_s"))
    covered_s = np.maximum.accumulate(np.r_[plan.window_s[0], end_s])[:-1]
    return float(np.maximum(end_s - np.maximum(start_s, covered_s), 0.0).sum())


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
            yield Figure("stored_per_h", product.name, "", "1/h", per_h)
            yield Figure("time_to_store_s", product.name, "", "s", mean(times_s))
