"""How jobs come in: one source or several."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from opsim.names import natural_key
from opsim.plan.calendar import OPEN, open_times
from opsim.plan.orders import ANY, OrderPlan, plan_orders
from opsim.plan.ranks import Ranks
from opsim.task import TaskModel

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
    from opsim.orders import read_sequence
    from opsim.recorded import resolve_times

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


def _ending_in(scenario: Any, store: str) -> str:
    """The product that goes into a store."""
    for name, product in scenario.products.items():
        steps = [*(product.route or ()), *(product.routing or ())]
        onward = [other for ways in (product.routing or {}).values() for other in ways]
        if any(store == step or (isinstance(step, list) and store in step) for step in [*steps, *onward]):
            return name
    raise KeyError(store)
