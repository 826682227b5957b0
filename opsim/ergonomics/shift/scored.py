"""The scores of a stretch of somebody's shift: each frame with what the scenario says of its task."""

from __future__ import annotations

import numpy as np

from opsim.ergonomics.scores.bounds import NOTHING_OPEN, Bounds, bounds_of
from opsim.ergonomics.scores.scoring import Scores, score
from opsim.ergonomics.shift.carried import carried_by
from opsim.ergonomics.shift.stretch import WAITING, WALKING, Frames
from opsim.plan import Plan


def scored(frames: Frames, plan: Plan) -> Scores:
    """The scores of N frames by ``plan.ergonomics``; 0 where no posture is known, so that nothing can be said."""
    n, known = len(frames), frames.known
    rula, reba, owas = np.zeros((3, n, 2), np.int8)
    found = Scores(rula, reba, owas, np.zeros(n, np.int8))
    brought = np.where((frames.task == WALKING) & frames.carrying, frames.product, -1)
    for task, product in sorted(set(zip(frames.task[known].tolist(), brought[known].tolist()))):
        rows = np.flatnonzero(known & (frames.task == task) & (brought == product))
        some = frames.some(rows)
        flags = (some.repeated, some.static, some.carrying)
        own = score(some.measures, said_of(task, plan, product, frames.worker), plan.ergonomics, *flags)
        for name in ("rula", "reba", "owas", "worse"):
            getattr(found, name)[rows] = getattr(own, name)
    return found


def said_of(task: int, plan: Plan, product: int = -1, worker: int = 0) -> Bounds:
    """What is said of a task; of walking, with a job of a product in the worker's hands where there is one; and of
    waiting, which is standing with nothing in the hands."""
    if task >= 0:
        return bounds_of(plan.tasks[task].handling)
    return NOTHING_OPEN if task == WAITING else carried_by(plan, worker, product)
