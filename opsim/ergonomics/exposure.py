"""How long each worker's trunk was bent how far: the postures behind the rows of an EventLog.

Only what was really done counts: each performance is drawn again by its name (worker, task, k), each piece of it is
looked at where its progress lies, and its time is the time it took (who works faster passes through the same postures
in less time). What has no body, or a posture without a flexion, is counted as not measured, never as upright.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.ergonomics.bodies import flexion_rad, has_trunk, rows_at_once
from opsim.ergonomics.pieces import Pieces, drawn_again, pieces_in_window
from opsim.log import EventLog
from opsim.one_thread import one_blas_thread
from opsim.plan import Plan
from opsim.plan.tasks import TaskPlan
from opsim.plugins.blame import PluginError, blamed
from opsim.streams import BLOCK

DEGREES = np.arange(-180, 181)
"""Edges of the bins in which time is counted."""


@dataclass(frozen=True)
class Exposure:
    """What the trunks of W workers went through in the window.

    seconds_by_degree : (W, 360) seconds of work between ``DEGREES[i]`` and ``DEGREES[i + 1]`` degrees of flexion
    degree_seconds    : (W,) flexion in degrees, integrated over those seconds
    unmeasured_s      : (W,) seconds of work whose posture is not known
    """

    seconds_by_degree: np.ndarray
    degree_seconds: np.ndarray
    unmeasured_s: np.ndarray

    @property
    def measured_s(self) -> np.ndarray:
        """(W,) seconds of work whose posture is known."""
        return self.seconds_by_degree.sum(axis=1)

    def beyond_s(self, degrees: int) -> np.ndarray:
        """(W,) seconds of work with the trunk flexed by at least so many whole degrees."""
        return self.seconds_by_degree[:, DEGREES[:-1] >= degrees].sum(axis=1)

    def __add__(self, other: Exposure) -> Exposure:
        """What the same workers went through in both."""
        return Exposure(
            self.seconds_by_degree + other.seconds_by_degree,
            self.degree_seconds + other.degree_seconds,
            self.unmeasured_s + other.unmeasured_s,
        )

    def together(self) -> Exposure:
        """All workers as one."""
        return Exposure(
            self.seconds_by_degree.sum(axis=0, keepdims=True),
            self.degree_seconds.sum(keepdims=True),
            self.unmeasured_s.sum(keepdims=True),
        )


def trunk_exposure(log: EventLog, plan: Plan) -> Exposure:
    """The exposure of each worker of a plan, from the rows of one replication of it.

    Raises ValueError, naming the task, where its model gives postures of a shape it should not; whatever goes wrong in
    a plug-in is a PluginError.
    """
    n = len(plan.workers)
    found = Exposure(np.zeros((n, DEGREES.size - 1)), np.zeros(n), np.zeros(n))
    with one_blas_thread():
        for block, pieces in drawn_again(pieces_in_window(log, plan), log.replication, plan):
            with named_by(plan.tasks[pieces.task[0]]):
                add_flexion(found, block, pieces)
    return found


@contextmanager
def named_by(task: TaskPlan) -> Iterator[None]:
    """What goes wrong in here is said with the task's name, or is the mistake of the plug-in behind it."""
    behind = getattr(task.model, "found", None)
    try:
        with nullcontext() if behind is None else blamed(behind, f"failed as it gave the postures of {task.name}"):
            yield
    except PluginError:
        raise
    except ValueError as error:
        raise ValueError(f"task {task.name}: {error}") from error


def add_flexion(found: Exposure, block: Any, pieces: Pieces) -> None:
    """Add some pieces of one worker, all of one block, a few performances at a time; ``found`` is written to."""
    if not has_trunk(block):
        found.unmeasured_s[pieces.worker[0]] += pieces.seconds.sum()
        return
    together = rows_at_once(block)
    for start in range(0, pieces.k.size, together):
        _count(found, block, pieces.some(slice(start, start + together)))


def _count(found: Exposure, block: Any, pieces: Pieces) -> None:
    """Add what the trunk went through in some pieces of one worker, all of one block."""
    worker = pieces.worker[0]
    rows, which = np.unique(pieces.k % BLOCK, return_inverse=True)
    degrees = np.rad2deg(flexion_rad(block, rows))[which]
    seconds, nowhere_s = spread(pieces, degrees.shape[1])
    known = np.isfinite(degrees)
    at, spent_s = degrees[known], seconds[known]
    cell = np.clip(np.floor(at).astype(int) - DEGREES[0], 0, DEGREES.size - 2)
    found.seconds_by_degree[worker] += np.bincount(cell, spent_s, DEGREES.size - 1)
    found.degree_seconds[worker] += at @ spent_s
    found.unmeasured_s[worker] += seconds[~known].sum() + nowhere_s


def spread(pieces: Pieces, n_cells: int) -> tuple[np.ndarray, float]:
    """(P, C) seconds of each piece in each of C even parts of its performance; and those of pieces without progress."""
    edges = np.linspace(0.0, 1.0, n_cells + 1)
    begin, end = pieces.progress_from[:, None], pieces.progress_to[:, None]
    overlap = np.maximum(np.minimum(end, edges[1:]) - np.maximum(begin, edges[:-1]), 0.0)
    whole = overlap.sum(axis=1, keepdims=True)
    share = np.divide(overlap, whole, out=np.zeros_like(overlap), where=whole > 0)
    return share * pieces.seconds[:, None], float(pieces.seconds[whole[:, 0] <= 0].sum())
