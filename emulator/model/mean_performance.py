"""The mean performance of an emulator: the centre of its law, sent the same way back as a draw."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator.geometry.warps import evaluate
from emulator.model.performances import MotionPerformances

if TYPE_CHECKING:
    from emulator.model.emulator import MotionEmulator
    from emulator.model.gaussian import Law
    from emulator.people.workers import WorkerEffect
    from emulator.skeleton import Skeleton

_NO_PAUSE = -8.5


@dataclass(frozen=True, eq=False)
class MeanPerformance:
    """One performance: ``moving``, a block of one without its pauses, and how long it holds at each site, (S,) s."""

    moving: MotionPerformances
    dwell_s: np.ndarray

    @property
    def skeleton(self) -> Skeleton:
        return self.moving.skeleton

    @property
    def duration_s(self) -> np.ndarray:
        """(1,) seconds, pauses included."""
        return self.moving.duration_s + self.dwell_s.sum()

    @property
    def mark_s(self) -> np.ndarray:
        """(1, E) seconds from the start."""
        dwells = self.moving.model.dwells
        return self.moving.mark_s + (self.dwell_s @ dwells.mark_share.T if len(dwells) else 0.0)

    def positions_m(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(1, T, J, 3) joints in metres, at ``n_times`` even points or at ``times_s`` (T,), as of a draw."""
        times_s = np.linspace(0.0, self.duration_s[0], n_times) if times_s is None else np.array(times_s, float)
        return self.moving.positions_m(times_s=self._moving_s(times_s))

    def _moving_s(self, times_s: np.ndarray) -> np.ndarray:
        """Times (T,) with the pauses taken out: they stand still while a pause lasts."""
        model = self.moving.model
        start_s = self.moving.duration_s * evaluate(model.warps(self.moving.scores), model.dwells.clock)[0]
        for at_s, dwell_s in zip(start_s, self.dwell_s):
            times_s = times_s - np.clip(times_s - at_s, 0.0, dwell_s)
        return times_s


def mean_performance(model: Any, worker: str | WorkerEffect | None = None) -> Any:
    """The mean performance of any model: a cyclic one knows its own, a MotionEmulator's is ``mean_of``."""
    own = getattr(model, "mean_performance", None)
    return mean_of(model, worker) if own is None else own(worker)


def mean_of(model: MotionEmulator, worker: str | WorkerEffect | None = None) -> MeanPerformance:
    """Mean posture, path, pace, marks and bones after registration, at the mean duration.

    worker : as for ``MotionEmulator.sample``: whose mean; None: over the population, of the kind of most people
    A mean of sequences that are not registered would be blunt: one person's lowest point meets another's way up. At a
    site of pauses it holds for the mean of all dwells, also of those who do not pause: 1.2 s in 40 % are 0.48 s.
    Raises ValueError for an unknown worker.
    Source: the mean of aligned sequences of Chen, Park & Srivastava, with the centre of the joint vector.
    """
    effect = model.known_worker(worker) if isinstance(worker, str) else worker
    law = model.law(effect)
    z = law.weight @ law.mean + (law.centre if law.people is None else law.people.mean)
    if effect is None:
        z = z + model.workforce.kinds.most_frequent_shift
    dwell_s = _mean_dwell_s(model, law)
    _put(z, model, "dwells", _NO_PAUSE)
    moving_s = model.mean_duration_s(effect) - dwell_s.sum()
    _put(z, model, "duration", float(model.margin.forward(np.log(moving_s))))
    body = () if effect is None else (effect.scale, effect.turns)
    return MeanPerformance(replace(model.performances(z[None], *body), duration_s=model.moving_s(z[None])), dwell_s)


def _put(z: np.ndarray, model: MotionEmulator, block: str, raw: float) -> None:
    """Write into z (K,) where the coordinates of a block have this raw value."""
    at = model.scale.block(block)
    z[at] = (raw - model.scale.centre[at]) / model.scale.spread[at]


def _mean_dwell_s(model: MotionEmulator, law: Law) -> np.ndarray:
    """(S,) seconds at each site of pauses: the mean over everybody."""
    if not len(model.dwells):
        return np.zeros(0)
    at = model.scale.block("dwells")
    mean, covariance = law.coordinates(np.arange(at.start, at.stop))
    raw = model.scale.centre[at] + model.scale.spread[at] * mean
    spread = model.scale.spread[at] * np.sqrt(np.maximum(np.diagonal(covariance, axis1=1, axis2=2), 0.0))
    return np.asarray(law.weight @ np.array([model.dwells.mean_s(m, s) for m, s in zip(raw, spread)]))
