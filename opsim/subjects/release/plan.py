"""The orders of a schedule, as an engine releases them: one job after the other.

How jobs come in: one source or several.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import accumulate
from math import inf
from typing import TYPE_CHECKING, Any

from opsim.clock import on_grid
from opsim.plan.ranks import Ranks
from opsim.problems import natural_key
from opsim.subjects.shifts.plan import OPEN, next_open, open_times
from opsim.task_model import TaskModel

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario

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
    from opsim.csv_input import read_orders, resolve_times

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


RELEASE = "release"
"""The name of the one source of a scenario that has a ``release``."""
SATURATED, POISSON, RENEWAL, SCHEDULE, BASE_STOCK = "saturated", "poisson", "renewal", "schedule", "base_stock"
INSIDE = "inside"
"""The kind of a source of jobs that other jobs, or the start of a run, bring about: nothing comes of itself."""
Mix = tuple[tuple[int, float], ...]


@dataclass(frozen=True, slots=True)
class SourcePlan:
    """kind : ``saturated`` (a new job whenever the first buffer has room), ``poisson``, ``renewal``, ``schedule``,
    ``base_stock`` (a new job whenever its store wants one) or ``inside``

    every_s  : mean gap between arrivals, 0 where the floor decides; gap : model of the gaps, None unless renewal
    mix      : (product rank, share) of what it makes, in natural order; the shares sum to 1
    at_once  : jobs at each arrival
    sequence : product ranks in the order in which they are made, again and again; empty where drawn from the mix
    orders   : of a schedule, in order of time; n_late : how many more come at the horizon or later
    store, level : rank of the store that is kept filled, and up to how many pieces; -1 where none is
    open_s : when it makes jobs, None where always: gaps count the time that it is open
    """

    name: str
    kind: str
    every_s: float
    when_full: str
    mix: Mix
    gap: TaskModel | None = None
    at_once: int = 1
    sequence: tuple[int, ...] = ()
    orders: tuple[OrderPlan, ...] = ()
    n_late: int = 0
    store: int = -1
    level: int = 0
    open_s: OPEN | None = None

    def is_open_at(self, end_s: float) -> bool:
        """Whether it is open until a time."""
        return self.open_s is None or any(from_s < end_s <= to_s for from_s, to_s in self.open_s)

    def job_every_s(self, horizon_s: float) -> float | None:
        """Mean seconds from one job to the next, where it makes them by time or by order; else None."""
        if self.kind == SCHEDULE:
            n_jobs = sum(order.quantity for order in self.orders)
            return horizon_s / n_jobs if n_jobs else None
        return self.every_s / self.at_once if self.every_s else None

    def jobs_per_s(self, horizon_s: float) -> float | None:
        """Jobs a second that it makes by itself, on the mean of the run; None where the floor decides."""
        every_s = self.job_every_s(horizon_s)
        if every_s is None or self.open_s is None or self.kind == SCHEDULE:
            return None if every_s is None else 1 / every_s
        return sum(end_s - start_s for start_s, end_s in self.open_s) / horizon_s / every_s


def plan_sources(loaded: Any, ranks: Ranks, model_of: Callable) -> tuple[SourcePlan, ...]:
    """All sources in natural order of names; ``model_of(block)`` finds the model of their gaps."""
    scenario = loaded.scenario
    releases = dict(scenario.sources) if scenario.release is None else {RELEASE: scenario.release}
    total = sum(product.share for product in scenario.products.values())
    shares = {name: product.share / total for name, product in scenario.products.items()}
    return tuple(
        _source(name, releases[name], shares, loaded, ranks, model_of) for name in sorted(releases, key=natural_key)
    )


def _source(
    name: str, release: Any, shares: dict[str, float], loaded: Any, ranks: Ranks, model_of: Callable
) -> SourcePlan:
    gap = None if release.gap is None else model_of(release.gap)
    every_s = (release.every_s or 0.0) if gap is None else gap.mean_duration_s()
    sequence = _sequence(loaded, release, ranks.products)
    orders, n_late = plan_orders(loaded, release, ranks.products) if release.kind == SCHEDULE else ((), 0)
    if release.kind == BASE_STOCK and release.products is None:
        made = {_ending_in(loaded.scenario, release.store): 1.0}
    else:
        made = shares if release.products is None else release.products
    mix = tuple((rank, made[product]) for product, rank in ranks.products.items() if product in made)
    return SourcePlan(
        name,
        release.kind,
        every_s,
        release.when_full,
        _seen(sequence or _ordered(orders)) or mix,
        gap,
        release.at_once,
        sequence,
        orders,
        n_late,
        -1 if release.store is None else ranks.stations[release.store],
        release.level or 0,
        open_times(release.shift, loaded.scenario),
    )


def _sequence(loaded: Any, release: Any, products: dict[str, int]) -> tuple[int, ...]:
    from opsim.csv_input import read_sequence, resolve_times

    names = release.sequence or ()
    if isinstance(names, str):
        names, _ = read_sequence(resolve_times(names, loaded.folder), products)
    return tuple(products[name] for name in names)


def _ordered(orders: tuple[OrderPlan, ...]) -> tuple[int, ...]:
    """The product of each job of a schedule; none where the file leaves it to the mix."""
    ranks = tuple(order.product for order in orders for _ in range(order.quantity))
    return () if ANY in ranks else ranks


def _seen(ranks: tuple[int, ...]) -> Mix:
    """The shares of products in a list of their ranks."""
    counts = Counter(ranks)
    return tuple((rank, counts[rank] / len(ranks)) for rank in sorted(counts))


def _ending_in(scenario: Scenario, store: str) -> str:
    """The product that goes into a store."""
    for name, product in scenario.products.items():
        steps = [*(product.route or ()), *(product.routing or ())]
        onward = [other for ways in (product.routing or {}).values() for other in ways]
        if any(store == step or (isinstance(step, list) and store in step) for step in [*steps, *onward]):
            return name
    raise KeyError(store)
