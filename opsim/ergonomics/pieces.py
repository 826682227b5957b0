"""Pieces of work in the window of a log, and the draws they come from, block by block."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from opsim.ergonomics.shift.worker_plans import OwnPlan
from opsim.log import SETUP, WORK, EventLog
from opsim.own_luck import OwnLuck
from opsim.plan import Plan
from opsim.streams import BLOCK


class Pieces(NamedTuple):
    """Pieces of performances, each (P,): whose, of which task, the k-th, from and to which progress, for how long.

    pace_shift : by how much the log time of the whole performance was shifted; None: not at all
    """

    worker: np.ndarray
    task: np.ndarray
    k: np.ndarray
    progress_from: np.ndarray
    progress_to: np.ndarray
    seconds: np.ndarray
    pace_shift: np.ndarray | None = None

    def some(self, rows: np.ndarray | slice) -> Pieces:
        """A few of them."""
        shift = None if self.pace_shift is None else self.pace_shift[rows]
        worker, task, k = self.worker[rows], self.task[rows], self.k[rows]
        return Pieces(worker, task, k, self.progress_from[rows], self.progress_to[rows], self.seconds[rows], shift)


def pieces_in_window(log: EventLog, plan: Plan) -> Pieces:
    """All work of workers, set-ups too, as far as it lies in the window, by worker, task, k and time."""
    low, high = plan.window_s
    rows = worked_rows(log, low, high)
    return pieces_of(log, rows[np.lexsort([log[name][rows] for name in ("start_s", "k", "task", "worker")])], low, high)


def worked_rows(log: EventLog, low_s: float, high_s: float) -> np.ndarray:
    """(n,) rows in which a worker performs a task between two times, in the order of the log."""
    inside = np.minimum(log["end_s"], high_s) > np.maximum(log["start_s"], low_s)
    return np.flatnonzero(inside & np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] >= 0) & (log["task"] >= 0))


def pieces_of(log: EventLog, rows: np.ndarray, low_s: float | np.ndarray, high_s: float | np.ndarray) -> Pieces:
    """Some rows of work, as far as they lie between two times (each one, or (n,) a time a row)."""
    begun_s, ended_s, done = log["start_s"][rows], log["end_s"][rows], log["progress_from"][rows]
    start_s, end_s = np.maximum(begun_s, low_s), np.minimum(ended_s, high_s)
    a_second = (log["progress_to"][rows] - done) / (ended_s - begun_s)
    first, last = (done + a_second * (edge_s - begun_s) for edge_s in (start_s, end_s))
    shift = log["pace_shift"][rows]
    worker, task, k = (log[name][rows] for name in ("worker", "task", "k"))
    return Pieces(worker, task, k, first, last, end_s - start_s, shift if np.any(shift) else None)


Lucks = dict[int, OwnLuck]
"""By the rank of a worker."""


def drawn_again(
    pieces: Pieces, replication: int, plan: Plan, lucks: Lucks | None = None
) -> Iterator[tuple[Any, Pieces]]:
    """Each block of draws, once and one at a time, with its pieces: they are all of one worker and one task.

    Where pieces were slowed, or quickened, by human effects, the postures are those that go with it, from the same
    noise; times are those of the block, to be stretched to the pieces'. A model that takes no shift (``takes_shift``)
    is stretched alone.

    pieces : by worker, task and k
    lucks  : kept by who asks again and again; what is not in it is added
    Raises ValueError where a task's model draws what is no time.
    """
    lucks = {} if lucks is None else lucks
    for rank in np.unique(pieces.worker).tolist():
        own = pieces.some(pieces.worker == rank)
        if rank not in lucks:
            lucks[rank] = luck_of(plan, rank, replication)
        for rows in alike(own.task, own.k // BLOCK):
            some = own.some(rows)
            yield lucks[rank].slowed(plan.tasks[some.task[0]].name, int(some.k[0]) // BLOCK, _shifts(some)), some


def _shifts(pieces: Pieces) -> np.ndarray:
    """(BLOCK,) by how much each performance of a block is shifted; all pieces of one are alike."""
    found = np.zeros(BLOCK)
    if pieces.pace_shift is not None:
        found[pieces.k % BLOCK] = pieces.pace_shift
    return found


def luck_of(plan: Plan, rank: int, replication: int) -> OwnLuck:
    """What decides the draws of a worker: his own, where the plan is of workers of somebody else's model."""
    if isinstance(plan, OwnPlan):
        return plan.lucks[rank]
    person, models = plan.workers[rank], {task.name: task.model for task in plan.tasks}
    workforce = plan.workforce_of(replication)
    return OwnLuck(person.name, models, plan.seed, replication, workforce, person.body, plan.across_tasks)


def alike(*columns: np.ndarray) -> list[slice]:
    """Rows one after the other that are the same in every one of some sorted columns."""
    changed = np.any([column[1:] != column[:-1] for column in columns], axis=0)
    edges = [0, *(np.flatnonzero(changed) + 1).tolist(), columns[0].size]
    return [slice(start, stop) for start, stop in pairwise(edges)]
