"""Times without a body: fixed, from a distribution, or recorded; and switches of variability around any task model.

Each satisfies the seam of ``opsim.task_model``.
"""

from opsim.subjects.tasks.distributions import (
    Beta,
    Empirical,
    Erlang,
    Exponential,
    Fixed,
    Gamma,
    Geometric,
    Hyperexponential,
    Lognormal,
    Normal,
    Recorded,
    Triangular,
    Uniform,
    Weibull,
)
from opsim.subjects.tasks.from_scenario import task_model, time_model
from opsim.subjects.tasks.model import SMALLEST_S, TimePerformances
from opsim.subjects.tasks.variability import switched

__all__ = [
    "SMALLEST_S",
    "Beta",
    "Empirical",
    "Erlang",
    "Exponential",
    "Fixed",
    "Gamma",
    "Geometric",
    "Hyperexponential",
    "Lognormal",
    "Normal",
    "Recorded",
    "TimePerformances",
    "Triangular",
    "Uniform",
    "Weibull",
    "switched",
    "task_model",
    "time_model",
]
