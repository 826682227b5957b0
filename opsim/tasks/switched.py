"""Switches of variability: a task model as it would be if people, or repetitions, did not differ.

Each is a TaskModel around another one, with the same mean over the population, fed by the same random numbers. An
automatic run has no worker, and models of times may know none: all their spread counts as that within a worker.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from opsim.problems import did_you_mean, shown
from opsim.tasks.retimed import Retimed, retimed

if TYPE_CHECKING:
    import numpy as np

    from opsim.task import Performances, TaskModel


def switched(model: TaskModel, variability: str) -> TaskModel:
    """The model with some of its variability switched off; bodies are stretched to their new duration.

    full         : the model itself
    within_only  : a worker's own times, times the population's mean over his own: everybody has the same mean
    between_only : a worker always takes his own mean
    none         : everybody always takes the population's mean
    shuffled     : durations as in full, to the bit; the body of each is that of another performance of the same worker:
                   each keeps his own times and his own postures, and neither tells of the other any more. Times
                   without a body are as in full
    A trace of recorded times has no workers and no bodies: none and between_only give its mean, the others the trace.
    Raises ValueError for any other word.
    """
    if variability != "full" and variability not in _SWITCHES:
        known = ("full", *_SWITCHES)
        raise ValueError(f"variability: no {shown(variability)}; {did_you_mean(variability, known)}")
    as_it_is = ("full", "within_only", "shuffled") if getattr(model, "by_index", False) else ("full",)
    return model if variability in as_it_is else _SWITCHES[variability](model)


@dataclass(frozen=True, eq=False, slots=True)
class Own:
    """A worker's effect beside his mean duration, which is asked for once: an emulator's costs many draws."""

    effect: Any
    mean_s: float


class Switched:
    """What all switches share; whatever the model has beyond the seam is found through the switch."""

    by_index = False

    def __init__(self, model: Any):
        self._model = model

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self._model, name)

    def draw_worker(self, rng: np.random.Generator, body: Any = None, **more: Any) -> Any:
        """As the model's, from the same numbers."""
        return self._model.draw_worker(rng, body, **more)

    def sample(self, n: int, rng: np.random.Generator, *, worker: Any = None, condition: Any = None) -> Performances:
        """n performances, drawn as the model draws them, with the durations of the switch.

        Raises ValueError for a condition: what it asks for and what the switch says would contradict each other.
        """
        if condition is not None:
            raise ValueError(f"a task with switched variability knows no condition, found {condition!r}")
        return self._sample(n, rng, worker)

    def _sample(self, n: int, rng: np.random.Generator, worker: Any) -> Performances:
        raise NotImplementedError

    @cached_property
    def _mean_s(self) -> float:
        return float(self._model.mean_duration_s())


class NoSpread(Switched):
    """Everybody always takes the population's mean."""

    def mean_duration_s(self, worker: Any = None) -> float:
        """The population's mean, whoever works."""
        return self._mean_s

    def _sample(self, n: int, rng: np.random.Generator, worker: Any) -> Retimed:
        return _all_of(self._model.sample(n, rng, worker=worker), n, self._mean_s)


class _KnowsMeans(Switched):
    """A switch that needs each worker's mean."""

    def draw_worker(self, rng: np.random.Generator, body: Any = None, **more: Any) -> Own | None:
        """The model's effect, from the same numbers, with the worker's mean; None where workers do not differ."""
        effect = self._model.draw_worker(rng, body, **more)
        return None if effect is None else self._own(effect)

    def _own(self, worker: Any) -> Own:
        if isinstance(worker, Own):
            return worker
        return Own(worker, self._mean_s if worker is None else float(self._model.mean_duration_s(worker)))


class BetweenOnly(_KnowsMeans):
    """A worker always takes his own mean."""

    def mean_duration_s(self, worker: Any = None) -> float:
        """The model's own mean, of this worker."""
        return self._own(worker).mean_s

    def _sample(self, n: int, rng: np.random.Generator, worker: Any) -> Retimed:
        own = self._own(worker)
        return _all_of(self._model.sample(n, rng, worker=own.effect), n, own.mean_s)


class WithinOnly(_KnowsMeans):
    """A worker's own spread, about the population's mean."""

    def mean_duration_s(self, worker: Any = None) -> float:
        """The population's mean, whoever works."""
        return self._mean_s

    def _sample(self, n: int, rng: np.random.Generator, worker: Any) -> Performances:
        import numpy as np

        own = self._own(worker)
        drawn: Performances = self._model.sample(n, rng, worker=own.effect)
        if own.effect is None:
            return drawn
        return retimed(drawn, np.asarray(drawn.duration_s) * (self._mean_s / own.mean_s))


class Shuffled(Switched):
    """Durations as they are, on the bodies of other performances."""

    def mean_duration_s(self, worker: Any = None) -> float:
        """The model's own mean, of this worker."""
        return float(self._model.mean_duration_s(worker))

    def _sample(self, n: int, rng: np.random.Generator, worker: Any) -> Performances:
        drawn: Performances = self._model.sample(n, rng, worker=worker)
        if drawn.skeleton is None:
            return drawn
        return retimed(self._model.sample(n, rng, worker=worker), drawn.duration_s)


def _all_of(body: Performances, n: int, duration_s: float) -> Retimed:
    import numpy as np

    return retimed(body, np.full(n, duration_s))


_SWITCHES: dict[str, type[Switched]] = {
    "within_only": WithinOnly,
    "between_only": BetweenOnly,
    "none": NoSpread,
    "shuffled": Shuffled,
}
