"""Times without a body: fixed, from a distribution, or recorded; and switches of variability around any task model.

Each satisfies the seam of ``opsim.task``.
"""

from opsim.tasks.bounded import Beta, Normal
from opsim.tasks.model import SMALLEST_S, TimePerformances
from opsim.tasks.of_scenario import task_model, time_model
from opsim.tasks.seen import Empirical, Recorded
from opsim.tasks.shared import Gamma, Hyperexponential, Lognormal, Weibull
from opsim.tasks.simple import Erlang, Exponential, Fixed, Geometric, Triangular, Uniform
from opsim.tasks.switched import switched

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
