"""What was drawn for performances, all of a worker's in a task at once, by the names of the engine's draws."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.effects import worker_effect
from opsim.one_thread import one_blas_thread
from opsim.plan import Plan
from opsim.streams import BLOCK, stream


def drawn_s(plan: Plan, replication: int, worker: int, task: int, k: np.ndarray) -> np.ndarray:
    """(n,) seconds of a worker's performances ``k`` (n,) of a task, at rating 1 and without human effects."""
    person, named = plan.workers[worker], plan.tasks[task]
    model: Any = named.model
    if getattr(model, "by_index", False):
        return np.asarray(model.at(k), dtype=np.float64)
    who = (person.name, plan.seed, plan.workforce_of(replication), person.body, plan.across_tasks)
    numbers, which = np.unique(k // BLOCK, return_inverse=True)
    with one_blas_thread():
        effect = worker_effect(named.model, named.name, *who)
        blocks = [_block(plan, replication, person.name, named, effect, number) for number in numbers.tolist()]
    return np.array(blocks).reshape(-1, BLOCK)[which, k % BLOCK]


def _block(plan: Plan, replication: int, worker: str, task: Any, effect: Any, number: int) -> np.ndarray:
    rng = stream(plan.seed, replication, "duration", task.name, worker, number)
    return np.asarray(task.model.sample(BLOCK, rng, worker=effect).duration_s)
