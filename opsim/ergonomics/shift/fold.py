"""One pass over what bodies did, for all who ask something of it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

from opsim.ergonomics.scores.scoring import Scores
from opsim.ergonomics.shift.day import days
from opsim.ergonomics.shift.scored import scored
from opsim.ergonomics.shift.stretch import Frames
from opsim.log import EventLog
from opsim.one_thread import one_blas_thread
from opsim.plan import Plan


class Fold(Protocol):
    """Whoever looks at every stretch once: worker after worker, each in the order of time."""

    def add(self, frames: Frames, scores: Scores) -> None:
        """The next stretch; it lies within an hour of the clock."""


def fold(log: EventLog, plan: Plan, folds: Iterable[Fold]) -> None:
    """Show every stretch of a replication, with its scores, to all of ``folds``. Raises what ``days`` raises."""
    folds = list(folds)
    with one_blas_thread():
        for frames in days(log, plan):
            scores = scored(frames, plan)
            for one in folds:
                one.add(frames, scores)
