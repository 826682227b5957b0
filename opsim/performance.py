"""Performance: one execution of a task by a worker, whole or a piece of it, with the body it was drawn with."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from opsim.clock import TICKS_PER_S


class OfBlock:
    """Row ``row`` of a block of performances (``opsim.task_model.Performances``), at skill rating 1."""

    __slots__ = ()
    block: Any
    row: int

    @property
    def duration_s(self) -> float:
        return float(self.block.duration_s[self.row])

    @property
    def mark_s(self) -> np.ndarray:
        """(E,) seconds from the start."""
        return np.asarray(self.block.mark_s)[self.row]

    def decoded(self, what: str, **times: Any) -> np.ndarray:
        """``what`` (directions, positions_m, root_m) of this row alone: as in the whole block, to 1e-10."""
        from threadpoolctl import threadpool_limits

        block, row = self.block, self.row
        alone = hasattr(type(block), "__getitem__")
        with threadpool_limits(limits=1, user_api="blas"):
            some = block[row] if alone else block
            return getattr(some, what)(**times)[0 if alone else row]


@dataclass(frozen=True, slots=True)
class Drawn(OfBlock):
    """A row of a block that is there.

    luck : the ``OwnLuck`` of who was drawn for, by which others of his can be drawn; None where nobody said
    """

    block: Any
    row: int
    luck: Any = field(default=None, repr=False, compare=False)


@dataclass(frozen=True, slots=True)
class Performance:
    """One execution of a task, or the piece of it between two interruptions.

    k            : which of the worker's performances of this task, from 0; all pieces of a performance keep it
    start_s, end_s : of this piece, on the clock of the simulation
    duration_s   : of the whole performance at the worker's rating, a multiple of 2^-20 s
    mark_s       : (E,) the emulator's marked moments, seconds of work from the start of the whole performance
    progress_from, progress_to : shares of ``duration_s`` done at the start and at the end of this piece
    number       : performances of a log are numbered as they begin
    pace_shift   : by how much human effects shifted its log time; postures follow it
    """

    worker: str
    task: str
    k: int
    start_s: float
    end_s: float
    duration_s: float
    mark_s: tuple[float, ...]
    progress_from: float
    progress_to: float
    number: int
    drawn: Any = field(repr=False, compare=False)
    pace_shift: float = 0.0

    @property
    def finished(self) -> bool:
        """Whether the performance is done to its end, with this piece."""
        return self.progress_to == 1.0

    @property
    def left_s(self) -> float:
        """Seconds of work left after this piece, a multiple of 2^-20 s."""
        return (self._ticks - round(self.progress_to * self._ticks)) / TICKS_PER_S

    @property
    def skeleton(self) -> Any:
        """The skeleton of the postures (``names``, ``index``), or None for a time without a body."""
        return self.drawn.block.skeleton

    def directions(self, n_times: int = 101, times_s: np.ndarray | None = None) -> np.ndarray:
        """(T, B, 3) unit directions of the bones, without heading, at ``n_times`` even points of this piece.

        times_s : (T,) instead: seconds of work from the start of the whole performance
        Raises ValueError where the task is a time without a body.
        """
        return self._decoded("directions", n_times, times_s)

    def positions_m(self, n_times: int = 101, times_s: np.ndarray | None = None) -> np.ndarray:
        """(T, J, 3) joints in metres, z up, floor at 0; times and errors as ``directions``."""
        return self._decoded("positions_m", n_times, times_s)

    def root_m(self, n_times: int = 101, times_s: np.ndarray | None = None) -> np.ndarray:
        """(T, 3) path of the root in metres; times and errors as ``directions``."""
        return self._decoded("root_m", n_times, times_s)

    def until(self, now_s: float) -> Performance:
        """This piece, ended at an instant at or after its start; finished if nothing is left by then."""
        done = round(self.progress_from * self._ticks) + round((now_s - self.start_s) * TICKS_PER_S)
        return replace(self, end_s=now_s, progress_to=min(done, self._ticks) / self._ticks)

    def next_piece(self, now_s: float) -> Performance:
        """What is left after this piece, begun at an instant."""
        return replace(self, start_s=now_s, end_s=now_s, progress_from=self.progress_to)

    def _repr_html_(self) -> str:
        from opsim.notebook import performance_html

        return performance_html(self)

    @property
    def _ticks(self) -> int:
        return round(self.duration_s * TICKS_PER_S)

    def _decoded(self, what: str, n_times: int, times_s: np.ndarray | None) -> np.ndarray:
        if times_s is None and (self.progress_from, self.progress_to) == (0.0, 1.0):
            return self.drawn.decoded(what, n_times=n_times)
        if times_s is None:
            times_s = np.linspace(self.progress_from, self.progress_to, n_times) * self.duration_s
        return self.drawn.decoded(what, times_s=np.asarray(times_s) * (self.drawn.duration_s / self.duration_s))
