"""Frames: what one worker's body did in a stretch of his shift, posture by posture."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

WALKING, WAITING = -1, -2
"""In place of a task: nobody performs one."""


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """N frames of one worker in the order of time; each array (N,) but measures.

    worker   : rank; all frames are his
    start_s, seconds : when on the clock of the run, and for how long; no frame crosses an hour of the clock
    station, task, product : ranks; -1 where there is none, and WALKING or WAITING in place of a task
    row      : of the log; k : which performance of the task (or walk) of this worker
    progress : the middle of the frame in its performance, 0 to 1
    carrying : whether the hands hold what ``TaskPlan.handling`` tells of (where no load is said: whether they may)
    repeated : whether the same task is begun again and again; static : whether the posture is held
    measures : (N, COLUMNS) by ``columns.py``; all nan where no posture is known, then a frame is a whole piece of work
    """

    worker: int
    start_s: np.ndarray
    seconds: np.ndarray
    station: np.ndarray
    task: np.ndarray
    product: np.ndarray
    row: np.ndarray
    k: np.ndarray
    progress: np.ndarray
    carrying: np.ndarray
    repeated: np.ndarray
    static: np.ndarray
    measures: np.ndarray

    def __len__(self) -> int:
        return self.seconds.size

    @property
    def end_s(self) -> np.ndarray:
        """(N,) when each is over."""
        return self.start_s + self.seconds

    @property
    def known(self) -> np.ndarray:
        """(N,) whether anything is known of the posture."""
        return ~np.isnan(self.measures).all(axis=1)

    def some(self, rows: np.ndarray | slice) -> Frames:
        """A few of them."""
        columns = {field.name: getattr(self, field.name) for field in fields(self) if field.name != "worker"}
        return Frames(self.worker, **{name: column[rows] for name, column in columns.items()})
