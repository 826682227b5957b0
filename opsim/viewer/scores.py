"""RULA through the shift, four a second: of the same look at postures as the figures of exposure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from opsim.ergonomics.scores.scoring import Scores
from opsim.ergonomics.shift.day import fold
from opsim.ergonomics.shift.frames import Frames
from opsim.log import EventLog
from opsim.plan import Plan

A_SECOND = 4


def n_scores(low_s: float, high_s: float) -> int:
    """Q, how many of a worker."""
    return int(np.ceil((high_s - low_s) * A_SECOND))


def rula(
    log: EventLog, plan: Plan, low_s: float, high_s: float, looked_at: Callable[[int], None] | None = None
) -> np.ndarray | None:
    """(W, Q) the least score in the low half of each byte and the most in the high one, 0 where none is known; None
    where no task and no walk has postures.

    Score ``i`` is that of the moment low_s + (i + 0.5) / A_SECOND. Raises what ``days`` raises.

    looked_at : called with the rank of the worker who is looked at
    """
    sampled = Sampled(len(plan.workers), low_s, high_s, looked_at)
    # NOTE: figures look at postures 12 times a second; as often as is shown takes 40 % of the time
    options = replace(plan.ergonomics, rate_hz=float(A_SECOND))
    fold(log, replace(plan, warm_up_s=low_s, horizon_s=high_s, ergonomics=options), [sampled])
    return sampled.rula if sampled.rula.any() else None


class Sampled:
    """A fold that keeps the score at even moments."""

    def __init__(self, n_workers: int, low_s: float, high_s: float, looked_at: Callable[[int], None] | None = None):
        self._low_s, self._looked_at = low_s, looked_at
        self.rula = np.zeros((n_workers, n_scores(low_s, high_s)), np.uint8)

    def add(self, frames: Frames, scores: Scores) -> None:
        """The next stretch."""
        if self._looked_at is not None:
            self._looked_at(frames.worker)
        first, last = (
            np.ceil((edge_s - self._low_s) * A_SECOND - 0.5).astype(np.int64).clip(0, self.rula.shape[1])
            for edge_s in (frames.start_s, frames.end_s)
        )
        low, high = (np.asarray(scores.rula[:, bound]).astype(np.uint8) for bound in (0, 1))
        value = np.where(low > 0, low | (high << 4), 0).astype(np.uint8)
        n = np.maximum(last - first, 0)
        at = np.repeat(first - np.cumsum(n) + n, n) + np.arange(n.sum())
        self.rula[frames.worker, at] = np.repeat(value, n)
