"""The Plan: one frozen thing that says everything an engine has to know."""

from dataclasses import dataclass

from opsim.ergonomics.options import USUAL, Options
from opsim.names import natural_key
from opsim.plan.assembly import BatchPlan, KitPlan
from opsim.plan.calendar import ShiftPlan
from opsim.plan.cards import CardPlan
from opsim.plan.conveyors import ConveyorPlan
from opsim.plan.crews import CrewPlan
from opsim.plan.failures import BreakdownPlan, MaintenancePlan, RepairTeamPlan
from opsim.plan.human import NO_EFFECTS, HumanPlan
from opsim.plan.lines import LinePlan
from opsim.plan.material import ProductPlan
from opsim.plan.quality import QualityPlan
from opsim.plan.release import SourcePlan
from opsim.plan.rotations import RotationPlan
from opsim.plan.sequence import SHORTEST_QUEUE, QueuePlan, WorkAhead
from opsim.plan.setup import SetupPlan
from opsim.plan.splits import SplitPlan
from opsim.plan.station import StationPlan
from opsim.plan.stores import StorePlan
from opsim.plan.tasks import TaskPlan
from opsim.plan.tools import ToolPlan
from opsim.plan.transporters import TransporterPlan
from opsim.plan.walking import WalkingPlan
from opsim.plan.work_sharing import SharePlan
from opsim.plan.worker import WorkerPlan

FIXED_WORKFORCE = 0
"""The number of the people who work in every replication, where staffing is fixed."""


@dataclass(frozen=True, slots=True)
class Plan:
    """A scenario as numbers. Every tuple is in natural order of names; an index is a natural rank.

    distance_m : (P, P) metres between places
    rule, when_blocked, idle : named rules of allocation
    staffing : ``fixed`` (the same people in every replication) or ``redrawn``
    across_tasks : how a worker's effects in different tasks go together, one of ``opsim.effects.ACROSS_TASKS``
    walking : whose postures walks have; None where walking is time alone
    quality : of the stations where something goes wrong, or is looked at; tools : what stations and tasks share
    queues : those that are not simply first come, first served; routing : the rule by which one of several stations is
             taken; ahead : mean times that their rules look at, where some do
    priorities : what comes before the rule of allocation, in this order: ``stations``, ``products``
    serve : what somebody who patrols does at a station: ``exhaustive`` or ``one``
    ergonomics : how postures are scored; human : what becomes of people as they work; posture : whether anybody looks
                 at postures at all
    start_s : when on the clock the run begins, seconds after Monday 00:00
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

    @property
    def stops(self) -> tuple[BreakdownPlan | MaintenancePlan, ...]:
        """What stops stations: breakdowns, then maintenance; each in natural order of "station: stop"."""
        return (*self.breakdowns, *self.maintenance)

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

    def _repr_html_(self) -> str:
        from opsim.shown.scenario import plan_html

        return plan_html(self)

    @property
    def operations(self) -> tuple[str, ...]:
        """Names of all operations, in natural order."""
        names = {operation.name for product in self.products for operation in product.route}
        return tuple(sorted(names, key=natural_key))
