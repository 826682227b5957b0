"""A worker's own effect in a task: who he is, the same in every replication of one workforce."""

from __future__ import annotations

from functools import cache
from typing import Any

from opsim.streams import stream

ACROSS_TASKS = ("as_recorded", "same_pace")
"""How a worker's effects in different tasks go together; see ``worker_effect``."""


def worker_effect(
    model: Any,
    task: str,
    worker: str,
    seed: int,
    workforce: int,
    body: Any = None,
    across_tasks: str = "as_recorded",
) -> Any:
    """What ``model.draw_worker`` gives this worker; ``workforce`` keys it: 0, or the replication where redrawn.

    as_recorded : a model with ``knows_people`` is also given the worker's leanings, a standard normal number for each
                  recorded person. They are the same in every task, so that effects in tasks that the same people did
                  go together as theirs; effects in other tasks know nothing of each other
    same_pace   : a model with ``knows_slowness`` is also given how slow the worker is, one standard normal number: who
                  is among the slowest tenth in one task is so in all. That is said of moving time: the pauses of an
                  emulated task have luck of their own, and follow it only as far as they did in the recordings

    A model of several motions (``knows_parts``) asks for the effect in each of their tasks by that task's name: who
    fastens inside a kit is who fastens elsewhere.

    Streams: ``effect, worker, task``; ``leaning, worker, person``; ``slowness, worker``; all of the workforce.
    """
    own = stream(seed, workforce, "effect", worker, task, 0)

    @cache
    def leaning(person: str) -> float:
        return float(stream(seed, workforce, "leaning", worker, person, 0).standard_normal())

    more: dict[str, Any] = {"people": leaning} if getattr(model, "knows_people", False) else {}
    if across_tasks == "same_pace" and getattr(model, "knows_slowness", False):
        more["slowness"] = float(stream(seed, workforce, "slowness", worker, 0).standard_normal())
    if getattr(model, "knows_parts", False):
        more["own"] = lambda name, part: worker_effect(part, name, worker, seed, workforce, body, across_tasks)
    return model.draw_worker(own, body, **more)
