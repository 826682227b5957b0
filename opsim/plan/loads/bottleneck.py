"""What limits the floor, by mean times: the resource that the most is wanted of.

What cannot be done in the time there is: said by ``opsim check`` as a warning.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf

from opsim.plan.loads.flows import Flows, flows_of, visits_of
from opsim.plan.loads.people import Crew, SkillLoad, crew_load, skill_loads
from opsim.plan.loads.utilisation import REPAIR_TEAM, SharedLoad, StationLoad, shared_loads, station_loads
from opsim.plan.loads.work_times import WorkTimes
from opsim.plan.plan import Plan
from opsim.subjects.shifts.hours import floor_has_hours, scheduled
from opsim.subjects.shifts.plan import total_s


@dataclass(frozen=True, slots=True)
class Bottleneck:
    """what : its name in words; load : share of it that is wanted, None where the floor decides what comes in;
    most_per_h : jobs of the sources an hour of the run that it lets through, if nothing else limits;
    most_per_scheduled_h : the same an hour for which the floor is scheduled to be open, None where it keeps no hours.
    """

    what: str
    load: float | None
    most_per_h: float
    most_per_scheduled_h: float | None = None


def bottleneck(plan: Plan) -> list[Bottleneck]:
    """Everything that limits the floor, what limits it most first; figures are estimates: nothing waits."""
    return list(loads_of(plan).limits)


@dataclass(frozen=True, slots=True)
class Loads:
    """Everything that was found of a Plan; crew is None where nobody is needed.

    scheduled_share : share of the run for which the floor is scheduled to be open, None where it keeps no hours
    """

    flows: Flows
    stations: tuple[StationLoad, ...]
    skills: tuple[SkillLoad, ...]
    crew: Crew | None
    shared: tuple[SharedLoad, ...]
    scheduled_share: float | None = None

    @property
    def limits(self) -> tuple[Bottleneck, ...]:
        """What limits the floor, most first."""
        per_h = None if self.flows.saturated else self.flows.per_h
        found = [
            self._limit(load.station, load.load, load.most_per_h / load.visits)
            for load in self.stations
            if load.visits > 0 and load.most_per_h < inf
        ]
        shared = (one for one in self.shared if one.what != REPAIR_TEAM)
        wanted = [(f"{one.what} {one.name}", one.wanted / one.n) for one in shared]
        if self.crew is not None:
            wanted.append((_people(self.crew.workers), self.crew.share))
        found += [
            self._limit(what, None if per_h is None else share, (1.0 if per_h is None else per_h) / share)
            for what, share in wanted
            if share > 0
        ]
        return tuple(sorted(found, key=lambda one: (one.most_per_h, one.what)))

    def _limit(self, what: str, load: float | None, most_per_h: float) -> Bottleneck:
        return Bottleneck(what, load, most_per_h, most_per_h / self.scheduled_share if self.scheduled_share else None)


def loads_of(plan: Plan) -> Loads:
    """All loads of a Plan."""
    flows, times = flows_of(plan), WorkTimes(plan)
    stations, skills = station_loads(plan, flows, times), skill_loads(plan, flows, times)
    shared = shared_loads(plan, flows, stations, times)
    share = total_s(scheduled(plan, times.hours)) / plan.horizon_s if floor_has_hours(plan) else None
    return Loads(flows, tuple(stations), tuple(skills), crew_load(plan, flows, times), tuple(shared), share)


def _people(workers: tuple[str, ...]) -> str:
    names = [*workers[:3], f"{len(workers) - 3} more"] if len(workers) > 4 else list(workers)
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]} together"


def overloads(plan: Plan, loads: Loads | None = None) -> list[str]:
    """Every warning in a sentence."""
    loads = loads_of(plan) if loads is None else loads
    return [*_stations(loads), *_people_overloaded(loads), *_shared(loads), *_too_long(plan)]


def _stations(loads: Loads) -> Iterator[str]:
    for load in loads.stations:
        if load.hours == 0:
            continue  # told by ``opsim.plan.warnings``
        if load.most_per_h == 0:
            yield f"{load.station} never works: its maintenance takes all of its time"
        elif load.load is not None and load.load >= 1:
            there = "" if load.hours == 1 else f" (it is there for {load.hours:.0%} of the run)"
            yield f"{load.station} cannot keep up: it would need {load.load:.0%} of its time{there}{_overtime(load)}"


def _people_overloaded(loads: Loads) -> Iterator[str]:
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
            f"{who} cannot keep up: {'it takes' if alone else 'shared as evenly as can be, it takes'} {crew.share:.0%} "
            f"of {'the' if alone else 'their'} time, walks not counted ({', '.join(crew.skills[:6])})"
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
    times = WorkTimes(plan)
    for rank, product in enumerate(plan.products):
        steps = zip(product.route, visits_of(plan, rank))
        alone_s = sum(n * _least_s(times, step.stations, rank) for step, n in steps)
        if alone_s >= plan.horizon_s:
            yield f"no {product.name} is finished: its work takes {alone_s:.0f} s, the run {plan.horizon_s:g} s"
        elif inf > product.due_s < alone_s:
            yield f"{product.name} is late: due after {product.due_s:g} s, and its work alone takes {alone_s:.0f} s"


def _least_s(times: WorkTimes, stations: tuple[int, ...], product: int) -> float:
    """The shortest mean work at one of the stations of a step; rides on conveyors count."""
    rides = {belt.station: belt.travel_s for belt in times.plan.conveyors}
    return min(rides.get(station, times.least_visit_s(station, product)) for station in stations)
