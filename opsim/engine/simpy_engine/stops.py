"""Stops of stations and the teams that end them: who is waited for, since when, and what the log is told."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import nan
from typing import Any

from opsim.clock import on_grid
from opsim.engine.rules import REPAIR as REPAIR_REPORTED
from opsim.engine.rules import longest_down
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Station
from opsim.log import BREAKDOWN, DOWN, MAINTENANCE, REPAIR, pack_row
from opsim.plan import BreakdownPlan, MaintenancePlan

REPAIRED = "station repaired"


@dataclass(slots=True, eq=False)
class Team:
    """free : how many stops more it can see to now."""

    free: int
    waiting: list[Stop] = field(default_factory=list)

    def send(self, floor: Floor) -> bool:
        """It sees to the stops that wait, as many as it can; True where it went to one."""
        went = False
        while self.free and self.waiting:
            stop = min(self.waiting, key=lambda one: longest_down(one.since_s, one.station.rank, one.rank))
            self.waiting.remove(stop)
            self.free -= 1
            stop.begin_repair(floor)
            went = True
        return went


@dataclass(slots=True, eq=False)
class Stop:
    """One kind of breakdown or maintenance of a station.

    rank : among all stops; repairs : how long each of its repairs takes; n : how often it has come, less one
    failing : what is known of its station
    kind, since_s : DOWN or REPAIR, and since when, while the station stands because of it
    """

    plan: BreakdownPlan | MaintenancePlan
    rank: int
    station: Station
    team: Team | None
    repairs: Iterator[float]
    failing: Any = None
    n: int = -1
    kind: int = DOWN
    since_s: float = 0.0

    @property
    def job(self) -> str:
        """What becomes of the jobs that were in work."""
        return self.plan.job if isinstance(self.plan, BreakdownPlan) else "resume"

    @property
    def after_job(self) -> bool:
        """Whether what was begun is finished first."""
        return isinstance(self.plan, MaintenancePlan) and self.plan.after_job

    def begin(self, floor: Floor) -> None:
        """The station stands from now on: the team is called, or the repair begins."""
        self.n += 1
        self.kind, self.since_s = DOWN, floor.now
        if self.team is None:
            self.begin_repair(floor)
        else:
            self.team.waiting.append(self)

    def begin_repair(self, floor: Floor) -> None:
        """Somebody is there, or nobody is needed."""
        self.log(floor)
        self.kind, self.since_s = REPAIR, floor.now
        floor.alarm(on_grid(next(self.repairs)), REPAIR_REPORTED, self.station.rank, self.rank, REPAIRED, self)

    def end(self, floor: Floor) -> None:
        """The repair is done, and the team is free."""
        self.log(floor)
        if self.team is not None:
            self.team.free += 1

    def log(self, floor: Floor) -> None:
        """Write what the station waited for, or was given, until now."""
        if floor.now > self.since_s:
            cause = BREAKDOWN if isinstance(self.plan, BreakdownPlan) else MAINTENANCE
            floor.write(pack_row(
                self.kind, self.since_s, floor.now, -1, self.station.rank, -1, -1, -1, -1, -1, -1,
                self.plan.task, -1, self.n, nan, nan, nan, cause,
            ))  # fmt: skip
