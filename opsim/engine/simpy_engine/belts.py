"""What is on the conveyors: who rides where, and when there is room for one more. Data of a run, and its arithmetic.

Positions on a belt are counted in seconds of travel: a job gets on at 0 and is at the end at ``plan.travel_s``.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf

import simpy

from opsim.engine.simpy_engine.state import Job, Station
from opsim.plan.conveyors import ConveyorPlan


@dataclass(slots=True, eq=False)
class Belt:
    """A conveyor. jobs : on it, the first one nearest the end; waiting : brought to it, and not on it yet

    last_on_s, last_off_s : when a job last got on, and off; opens : the report that is to come of room for one more
    get_on : what happens when a job gets on
    """

    plan: ConveyorPlan
    station: Station
    jobs: deque[Job] = field(default_factory=deque)
    waiting: deque[Job] = field(default_factory=deque)
    last_on_s: float = -inf
    last_off_s: float = -inf
    opens: simpy.Event | None = None
    get_on: Callable[..., None] = lambda *_: None

    @property
    def moves(self) -> bool:
        """Whether its room for the next job comes with time."""
        return True

    def until_open_s(self, now: float) -> float:
        """How long it has to move until the next job may get on; inf where it is full.

        The last job is then a pitch from the beginning: it went freely, or closed up after somebody got off. Who
        stands behind others stands at least a pitch inside, unless the belt is full.
        """
        n, plan = len(self.jobs), self.plan
        if n >= plan.capacity:
            return inf
        opens_s = max(self.last_on_s + plan.headway_s, self.last_off_s + (n + 1) * plan.headway_s - plan.travel_s)
        return opens_s - now


@dataclass(slots=True, eq=False)
class RigidBelt(Belt):
    """A conveyor that stands still as a whole while the job at its end cannot get off.

    moved_s : how long it moved until ``since_s``; on_at_s : by job number, how long it had moved when the job got on
    first_ends : the report that is to come of the first job at the end; stands, halted : whether it does, and whether
    the rows of its jobs say so
    """

    moved_s: float = 0.0
    since_s: float = 0.0
    on_at_s: dict[int, float] = field(default_factory=dict)
    stands: bool = False
    halted: bool = False

    @property
    def moves(self) -> bool:
        return not self.stands

    def until_open_s(self, now: float) -> float:
        if len(self.jobs) >= self.plan.capacity:
            return inf
        return self.rest_s(self.jobs[-1], self.plan.headway_s, now) if self.jobs else 0.0

    def moved_at_s(self, now: float) -> float:
        """How long it has moved."""
        return self.moved_s if self.stands else self.moved_s + (now - self.since_s)

    def rest_s(self, job: Job, way_s: float, now: float) -> float:
        """For how long it has to move until a job is so far from the beginning."""
        return way_s - (self.moved_at_s(now) - self.on_at_s[job.number])
