"""A plug-in's TaskModel with a guard around it: what it gives is checked, what it raises is its own mistake."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.plugins.blame import Found, blamed, fault
from opsim.plugins.taking import must_take, worded
from opsim.task import TaskModel


class GuardedModel:
    """The TaskModel of a plug-in; what it has beyond the seam is found through the guard too."""

    def __init__(self, found: Found, model: Any):
        self.found, self._model = found, model

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self._model, name)

    def mean_duration_s(self, worker: Any = None) -> float:
        """As ``TaskModel``, and a positive number."""
        with blamed(self.found, "failed in mean_duration_s"):
            mean_s = float(self._model.mean_duration_s(worker))
        if not 0 < mean_s < np.inf:
            raise fault(self.found, f"mean_duration_s gave {mean_s:g}, expected a positive number of seconds")
        return mean_s

    def draw_worker(self, rng: np.random.Generator, body: Any = None, **more: Any) -> Any:
        """As ``TaskModel``."""
        with blamed(self.found, "failed in draw_worker"):
            return self._model.draw_worker(rng, body, **more)

    def sample(self, n: int, rng: np.random.Generator, *, worker: Any = None, condition: Any = None) -> Any:
        """As ``TaskModel``; n positive durations, and marks for each."""
        with blamed(self.found, f"failed as it drew {n} performances"):
            drawn = self._model.sample(n, rng, worker=worker, condition=condition)
            duration_s, mark_s = np.asarray(drawn.duration_s, dtype=float), np.asarray(drawn.mark_s)
        if duration_s.shape != (n,) or mark_s.ndim != 2 or len(mark_s) != n:
            shapes = f"durations {duration_s.shape} and marks {mark_s.shape}"
            raise fault(self.found, f"sample gave {shapes}, expected ({n},) and ({n}, marks)")
        good = (duration_s > 0) & np.isfinite(duration_s)
        if not good.all():
            raise fault(self.found, f"sample gave a duration of {duration_s[~good][0]:g} s, expected positive numbers")
        return drawn


def guarded_model(found: Found, model: Any) -> GuardedModel:
    """A model that has the three methods of the seam, to be called as they will be. Raises PluginError."""
    for name in ("mean_duration_s", "draw_worker", "sample"):
        if isinstance(model, type) or not callable(getattr(model, name, None)):
            raise fault(found, f"expected a TaskModel with {name}, found {worded(model)}")
        must_take(found, getattr(model, name), like=getattr(TaskModel, name))
    return GuardedModel(found, model)
