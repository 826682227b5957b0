"""The seam between a station model and whatever knows how long work takes.

Anything that satisfies these Protocols is an emulator: ``emulator.MotionEmulator``, ``opsim.tasks``, or your own.
Letters: ``n`` performances, ``E`` marks, ``K`` coefficients, ``T`` times, ``B`` bones, ``J`` joints.

How the spread of a task's times splits between workers and within each.

A task has mean m and cv c over the population. A worker's own factor F is lognormal with mean 1 and log variance
``share * ln(1 + c^2)``; his times are F times a time of the task's family with mean m and the cv given here.
Then mean and cv over the population are exactly m and c, since (1 + cv_F^2)(1 + cv_within^2) = 1 + c^2.
For the lognormal family ln(1 + c^2) is the variance of log time, so the share is the share of that variance.

What may be known of a worker's body: the names that reach ``draw_worker(rng, body)``, and what people can be.

What stands behind an emulator: recordings of people, or nobody at all.
"""

from __future__ import annotations

from math import expm1, log1p, sqrt
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    import numpy as np


class Performances(Protocol):
    """n performances of one task; postures are decoded only when asked for."""

    @property
    def duration_s(self) -> np.ndarray:
        """(n,) seconds, all positive."""

    @property
    def mark_s(self) -> np.ndarray:
        """(n, E) seconds from the start, increasing along E; E may be 0."""

    @property
    def scores(self) -> np.ndarray:
        """(n, K) coefficients of the draw; K is 0 where there is no body."""

    @property
    def skeleton(self) -> Any:
        """The skeleton the postures live on (``names``, ``parents``), or None where there is no body."""


class Bodies(Performances, Protocol):
    """Performances that have bodies: what a motion emulator gives beyond the times."""

    def directions(self, *args: Any, **kwargs: Any) -> np.ndarray:
        """(n, T, B, 3) unit vectors of the bones, at ``times_s`` (T,) or (n, T) or at ``n_times`` even points."""

    def positions_m(self, *args: Any, **kwargs: Any) -> np.ndarray:
        """(n, T, J, 3) joints in metres, z up, floor at 0."""

    def root_m(self, *args: Any, **kwargs: Any) -> np.ndarray:
        """(n, T, 3) path of the root in metres."""


class TaskModel(Protocol):
    """What a task costs in time, and how a body does it."""

    def mean_duration_s(self, worker: Any = None) -> float:
        """Mean duration over the population, or that of a worker with the given effect."""

    def draw_worker(self, rng: np.random.Generator, body: Any = None) -> Any:
        """A worker's own effect, to be passed back as ``worker=``; None where workers do not differ."""

    def sample(self, n: int, rng: np.random.Generator, *, worker: Any = None, condition: Any = None) -> Performances:
        """n performances in one draw, every array in one fixed order."""


def log_variance(cv: float) -> float:
    """Variance of the log of a lognormal time with this cv."""
    return log1p(cv * cv)


def within_cv(cv: float, between_share: float) -> float:
    """cv of a single worker's times where ``between_share`` of ``log_variance(cv)`` lies between workers."""
    if between_share == 0:
        return cv
    return sqrt(expm1((1 - between_share) * log_variance(cv)))


BODY_RANGES: dict[str, tuple[float, float]] = {
    "height_m": (0.9, 2.4),
    "mass_kg": (25.0, 300.0),
    "age_years": (5.0, 110.0),
    "pace": (0.3, 3.0),
}
"""Smallest and largest; beyond them is a slip of the pen or of the unit. The emulator's own; a test compares them."""
BODY_KEYS = ("height_m", "mass_kg", "age_years", "sex", "pace", "person")
"""pace: 1.1 is a tenth faster than the typical person in emulated tasks; person: the name of a recorded one."""


def seconds_of(model: Any, duration_s: Any) -> np.ndarray:
    """(n,) what a model drew. Raises ValueError for a time that is negative or no number: the floor would run on it."""
    import numpy as np

    seconds = np.asarray(duration_s, dtype=float)
    good = (seconds >= 0) & (seconds < np.inf)
    if not good.all():
        found = seconds[~good][0]
        raise ValueError(f"{type(model).__name__} drew a time of {found:g} s, expected a number of seconds from 0 on")
    return seconds


def keys_read(model: Any) -> tuple[str, ...]:
    """What a task model reads of a body: its ``body_keys``; of a model that does not say, anything may be read."""
    return tuple(getattr(model, "body_keys", BODY_KEYS))


def takes_shift(model: Any) -> bool:
    """Whether a model's ``conditions`` name ``log_duration_shift``: its postures can follow a change of pace."""
    return "log_duration_shift" in getattr(model, "conditions", ())


def fit_report(model: Any) -> Any:
    """What an emulator tells of its training, beyond the seam: source, licence, n_sequences, n_workers."""
    return model.report


def is_made_up(source: str) -> bool:
    """Whether a library's source says that nobody was recorded."""
    return source.lower().startswith(("synthetic", "emulated"))


def behind(source: str, n_sequences: int, n_workers: int) -> str:
    """In words, e.g. ``41 recordings of 6 people``."""
    if is_made_up(source):
        return f"{n_sequences} made repetitions of {n_workers} made-up people: nobody was recorded"
    return f"{n_sequences} recordings of {n_workers} people"
