"""Performances that take another time than they were drawn with: the same movement, stretched as a whole.

Switches of variability: a task model as it would be if people, or repetitions, did not differ.

Each is a TaskModel around another one, with the same mean over the population, fed by the same random numbers. An
automatic run has no worker, and models of times may know none: all their spread counts as that within a worker.
A pace that is asked of a worker is no variability: no switch takes it away where the model reads it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from opsim.problems import did_you_mean, shown

if TYPE_CHECKING:
    import numpy as np

    from opsim.task_model import Performances, TaskModel


@dataclass(frozen=True, eq=False)
class Retimed:
    """n performances that last ``duration_s`` (n,); marks and postures are those of ``body``, at the same shares of it.

    ``scores`` are the coefficients the body was drawn with: they tell its own duration, not this one.
    """

    body: Performances
    duration_s: np.ndarray

    def __getattr__(self, name: str) -> Any:
        """The lengths of the bones, beyond the seam, where the body has them: no time changes them."""
        if name != "bone_length_m":
            raise AttributeError(f"{type(self).__name__} has no {name}")
        return getattr(self.body, name)

    @property
    def scores(self) -> np.ndarray:
        return self.body.scores

    @property
    def skeleton(self) -> Any:
        return self.body.skeleton

    @cached_property
    def mark_s(self) -> np.ndarray:
        """(n, E) seconds from the start."""
        import numpy as np

        return np.asarray(self.body.mark_s) * self._stretch[:, None]

    def directions(self, times_s: np.ndarray | None = None, **more: Any) -> np.ndarray:
        """As the body's; ``times_s`` (T,) or (n, T) seconds of the new duration."""
        return self._decoded("directions", times_s, more)

    def positions_m(self, times_s: np.ndarray | None = None, **more: Any) -> np.ndarray:
        """As the body's; times as ``directions``."""
        return self._decoded("positions_m", times_s, more)

    def root_m(self, times_s: np.ndarray | None = None, **more: Any) -> np.ndarray:
        """As the body's; times as ``directions``."""
        return self._decoded("root_m", times_s, more)

    @cached_property
    def _stretch(self) -> np.ndarray:
        """(n,) the new duration over the body's own."""
        import numpy as np

        return self.duration_s / np.asarray(self.body.duration_s, dtype=float)

    def _decoded(self, what: str, times_s: np.ndarray | None, more: dict[str, Any]) -> np.ndarray:
        import numpy as np

        decode = getattr(self.body, what)
        if times_s is None:
            return np.asarray(decode(**more))
        own_s = np.asarray(times_s) / self._stretch[:, None]
        return np.asarray(decode(times_s=own_s[0] if len(own_s) == 1 else own_s, **more))


class RetimedRows(Retimed):
    """Performances of which some can be taken: ``performances[3]`` and slices are performances again."""

    def __len__(self) -> int:
        return len(self.duration_s)

    def __getitem__(self, index: int | slice | np.ndarray) -> RetimedRows:
        import numpy as np

        body: Any = self.body
        rows = slice(index, index + 1 or None) if isinstance(index, (int, np.integer)) else index
        return RetimedRows(body[index], self.duration_s[rows])


def retimed(body: Performances, duration_s: np.ndarray) -> Retimed:
    """The performances of ``body`` in ``duration_s`` (n,) seconds; with rows to take where ``body`` has them."""
    kind = RetimedRows if hasattr(type(body), "__getitem__") else Retimed
    return kind(body, duration_s)


def switched(model: TaskModel, variability: str) -> TaskModel:
    """The model with some of its variability switched off; bodies are stretched to their new duration.

    full         : the model itself
    within_only  : a worker's own times, times the population's mean over his own: everybody has the same mean
    between_only : a worker always takes his own mean
    none         : everybody always takes the population's mean
    shuffled     : durations as in full, to the bit; the body of each is that of another performance of the same worker:
                   each keeps his own times and his own postures, and neither tells of the other any more. Times
                   without a body are as in full
    Who is asked for a ``pace`` that the model reads (``body_keys``) has the population's mean divided by it under
    within_only and none; under the others it is in his own times, as in full.
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
    """A worker's effect beside what is asked for once: the mean of an emulator costs many draws.

    mean_s  : his mean duration under the switch
    stretch : that over his own mean, where his own times are kept
    """

    effect: Any
    mean_s: float
    stretch: float = 1.0


class Switched(ABC):
    """What all switches share; whatever the model has beyond the seam is found through the switch."""

    by_index = False
    conditions = ()
    """What ``sample`` may be asked for, whatever the model may be: nothing."""

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

    @abstractmethod
    def _sample(self, n: int, rng: np.random.Generator, worker: Any) -> Performances:
        """n performances with the durations of the switch."""

    @cached_property
    def _mean_s(self) -> float:
        return float(self._model.mean_duration_s())

    def _pace(self, body: Any) -> float:
        """The pace that is asked of a worker with this body, a mapping or an object; 1 where none is, or none read."""
        reads = "pace" in getattr(self._model, "body_keys", ())
        pace = body.get("pace") if isinstance(body, Mapping) else getattr(body, "pace", None)
        return 1.0 if pace is None or not reads else float(pace)


class _KnowsMeans(Switched):
    """A switch that says what each worker's mean is."""

    def draw_worker(self, rng: np.random.Generator, body: Any = None, **more: Any) -> Own | None:
        """The model's effect, from the same numbers, with the worker's mean; None where workers do not differ."""
        effect = self._model.draw_worker(rng, body, **more)
        return None if effect is None else self._own(effect, self._pace(body))

    def mean_duration_s(self, worker: Any = None) -> float:
        """Of this worker under the switch, at the pace that is asked of him; without a worker the population's."""
        return self._own(worker).mean_s

    def _own(self, worker: Any, pace: float = 1.0) -> Own:
        if worker is None or isinstance(worker, Own):
            return worker or Own(None, self._mean_s)
        return self._of(worker, self._mean_s / pace)

    @abstractmethod
    def _of(self, effect: Any, paced_s: float) -> Own:
        """With this effect of the model; ``paced_s``: the population's mean at the pace that is asked of him."""


class _NoneWithin(_KnowsMeans):
    """A switch under which a worker always takes the same time."""

    def _sample(self, n: int, rng: np.random.Generator, worker: Any) -> Performances:
        import numpy as np

        own = self._own(worker)
        return retimed(self._model.sample(n, rng, worker=own.effect), np.full(n, own.mean_s))


class NoSpread(_NoneWithin):
    """Everybody always takes the population's mean."""

    def _of(self, effect: Any, paced_s: float) -> Own:
        return Own(effect, paced_s)


class BetweenOnly(_NoneWithin):
    """A worker always takes his own mean."""

    def _of(self, effect: Any, paced_s: float) -> Own:
        return Own(effect, float(self._model.mean_duration_s(effect)))


class WithinOnly(_KnowsMeans):
    """A worker's own spread, about the population's mean."""

    def _of(self, effect: Any, paced_s: float) -> Own:
        return Own(effect, paced_s, paced_s / float(self._model.mean_duration_s(effect)))

    def _sample(self, n: int, rng: np.random.Generator, worker: Any) -> Performances:
        import numpy as np

        own = self._own(worker)
        drawn: Performances = self._model.sample(n, rng, worker=own.effect)
        return drawn if own.effect is None else retimed(drawn, np.asarray(drawn.duration_s) * own.stretch)


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


_SWITCHES: dict[str, type[Switched]] = {
    "within_only": WithinOnly,
    "between_only": BetweenOnly,
    "none": NoSpread,
    "shuffled": Shuffled,
}
