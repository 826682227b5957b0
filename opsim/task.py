"""The seam between a station model and whatever knows how long work takes.

Anything that satisfies these Protocols is an emulator: ``emulator.MotionEmulator``, ``opsim.tasks``, or your own.
Letters: ``n`` performances, ``E`` marks, ``K`` coefficients, ``T`` times, ``B`` bones, ``J`` joints.
"""

from __future__ import annotations

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
