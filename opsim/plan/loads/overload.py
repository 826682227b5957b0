"""What cannot be done in the time there is: said by ``opsim check`` as a warning."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from opsim.plan.loads.bottleneck import Loads, loads_of
from opsim.plan.loads.people import Crew, SkillLoad
from opsim.plan.loads.stations import StationLoad
from opsim.plan.loads.visits import visits_of
from opsim.plan.loads.work import visit_s
from opsim.plan.plan import Plan


def overloads(plan: Plan, loads: Loads | None = None) -> list[str]:
    """Every warning in a sentence."""
    loads = loads_of(plan) if loads is None else loads
    return [*_stations(loads), *_people(loads), *_shared(loads), *_too_long(plan)]


def _stations(loads: Loads) -> Iterator[str]:
    for load in loads.stations:
        if load.hours == 0:
            continue  # told by ``opsim.plan.risks``
        if load.most_per_h == 0:
            yield f"{load.station} never works: its maintenance takes all of its time"
        elif load.load is not None and load.load >= 1:
            which = "its time" if load.hours == 1 else f"its time, {load.hours:.0%} of the run,"
            yield f"{load.station} cannot keep up: {load.load:.0%} of {which} is wanted{_overtime(load)}"


def _people(loads: Loads) -> Iterator[str]:
    if loads.flows.saturated:
        return
    over = [load for load in loads.skills if load.load is not None and load.load >= 1 and load.there > 0]
    for load in over:
        who = "1 worker who can" if load.able == 1 else f"{load.able} workers who can"
        yield (
            f"work at {load.skill} cannot be done: {load.load:.0%} of the time of the {who}, walks not counted"
            f"{_there(load)}{_overtime(load)}"
        )
    crew = loads.crew
    if crew is not None and crew.share >= 1 and not over:
        alone = len(crew.workers) == 1
        who = crew.workers[0] if alone else f"the {len(crew.workers)} workers of {len(crew.skills)} stations"
        yield (
            f"{who} cannot keep up: {'' if alone else 'however they share the work, '}{crew.share:.0%} of "
            f"{'the' if alone else 'their'} time is wanted, walks not counted ({', '.join(crew.skills[:6])})"
            f"{_overtime(crew)}"
        )


def _there(load: SkillLoad) -> str:
    """How many are at work on average, where they have shifts, breaks or days off."""
    return f"; {load.there:.2g} of them are at work on the mean of the run" if load.there < load.able else ""


def _overtime(load: StationLoad | SkillLoad | Crew) -> str:
    """What all the overtime that is allowed would make of it."""
    return "" if load.with_overtime is None else f"; {load.with_overtime:.0%} with all the overtime that is allowed"


def _shared(loads: Loads) -> Iterator[str]:
    for load in loads.shared:
        if load.load is not None and load.load >= 1:
            yield f"{load.what} {load.name}: {load.load:.0%} of what there is is wanted ({load.wanted:.1f} of {load.n})"


def _too_long(plan: Plan) -> Iterator[str]:
    """Products whose work alone takes longer than the run, or than they have until they are due."""
    for rank, product in enumerate(plan.products):
        steps = zip(product.route, visits_of(plan, rank))
        alone_s = sum(n * _least_s(plan, step.stations, rank) for step, n in steps)
        if alone_s >= plan.horizon_s:
            yield f"no {product.name} is finished: its work takes {alone_s:.0f} s, the run {plan.horizon_s:g} s"
        elif inf > product.due_s < alone_s:
            yield f"{product.name} is late: due after {product.due_s:g} s, and its work alone takes {alone_s:.0f} s"


def _least_s(plan: Plan, stations: tuple[int, ...], product: int) -> float:
    """The shortest mean work at one of the stations of a step; rides on conveyors count."""
    rides = {belt.station: belt.travel_s for belt in plan.conveyors}
    return min(rides.get(station, visit_s(plan, station, product)) for station in stations)
