"""Products and their routes.

Quality: what operations leave wrong, what inspections find, and where jobs go from them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import accumulate
from math import inf
from typing import TYPE_CHECKING

from opsim.clock import on_grid
from opsim.plan.tasks import Ranks
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


NOWHERE = -1


@dataclass(frozen=True, slots=True)
class QualityPlan:
    """Of one station. yield_share : share of operations that leave no defect; inspects : whether jobs are looked at

    by_worker : whether some of those who can work here leave defects of their own, always or as they tire
    finds, false_alarms : share of bad jobs, and of good ones, that are held to be bad
    back : by product and step, the step that such a job is sent back to; ``NOWHERE``: it is scrapped. () : always scrap
    most : so many reworks of a job from here, then scrap
    """

    station: int
    yield_share: float = 1.0
    inspects: bool = False
    finds: float = 1.0
    false_alarms: float = 0.0
    back: tuple[tuple[int, ...], ...] = ()
    most: float = inf
    by_worker: bool = False


def plan_quality(scenario: Scenario, ranks: Ranks, products: tuple[ProductPlan, ...]) -> tuple[QualityPlan, ...]:
    """Of the stations where anything can go wrong or is looked at, in natural order; products ``with_detours``."""
    by_hand = _by_worker(scenario)
    found = []
    for name, block in scenario.stations.items():
        one = _quality(block, ranks.stations[name], ranks, products)
        if name in by_hand:
            one = replace(one or QualityPlan(ranks.stations[name]), by_worker=True)
        found += [one] if one is not None else []
    return tuple(sorted(found, key=lambda one: one.station))


def _by_worker(scenario: Scenario) -> set[str]:
    """Stations where somebody leaves defects of his own, or whoever works there may, as he tires."""
    if scenario.human.errors is not None:
        manned = {name for name, task in scenario.tasks.items() if task.automatic is not True}
        return {name for name, station in scenario.stations.items() if not manned.isdisjoint(station.tasks)}
    skills = [(name, skill) for worker in scenario.workers.values() for name, skill in worker.skills.items()]
    return {name for name, skill in skills if getattr(skill, "quality", 1.0) < 1}


def with_detours(scenario: Scenario, ranks: Ranks, products: tuple[ProductPlan, ...]) -> tuple[ProductPlan, ...]:
    """The products, with a step more for each inspection whose rework is on no way of the product.

    It stands behind the last step of the route, no way leads to it but rework, and it leads back to the inspection.
    """
    reworks = [
        (ranks.stations[name], ranks.stations[block.inspect.rework], block.inspect.rework)
        for name, block in scenario.stations.items()
        if block.inspect is not None and block.inspect.rework is not None
    ]
    return tuple(_with_detours(product, sorted(reworks)) for product in products) if reworks else products


def _with_detours(product: ProductPlan, reworks: list[tuple[int, int, str]]) -> ProductPlan:
    known = {station for operation in product.route for station in operation.stations}
    for inspection, rework, name in reworks:
        for step, operation in enumerate(product.route):
            if inspection in operation.stations and rework not in known:
                route = (*product.route, Operation(name, (rework,)))
                product = replace(product, route=route, onward=(*product.onward, ((1.0, step),)))
    return product


def _quality(block, station: int, ranks: Ranks, products: tuple[ProductPlan, ...]) -> QualityPlan | None:
    if block.scrap_share:
        return QualityPlan(station, 1.0 - block.scrap_share, inspects=True)
    yield_share, inspect = block.yield_share or 1.0, block.inspect
    if inspect is None:
        return None if yield_share == 1.0 else QualityPlan(station, yield_share)
    back: tuple[tuple[int, ...], ...] = ()
    if inspect.rework is not None:
        rework = ranks.stations[inspect.rework]
        back = tuple(tuple(_back(product, station, rework)) for product in products)
    most = inf if inspect.most is None else inspect.most
    return QualityPlan(station, yield_share, True, inspect.finds, inspect.false_alarms, back, most)


def _back(product: ProductPlan, station: int, rework: int) -> Iterator[int]:
    """From each step, where a job goes for rework: the last step before with that station, this one, or a detour."""
    for step, operation in enumerate(product.route):
        steps = [at for at, other in enumerate(product.route) if rework in other.stations]
        before = [at for at in steps if at <= step and not _is_detour(product, at, step)]
        detours = [at for at in steps if _is_detour(product, at, step)]
        ahead = [at for at in steps if at > step]
        found = (detours or before[-1:] or ahead) if station in operation.stations else []
        yield found[0] if found else NOWHERE


def _is_detour(product: ProductPlan, at: int, step: int) -> bool:
    """Whether a step is reached by rework alone, and leads back to another one."""
    entered = {step for ways in (product.start, *product.onward) for _, step in ways}
    return at not in entered and product.onward[at] == ((1.0, step),)
