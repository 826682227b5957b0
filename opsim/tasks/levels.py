"""The time of a task whose height changes: the mean over its levels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


class LevelsMean:
    """A TaskModel with the mean time of several; all else, draws too, is that of the first: nobody performs it."""

    def __init__(self, models: Sequence[Any]):
        self.models = tuple(models)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name == "models":
            raise AttributeError(name)
        return getattr(self.models[0], name)

    def mean_duration_s(self, worker: Any = None) -> float:
        """Seconds, at rating 1, the levels in equal parts."""
        return sum(model.mean_duration_s(worker) for model in self.models) / len(self.models)

    def draw_worker(self, *arguments: Any, **more: Any) -> Any:
        return self.models[0].draw_worker(*arguments, **more)

    def sample(self, *arguments: Any, **more: Any) -> Any:
        return self.models[0].sample(*arguments, **more)
