"""The Plan: one frozen thing that says everything an engine has to know.

A Plan as far as its run has come.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from opsim.engine.rules import LEAST_EXPOSED
from opsim.ergonomics.options import USUAL, Options
from opsim.plan.subjects import SubjectPlan
from opsim.problems import natural_key
from opsim.subjects.breakdowns.plan import BreakdownPlan, MaintenancePlan, RepairTeamPlan
from opsim.subjects.human.plan import NO_EFFECTS, HumanPlan
from opsim.subjects.lines.plan import CrewPlan, LinePlan, SharePlan
from opsim.subjects.material.plan import CardPlan, KitPlan, SplitPlan, StorePlan
from opsim.subjects.people.plan import RotationPlan, WalkingPlan, WorkerPlan
from opsim.subjects.quality.plan import QualityPlan
from opsim.subjects.release.plan import SourcePlan
from opsim.subjects.routes.plan import ProductPlan
from opsim.subjects.sequencing.plan import SHORTEST_QUEUE, QueuePlan, SetupPlan, WorkAhead
from opsim.subjects.shifts.plan import OPEN, Duty, ShiftPlan
from opsim.subjects.stations.plan import BatchPlan, StationPlan
from opsim.subjects.tasks.plan import TaskPlan
from opsim.subjects.tools.plan import ToolPlan
from opsim.subjects.transport.plan import ConveyorPlan, TransporterPlan

FIXED_WORKFORCE = 0
"""The number of the people who work in every replication, where staffing is fixed."""


@dataclass(frozen=True, slots=True)
class Plan:
    """A scenario as numbers. Every tuple is in natural order of names; an index is a natural rank.

    distance_m : (P, P) metres between places
    rule, when_blocked, idle : named rules of allocation
    staffing : ``fixed`` (the same people in every replication) or ``redrawn``
    across_tasks : how a worker's effects in different tasks go together, one of ``opsim.worker_effects.ACROSS_TASKS``
    walking : whose postures walks have; None where walking is time alone
    quality : of the stations where something goes wrong, or is looked at; tools : what stations and tasks share
    queues : those that are not simply first come, first served; routing : the rule by which one of several stations is
             taken; ahead : mean times that their rules look at, where some do
    priorities : what comes before the rule of allocation, in this order: ``stations``, ``products``
    serve : what somebody who patrols does at a station: ``exhaustive`` or ``one``
    ergonomics : how postures are scored; human : what becomes of people as they work; posture : whether anybody looks
                 at postures at all
    start_s : when on the clock the run begins, seconds after Monday 00:00
    subjects : of those that somebody else has installed
    workforce : the number that keys who the workers are, whatever ``staffing`` says: the outer index of a nested study
    """

    name: str
    seed: int
    horizon_s: float
    warm_up_s: float
    places: tuple[str, ...]
    distance_m: tuple[tuple[float, ...], ...]
    tasks: tuple[TaskPlan, ...]
    stations: tuple[StationPlan, ...]
    products: tuple[ProductPlan, ...]
    sources: tuple[SourcePlan, ...]
    workers: tuple[WorkerPlan, ...]
    rule: str
    when_blocked: str
    idle: str
    staffing: str
    across_tasks: str
    walking: WalkingPlan | None = None
    cards: tuple[CardPlan, ...] = ()
    stores: tuple[StorePlan, ...] = ()
    kits: tuple[KitPlan, ...] = ()
    splits: tuple[SplitPlan, ...] = ()
    batches: tuple[BatchPlan, ...] = ()
    quality: tuple[QualityPlan, ...] = ()
    tools: tuple[ToolPlan, ...] = ()
    queues: tuple[QueuePlan, ...] = ()
    routing: str = SHORTEST_QUEUE
    setups: tuple[SetupPlan, ...] = ()
    ahead: WorkAhead | None = None
    breakdowns: tuple[BreakdownPlan, ...] = ()
    maintenance: tuple[MaintenancePlan, ...] = ()
    repair_teams: tuple[RepairTeamPlan, ...] = ()
    conveyors: tuple[ConveyorPlan, ...] = ()
    transporters: tuple[TransporterPlan, ...] = ()
    shifts: tuple[ShiftPlan, ...] = ()
    crews: tuple[CrewPlan, ...] = ()
    lines: tuple[LinePlan, ...] = ()
    rotations: tuple[RotationPlan, ...] = ()
    shares: tuple[SharePlan, ...] = ()
    priorities: tuple[str, ...] = ()
    serve: str = "exhaustive"
    ergonomics: Options = USUAL
    human: HumanPlan = NO_EFFECTS
    posture: bool = True
    start_s: float = 0.0
    workforce: int | None = None
    subjects: tuple[SubjectPlan, ...] = ()

    @property
    def stops(self) -> tuple[BreakdownPlan | MaintenancePlan, ...]:
        """What stops stations: breakdowns, then maintenance; each in natural order of "station: stop"."""
        return (*self.breakdowns, *self.maintenance)

    @property
    def more_setups(self) -> list[tuple[int, int]]:
        """(station, task) of what takes servers as set-ups do, for subjects that somebody else has installed."""
        return [pair for subject in self.subjects for pair in subject.setups]

    @property
    def release(self) -> SourcePlan:
        """The first source; the only one, where a scenario says ``release``."""
        return self.sources[0]

    @property
    def window_s(self) -> tuple[float, float]:
        """What the figures count: from the end of the warm-up to the horizon."""
        return self.warm_up_s, self.horizon_s

    def workforce_of(self, replication: int) -> int:
        """The number that keys who the workers of a replication are: the same in all where staffing is fixed."""
        if self.workforce is not None:
            return self.workforce
        return replication if self.staffing == "redrawn" else FIXED_WORKFORCE

    def worker_effect(self, worker: int, task: TaskPlan, replication: int = 0, workforce: int | None = None) -> Any:
        """A worker's own effect in a task: see ``opsim.worker_effects``; of this workforce, or a replication's."""
        from opsim.worker_effects import worker_effect

        who = self.workers[worker]
        workforce = self.workforce_of(replication) if workforce is None else workforce
        return worker_effect(task.model, task.stream_name, who.name, self.seed, workforce, who.body, self.across_tasks)

    def _repr_html_(self) -> str:
        from opsim.notebook import plan_html

        return plan_html(self)

    @property
    def evens_out(self) -> bool:
        """Whether any rule asks who is the least exposed: then the floor counts what each body has gone through."""
        return LEAST_EXPOSED in (self.rule, *(rotation.rule for rotation in self.rotations))

    @property
    def operations(self) -> tuple[str, ...]:
        """Names of all operations, in natural order."""
        names = {operation.name for product in self.products for operation in product.route}
        return tuple(sorted(names, key=natural_key))


def until(plan: Plan, end_s: float) -> Plan:
    """The Plan with its horizon at an earlier time, in seconds from its start; no warm-up where that is not over."""
    if end_s >= plan.horizon_s:
        return plan
    return replace(
        plan,
        horizon_s=end_s,
        warm_up_s=plan.warm_up_s if plan.warm_up_s < end_s else 0.0,
        stations=tuple(replace(one, open_s=_open_until(one.open_s, end_s)) for one in plan.stations),
        sources=tuple(
            replace(
                one,
                open_s=_open_until(one.open_s, end_s),
                orders=tuple(order for order in one.orders if order.time_s <= end_s),
            )
            for one in plan.sources
        ),
        workers=tuple(replace(one, duties=_duties_until(one.duties, end_s)) for one in plan.workers),
    )


def _open_until(open_s: OPEN | None, end_s: float) -> OPEN | None:
    if open_s is None:
        return None
    return tuple((from_s, min(to_s, end_s)) for from_s, to_s in open_s if from_s < end_s)


def _duties_until(duties: tuple[Duty, ...] | None, end_s: float) -> tuple[Duty, ...] | None:
    return None if duties is None else tuple(_cut(one, end_s) for one in duties if one.start_s < end_s)


def _cut(duty: Duty, end_s: float) -> Duty:
    pauses = tuple(replace(one, end_s=min(one.end_s, end_s)) for one in duty.pauses if one.start_s < end_s)
    cut = duty.cut or duty.end_s > end_s
    return replace(duty, end_s=min(duty.end_s, end_s), pauses=pauses, cut=cut)
