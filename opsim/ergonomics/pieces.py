"""Pieces of work in the window of a log, and the draws they come from, block by block."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from opsim.log import SETUP, WORK, EventLog
from opsim.own_luck import OwnLuck
from opsim.plan import Plan
from opsim.streams import BLOCK


class Pieces(NamedTuple):
    """Pieces of performances, each (P,): whose, of which task, the k-th, from and to which progress, for how long."""

    worker: np.ndarray
    task: np.ndarray
    k: np.ndarray
    progress_from: np.ndarray
    progress_to: np.ndarray
    seconds: np.ndarray

    def some(self, rows: np.ndarray | slice) -> Pieces:
        """A few of them."""
        return Pieces(*(column[rows] for column in self))


def pieces_in_window(log: EventLog, plan: Plan) -> Pieces:
    """All work of workers, set-ups too, as far as it lies in the window, by worker, task, k and time."""
    low, high = plan.window_s
    start_s, end_s = np.maximum(log["start_s"], low), np.minimum(log["end_s"], high)
    work = np.isin(log["kind"], (WORK, SETUP))
    rows = np.flatnonzero(work & (log["worker"] >= 0) & (log["task"] >= 0) & (end_s > start_s))
    rows = rows[np.lexsort([start_s[rows], log["k"][rows], log["task"][rows], log["worker"][rows]])]
    begun_s, done = log["start_s"][rows], log["progress_from"][rows]
    a_second = (log["progress_to"][rows] - done) / (log["end_s"][rows] - begun_s)
    first, last = (done + a_second * (edge_s[rows] - begun_s) for edge_s in (start_s, end_s))
    return Pieces(log["worker"][rows], log["task"][rows], log["k"][rows], first, last, (end_s - start_s)[rows])


def drawn_again(pieces: Pieces, replication: int, plan: Plan) -> Iterator[tuple[Any, Pieces]]:
    """Each block of draws, once and one at a time, with its pieces: they are all of one worker and one task.

    Raises ValueError where a task's model draws what is no time.
    """
    models = {task.name: task.model for task in plan.tasks}
    workforce = plan.workforce_of(replication)
    for rank in np.unique(pieces.worker).tolist():
        person, own = plan.workers[rank], pieces.some(pieces.worker == rank)
        luck = OwnLuck(person.name, models, plan.seed, replication, workforce, person.body, plan.across_tasks)
        for rows in alike(own.task, own.k // BLOCK):
            some = own.some(rows)
            yield luck.performance(plan.tasks[some.task[0]].name, int(some.k[0])).block, some


def alike(*columns: np.ndarray) -> list[slice]:
    """Rows one after the other that are the same in every one of some sorted columns."""
    changed = np.any([column[1:] != column[:-1] for column in columns], axis=0)
    edges = [0, *(np.flatnonzero(changed) + 1).tolist(), columns[0].size]
    return [slice(start, stop) for start, stop in pairwise(edges)]
