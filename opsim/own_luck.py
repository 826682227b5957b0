"""A worker's own draws, by the names of ``engine/draws.py``: the same luck in any model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from opsim.effects import worker_effect
from opsim.one_thread import one_blas_thread
from opsim.performance import Drawn, OfBlock
from opsim.streams import BLOCK, Items, stream


class OwnLuck:
    """The performances of one worker: the k-th of a task is the same however the model is built around him.

    workforce : the number his own effects are keyed by: who he is, whatever the replication
    handling  : by task, what his hands hold, for who looks at his postures
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
        self.worker, self.seed, self.replication, self.body = worker, seed, replication, body
        self.workforce, self.across_tasks = workforce, across_tasks
        self._items: dict[str, Items] = {}
        self._effects: dict[str, Any] = {}
        self.handling: dict[str, Any] = {}
        self._last: tuple[tuple[str, int, float], Any] | None = None

    def __getstate__(self) -> dict[str, Any]:
        """Without what is drawn: it can be drawn again."""
        return {**vars(self), "_items": {}, "_last": None}

    def performance(self, task: str, k: int) -> Drawn:
        """The k-th performance of a task, at rating 1. Raises ValueError where the model draws what is no time."""
        if task not in self._items:
            name = ("duration", task, self.worker)
            self._items[task] = Items(self.seed, self.replication, name, self._draw(task))
        return self._items[task][k]

    def slowed(self, task: str, number: int, shift: np.ndarray) -> Any:
        """Block ``number`` of a task from the same noise, with log durations shifted by (BLOCK,) and the postures that
        go with it; where the model takes no shift (``takes_shift``), or there is none, the block as it is drawn.
        """
        model = self.models[task]
        if not np.any(shift) or not takes_shift(model):
            return self.performance(task, number * BLOCK).block
        rng = stream(self.seed, self.replication, "duration", task, self.worker, number)
        with one_blas_thread():
            condition = {"log_duration_shift": np.asarray(shift, dtype=float)}
            return model.sample(BLOCK, rng, worker=self._effect(task), condition=condition)

    def as_slow(self, drawn: Drawn, task: str, k: int, shift: float) -> Drawn | Slowed:
        """The k-th performance of a task as postures follow a shift of its log time, where they can."""
        return Slowed(self, task, k, shift) if shift and takes_shift(self.models[task]) else drawn

    def slowed_one(self, task: str, k: int, shift: float) -> Any:
        """The block with the k-th performance of a task so slowed; the last one is kept."""
        if self._last is None or self._last[0] != (task, k, shift):
            shifts = np.zeros(BLOCK)
            shifts[k % BLOCK] = shift
            self._last = (task, k, shift), self.slowed(task, k // BLOCK, shifts)
        return self._last[1]

    def _effect(self, task: str) -> Any:
        """The worker's own effect in a task."""
        if task not in self._effects:
            who = (self.worker, self.seed, self.workforce, self.body, self.across_tasks)
            with one_blas_thread():
                self._effects[task] = worker_effect(self.models[task], task, *who)
        return self._effects[task]

    def _draw(self, task: str) -> Callable[[np.random.Generator, int], list[Drawn]]:
        model, effect = self.models[task], self._effect(task)

        def draw(rng: np.random.Generator, number: int) -> list[Drawn]:
            with one_blas_thread():
                block = _trace(model, number) or model.sample(BLOCK, rng, worker=effect)
            _check_times(block, task, model)
            return [Drawn(block, row, self) for row in range(BLOCK)]

        return draw


@dataclass(frozen=True)
class Slowed(OfBlock):
    """The k-th performance of a task with its log time shifted, drawn when somebody asks for its body."""

    luck: OwnLuck = field(repr=False, compare=False)
    task: str
    k: int
    shift: float

    @property
    def block(self) -> Any:  # type: ignore[override]
        """Of the same noise, as ``OwnLuck.slowed`` draws it."""
        return self.luck.slowed_one(self.task, self.k, self.shift)

    @property
    def row(self) -> int:  # type: ignore[override]
        return self.k % BLOCK


def takes_shift(model: Any) -> bool:
    """Whether a model's ``conditions`` name ``log_duration_shift``: its postures can follow a change of pace."""
    return "log_duration_shift" in getattr(model, "conditions", ())


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
