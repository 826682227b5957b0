"""What a scenario may say: one frozen model a block. The YAML key is the alias; the attribute carries the SI unit."""

from opsim.scenario.schema.distributions import (
    Beta,
    Empirical,
    Erlang,
    Exponential,
    Gamma,
    Geometric,
    Hyperexponential,
    Lognormal,
    Normal,
    Triangular,
    Uniform,
    Weibull,
)
from opsim.scenario.schema.layout import Layout, Path, Place
from opsim.scenario.schema.lines import Crew, Flow, Setup
from opsim.scenario.schema.run import Run, Shift
from opsim.scenario.schema.scenario import BLOCKS, Scenario
from opsim.scenario.schema.sources import Card, Release
from opsim.scenario.schema.stations import Batch, Product, Station, Store
from opsim.scenario.schema.task_block import Emulated, Fixed, Plugged, Recorded, TaskBlock
from opsim.scenario.schema.tasks import (
    DISTRIBUTIONS,
    KIND_KEYS,
    TASK_KINDS,
    Breakdown,
    GeometricCycles,
    Maintenance,
    Motions,
    RepairTeam,
    Step,
    Task,
    UniformCycles,
    Walking,
)
from opsim.scenario.schema.workers import Allocation, Worker, Workforce
from opsim.scenario.tree import Block

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
    "Place",
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
