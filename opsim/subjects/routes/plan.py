"""Products and their routes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import accumulate
from math import inf
from typing import TYPE_CHECKING

from opsim.clock import on_grid
from opsim.problems import natural_key

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario


@dataclass(frozen=True, slots=True)
class Operation:
    """What a product needs at one step: the tasks of a station, or of one of several parallel ones.

    listed : the same stations in the order of the scenario's list; empty where there is one only
    """

    name: str
    stations: tuple[int, ...]
    listed: tuple[int, ...] = ()


Ways = tuple[tuple[float, int], ...]
"""(cumulative probability, step of the route) of each way on; -1 is the way out. One entry where it is sure."""
_FIRST: Ways = ((1.0, 0),)
_OUT: Ways = ((1.0, -1),)


@dataclass(frozen=True, slots=True)
class ProductPlan:
    """share : of the mix, all sum to 1; route : its operations; start, onward : the first step, and from each step

    carried : who did the last task at a station carries it to the next
    priority, due_s : jobs of a higher priority go first; from a job's arrival to its due date, inf where it has none
    lot : units in a job; mass_kg : of one unit, None where nobody asks
    """

    name: str
    share: float
    route: tuple[Operation, ...]
    start: Ways
    onward: tuple[Ways, ...]
    carried: bool = False
    priority: int = 0
    due_s: float = inf
    lot: int = 1
    mass_kg: float | None = None

    def visits(self) -> tuple[float, ...]:
        """How often a job comes to each step on average; in a route just once."""
        in_a_row = self.start == _FIRST and self.onward == _one_by_one(len(self.route))
        return (1.0,) * len(self.route) if in_a_row else _visits(self.start, self.onward)


def plan_products(scenario: Scenario, stations: dict[str, int]) -> tuple[ProductPlan, ...]:
    """Products in natural order; ``stations`` maps names to ranks."""
    total = sum(product.share for product in scenario.products.values())
    return tuple(
        replace(
            _product(name, product, product.share / total, stations),
            priority=product.priority,
            due_s=inf if product.due_s is None else on_grid(product.due_s),
            lot=product.lot,
            mass_kg=product.mass_kg,
        )
        for name, product in sorted(scenario.products.items(), key=lambda item: natural_key(item[0]))
    )


def _product(name: str, product, share: float, stations: dict[str, int]) -> ProductPlan:
    if product.routing is not None:
        return _network(name, product, share, stations)
    route = tuple(_operation(step, stations) for step in product.route)
    return ProductPlan(name, share, route, _FIRST, _one_by_one(len(route)), product.carried)


def _one_by_one(n: int) -> tuple[Ways, ...]:
    """From each of n steps to the next, from the last one out."""
    return tuple(((1.0, step),) for step in [*range(1, n), -1])


def _network(name: str, product, share: float, stations: dict[str, int]) -> ProductPlan:
    """A way drawn step by step: from ``start``, and from each station, to others or ``out``, with probabilities."""
    routing = product.routing
    ends = {way for ways in routing.values() for way in ways if way not in routing and way != "out"}  # stores
    names = sorted((*(key for key in routing if key != "start"), *ends), key=natural_key)
    step_of = {**{key: step for step, key in enumerate(names)}, "out": -1}
    onward = tuple(_OUT if key in ends else _ways(routing[key], step_of) for key in names)
    route = tuple(_operation(key, stations) for key in names)
    return ProductPlan(name, share, route, _ways(routing["start"], step_of), onward, product.carried)


def _ways(ways: dict[str, float], step_of: dict[str, int]) -> Ways:
    chosen = sorted(ways.items(), key=lambda item: natural_key(item[0]))
    sums = list(accumulate(p for _, p in chosen))
    sums[-1] = 1.0  # a sum may be 1 - 1e-16, and a draw may land above it
    return tuple((point, step_of[way]) for point, (way, _) in zip(sums, chosen))


@lru_cache(maxsize=8)
def _visits(start: Ways, onward: tuple[Ways, ...]) -> tuple[float, ...]:
    """The traffic equations v = start + P' v (Jackson 1957), solved once for the variants of a file."""
    import numpy as np

    n = len(onward)
    passing = np.array([_probabilities(ways, n) for ways in onward])
    return tuple(np.linalg.solve(np.eye(n) - passing.T, _probabilities(start, n)).tolist())


def onward_probabilities(product: ProductPlan) -> list[list[float]]:
    """(steps, steps) probability of going from each step of a product's route to each other."""
    return [_probabilities(ways, len(product.onward)) for ways in product.onward]


def _probabilities(ways: Ways, n: int) -> list[float]:
    row = [0.0] * n
    for (cumulative, step), before in zip(ways, (0.0, *(point for point, _ in ways))):
        if step >= 0:
            row[step] += cumulative - before
    return row


def _operation(step, stations: dict[str, int]) -> Operation:
    names = [step] if isinstance(step, str) else sorted(step, key=natural_key)
    listed = () if isinstance(step, str) else tuple(stations[name] for name in step)
    return Operation("|".join(names), tuple(stations[name] for name in names), listed)
