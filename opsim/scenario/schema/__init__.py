"""What a scenario may say: one frozen model a block. The YAML key is the alias; the attribute carries the SI unit."""

from opsim.scenario.schema.base import Block
from opsim.scenario.schema.bounded import Beta, Empirical, Normal, Triangular, Uniform
from opsim.scenario.schema.distributions import Erlang, Exponential, Gamma, Hyperexponential, Lognormal, Weibull
from opsim.scenario.schema.layout import Layout, Path
from opsim.scenario.schema.material import Product, Station
from opsim.scenario.schema.motions import Motions, Step
from opsim.scenario.schema.release import Release
from opsim.scenario.schema.run import Run
from opsim.scenario.schema.scenario import BLOCKS, Scenario
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
    "Beta",
    "Block",
    "Empirical",
    "Emulated",
    "Erlang",
    "Exponential",
    "Fixed",
    "Gamma",
    "Hyperexponential",
    "Layout",
    "Lognormal",
    "Motions",
    "Normal",
    "Path",
    "Plugged",
    "Product",
    "Recorded",
    "Release",
    "Run",
    "Scenario",
    "Station",
    "Step",
    "Task",
    "TaskBlock",
    "Triangular",
    "Uniform",
    "Walking",
    "Weibull",
    "Worker",
    "Workforce",
]
