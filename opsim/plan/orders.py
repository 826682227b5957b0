"""The orders of a schedule, as an engine releases them: one job after the other."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import accumulate
from math import inf
from typing import Any

from opsim.clock import on_grid
from opsim.plan.calendar import next_open, open_times

ANY = -1
"""The product of an order that does not say one: drawn from the mix of its source."""


@dataclass(frozen=True, slots=True)
class OrderPlan:
    """So many jobs at a time, on the engine's grid of time.

    first    : number of the first of them in its source; product : its rank, or ``ANY``
    due_s    : when it is due, seconds from the start of the run; inf where the product's own due date stands
    priority : None where the product's own stands
    """

    time_s: float
    first: int
    quantity: int
    product: int
    due_s: float = inf
    priority: int | None = None


def plan_orders(loaded: Any, release: Any, products: dict[str, int]) -> tuple[tuple[OrderPlan, ...], int]:
    """The orders of a schedule that come before the horizon, by time, and how many orders come too late.

    Where the schedule has hours, what is ordered outside of them comes when the next of them begin.
    """
    from opsim.orders import read_orders
    from opsim.recorded import resolve_times

    orders, _ = read_orders(resolve_times(release.file, loaded.folder), products)
    hours, horizon_s = open_times(release.shift, loaded.scenario), loaded.scenario.run.horizon_s
    times_s = [order.time_s if hours is None else next_open(hours, order.time_s) for order in orders]
    in_time = [(order, time_s) for order, time_s in zip(orders, times_s) if time_s < horizon_s]
    firsts = accumulate((order.quantity for order, _ in in_time), initial=0)
    planned = tuple(
        OrderPlan(
            time_s,
            first,
            order.quantity,
            ANY if order.product is None else products[order.product],
            on_grid(order.due_s) if order.due_s < inf else inf,
            order.priority,
        )
        for (order, time_s), first in zip(in_time, firsts)
    )
    return planned, len(orders) - len(in_time)


def order_of(orders: tuple[OrderPlan, ...], n: int) -> OrderPlan:
    """The order that the n-th job of a schedule belongs to."""
    low, high = 0, len(orders)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if orders[middle].first <= n else (low, middle)
    return orders[low]


def due_of(plan: Any, source: int, n: int) -> float:
    """When a schedule wants the n-th job of a source, in seconds from the start; inf where it does not say.

    Jobs beyond the last order were asked for by somebody's own model: no order wants them.
    """
    orders = plan.sources[source].orders
    if not orders or n >= orders[-1].first + orders[-1].quantity:
        return inf
    return order_of(orders, n).due_s


def late_orders(plan: Any) -> Iterator[str]:
    """What of each schedule comes at or after the horizon, in a sentence: a warning, never refused."""
    for source in plan.sources:
        if source.n_late:
            late = f"{source.n_late} of {source.n_late + len(source.orders)} orders"
            yield f"{source.name}: {late} come at or after the horizon and are never released"
