"""A worker's own draws, by the names of ``engine/simpy_engine/draws.py``: the same luck in any model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from opsim.effects import worker_effect
from opsim.one_thread import one_blas_thread
from opsim.performance import Drawn
from opsim.streams import BLOCK, Items


class OwnLuck:
    """The performances of one worker: the k-th of a task is the same however the model is built around him.

    workforce : the number his own effects are keyed by: who he is, whatever the replication
    """

    def __init__(
        self,
        worker: str,
        models: Mapping[str, Any],
        seed: int,
        replication: int,
        workforce: int = 0,
        body: Any = None,
        across_tasks: str = "as_recorded",
    ):
        self.models = dict(models)
        self._worker, self._seed, self._replication, self._body = worker, seed, replication, body
        self._workforce, self._across_tasks = workforce, across_tasks
        self._items: dict[str, Items] = {}

    def performance(self, task: str, k: int) -> Drawn:
        """The k-th performance of a task, at rating 1. Raises ValueError where the model draws what is no time."""
        if task not in self._items:
            name = ("duration", task, self._worker)
            self._items[task] = Items(self._seed, self._replication, name, self._draw(task))
        return self._items[task][k]

    def _draw(self, task: str) -> Callable[[np.random.Generator, int], list[Drawn]]:
        model = self.models[task]
        with one_blas_thread():
            who = (self._worker, self._seed, self._workforce, self._body, self._across_tasks)
            effect = worker_effect(model, task, *who)

        def draw(rng: np.random.Generator, number: int) -> list[Drawn]:
            with one_blas_thread():
                block = _trace(model, number) or model.sample(BLOCK, rng, worker=effect)
            _check_times(block, task, model)
            return [Drawn(block, row) for row in range(BLOCK)]

        return draw


def _trace(model: Any, number: int) -> Any:
    """The block of a model that knows its times by index, else None."""
    from opsim.tasks import TimePerformances

    if not getattr(model, "by_index", False):
        return None
    return TimePerformances(np.asarray(model.at(np.arange(number * BLOCK, (number + 1) * BLOCK))))


def _check_times(block: Any, task: str, model: Any) -> None:
    times_s = np.asarray(block.duration_s)
    if times_s.shape != (BLOCK,) or not np.all(np.isfinite(times_s) & (times_s > 0)):
        found = f"shape {times_s.shape}" if times_s.shape != (BLOCK,) else f"{times_s.min():g} to {times_s.max():g} s"
        expected = f"{BLOCK} positive durations in seconds"
        raise ValueError(f"task {task}: {type(model).__name__}.sample gave {found}, expected {expected}")
