"""What a scenario may say: one frozen model a block. The YAML key is the alias; the attribute carries the SI unit."""

from opsim.scenario.schema.assembly import Batch, Store
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.bounded import Beta, Empirical, Normal, Triangular, Uniform
from opsim.scenario.schema.cards import Card
from opsim.scenario.schema.crews import Crew
from opsim.scenario.schema.cycles import GeometricCycles, UniformCycles
from opsim.scenario.schema.distributions import (
    Erlang,
    Exponential,
    Gamma,
    Geometric,
    Hyperexponential,
    Lognormal,
    Weibull,
)
from opsim.scenario.schema.failures import Breakdown, Maintenance, RepairTeam
from opsim.scenario.schema.layout import Layout, Path
from opsim.scenario.schema.material import Product, Station
from opsim.scenario.schema.motions import Motions, Step
from opsim.scenario.schema.release import Release
from opsim.scenario.schema.run import Run
from opsim.scenario.schema.scenario import BLOCKS, Scenario
from opsim.scenario.schema.sequence import Flow, Setup
from opsim.scenario.schema.shifts import Shift
from opsim.scenario.schema.task_kinds import DISTRIBUTIONS, KIND_KEYS, TASK_KINDS, Task
from opsim.scenario.schema.tasks import Emulated, Fixed, Plugged, Recorded, TaskBlock
from opsim.scenario.schema.walking import Walking
from opsim.scenario.schema.workers import Allocation, Worker, Workforce

__all__ = [
    "BLOCKS",
    "DISTRIBUTIONS",
    "KIND_KEYS",
    "TASK_KINDS",
    "Allocation",
    "Batch",
    "Beta",
    "Block",
    "Breakdown",
    "Card",
    "Crew",
    "Empirical",
    "Emulated",
    "Erlang",
    "Exponential",
    "Fixed",
    "Flow",
    "Gamma",
    "Geometric",
    "GeometricCycles",
    "Hyperexponential",
    "Layout",
    "Lognormal",
    "Maintenance",
    "Motions",
    "Normal",
    "Path",
    "Plugged",
    "Product",
    "Recorded",
    "Release",
    "RepairTeam",
    "Run",
    "Scenario",
    "Setup",
    "Shift",
    "Station",
    "Step",
    "Store",
    "Task",
    "TaskBlock",
    "Triangular",
    "Uniform",
    "UniformCycles",
    "Walking",
    "Weibull",
    "Worker",
    "Workforce",
]
