"""Products and their routes."""

from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from opsim.names import natural_key


@dataclass(frozen=True, slots=True)
class Operation:
    """What a product needs at one step: the tasks of a station, or of one of several parallel ones."""

    name: str
    stations: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ProductPlan:
    """share : of the mix, all shares sum to 1; route : its operations; start : the step that comes first

    onward : for each step, (cumulative probability, step that follows), -1 for the way out; one entry where it is sure
    """

    name: str
    share: float
    route: tuple[Operation, ...]
    start: int
    onward: tuple[tuple[tuple[float, int], ...], ...]

    def visits(self) -> list[float]:
        """How often a job comes to each step on average: the traffic equations v = start + v P (Jackson 1957)."""
        n = len(self.route)
        passing = np.zeros((n, n))
        for step, onward in enumerate(self.onward):
            before = 0.0
            for cumulative, then in onward:
                if then >= 0:
                    passing[step, then] += cumulative - before
                before = cumulative
        return np.linalg.solve(np.eye(n) - passing.T, np.eye(n)[self.start]).tolist()


def plan_products(scenario, stations: dict[str, int]) -> tuple[ProductPlan, ...]:
    """Products in natural order; ``stations`` maps names to ranks."""
    total = sum(product.share for product in scenario.products.values())
    return tuple(
        _product(name, product, product.share / total, stations)
        for name, product in sorted(scenario.products.items(), key=lambda item: natural_key(item[0]))
    )


def _product(name: str, product, share: float, stations: dict[str, int]) -> ProductPlan:
    if getattr(product, "routing", None):
        return _network(name, product.routing, share, stations)
    route = tuple(_operation(step, stations) for step in product.route)
    steps = [*range(1, len(route)), -1]
    return ProductPlan(name, share, route, 0, tuple(((1.0, step),) for step in steps))


def _network(name: str, routing, share: float, stations: dict[str, int]) -> ProductPlan:
    """A route drawn step by step: ``{start: cut, cut: {drill: 0.9, out: 0.1}, drill: out}``."""
    names = sorted((key for key in routing if key != "start"), key=natural_key)
    step_of = {**{key: step for step, key in enumerate(names)}, "out": -1}
    start = routing["start"]
    onward = tuple(_cumulative(routing[key], step_of) for key in names)
    return ProductPlan(name, share, tuple(_operation(key, stations) for key in names), step_of[_only(start)], onward)


def _cumulative(ways, step_of: dict[str, int]) -> tuple[tuple[float, int], ...]:
    if isinstance(ways, str):
        return ((1.0, step_of[ways]),)
    chosen = sorted(((way, p) for way, p in ways.items() if p > 0), key=lambda item: natural_key(item[0]))
    total = sum(p for _, p in chosen)
    sums = list(accumulate(p / total for _, p in chosen))
    sums[-1] = 1.0  # a sum may be 1 - 1e-16, and a draw may land above it
    return tuple((point, step_of[way]) for point, (way, _) in zip(sums, chosen))


def _only(start) -> str:
    return start if isinstance(start, str) else next(iter(start))


def _operation(step, stations: dict[str, int]) -> Operation:
    names = [step] if isinstance(step, str) else sorted(step, key=natural_key)
    return Operation("|".join(names), tuple(stations[name] for name in names))
