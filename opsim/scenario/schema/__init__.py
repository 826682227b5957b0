"""What a scenario may say: one frozen model a block. The YAML key is the alias; the attribute carries the SI unit."""

from opsim.scenario.schema.run import Run
from opsim.scenario.schema.scenario import BLOCKS, Scenario
from opsim.scenario.tree import Block
from opsim.subjects.breakdowns.words import Breakdown, GeometricCycles, Maintenance, RepairTeam, UniformCycles
from opsim.subjects.lines.words import Crew
from opsim.subjects.material.words import Card, Store
from opsim.subjects.people.words import Allocation, Worker, Workforce
from opsim.subjects.release.words import Release
from opsim.subjects.routes.words import Product
from opsim.subjects.sequencing.words import Flow, Setup
from opsim.subjects.shifts.words import Shift
from opsim.subjects.stations.words import Batch, Station
from opsim.subjects.tasks.distribution_words import (
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
from opsim.subjects.tasks.kinds import DISTRIBUTIONS, KIND_KEYS, TASK_KINDS, Motions, Step, Task, Walking
from opsim.subjects.tasks.words import Emulated, Fixed, Plugged, Recorded, TaskBlock
from opsim.subjects.transport.words import Layout, Path, Place

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
