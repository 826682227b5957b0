"""What operations leave wrong, what inspections find, and where jobs go from them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING

from opsim.plan.ranks import Ranks
from opsim.subjects.routes.plan import Operation, ProductPlan

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario


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
