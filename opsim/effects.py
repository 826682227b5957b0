"""A worker's own effect in a task: who he is, the same in every replication of one workforce."""

from __future__ import annotations

from functools import cache
from typing import Any

from opsim.streams import stream


def worker_effect(model: Any, task: str, worker: str, seed: int, workforce: int, body: Any = None) -> Any:
    """What ``model.draw_worker`` gives this worker; ``workforce`` keys it: 0, or the replication where redrawn.

    A model with ``knows_people`` is also given the worker's leanings: a standard normal number for each recorded
    person. They are the same in every task, so that effects of tasks that the same people did go together as theirs.
    """
    own = stream(seed, workforce, "effect", worker, task, 0)
    if not getattr(model, "knows_people", False):
        return model.draw_worker(own, body)

    @cache
    def leaning(person: str) -> float:
        return float(stream(seed, workforce, "leaning", worker, person, 0).standard_normal())

    return model.draw_worker(own, body, people=leaning)
