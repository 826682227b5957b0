"""What limits the floor, by mean times: the resource that the most is wanted of."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from opsim.plan.hours import Hours
from opsim.plan.hours.scheduled import floor_has_hours, scheduled
from opsim.plan.hours.spans import total_s
from opsim.plan.loads.people import Crew, SkillLoad, crew_load, skill_loads
from opsim.plan.loads.rates import Flows, flows_of
from opsim.plan.loads.shared import REPAIR_TEAM, SharedLoad, shared_loads
from opsim.plan.loads.stations import StationLoad, station_loads
from opsim.plan.plan import Plan


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
    flows, hours = flows_of(plan), Hours(plan)
    stations, skills = station_loads(plan, flows, hours), skill_loads(plan, flows, hours)
    shared = shared_loads(plan, flows, stations)
    share = total_s(scheduled(plan, hours)) / plan.horizon_s if floor_has_hours(plan) else None
    return Loads(flows, tuple(stations), tuple(skills), crew_load(plan, flows, hours), tuple(shared), share)


def _people(workers: tuple[str, ...]) -> str:
    names = [*workers[:3], f"{len(workers) - 3} more"] if len(workers) > 4 else list(workers)
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]} together"
