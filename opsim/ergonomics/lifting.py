"""Lifting indices of a run: of each lift, of each task, and composite of each worker, as intervals.

What nobody said widens them: whether the load is put down with care (then the end of the lift counts as well as its
origin) and how well it can be gripped. Beyond the equation's range (hands farther than 63 cm, more lifts a minute than
its table has) an index has no bound; there the edge of the range stands for it, and the share of such lifts is told.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opsim.ergonomics.lifting_pattern import Pattern, pattern
from opsim.ergonomics.lifts import Lifts, loads_kg
from opsim.ergonomics.niosh import (
    asymmetry_multiplier,
    distance_multiplier,
    frequency_multiplier,
    grip_multiplier,
    horizontal_multiplier,
    vertical_multiplier,
)
from opsim.ergonomics.niosh_composite import composite_index
from opsim.ergonomics.tables_niosh import FM, METRIC, MOST_ASYMMETRY_DEG
from opsim.plan import Plan

CM = 100.0


@dataclass(frozen=True, slots=True, eq=False)
class Indices:
    """Of L lifts: (L, 2) at least and at most without frequency (FILI) and with it (LI); (L,) out of range or not."""

    fili: np.ndarray
    index: np.ndarray
    out_of_range: np.ndarray

    def some(self, rows: np.ndarray) -> Indices:
        """Of a few of them."""
        return Indices(self.fili[rows], self.index[rows], self.out_of_range[rows])


def indices(lifts: Lifts, plan: Plan) -> Indices:
    """Each lift with the frequency of its task in its worker's lifting, and the duration of all his lifting."""
    load, grips = loads_kg(plan)[lifts.task], [task.handling.grip for task in plan.tasks]
    v, d = lifts.height_m * CM, lifts.travel_m[:, None] * CM
    h, a = lifts.horizontal_m * CM, lifts.asymmetry_deg
    beyond = (h > METRIC.far) | (v > METRIC.highest) | (d > METRIC.longest) | (a > MOST_ASYMMETRY_DEG)
    kept = horizontal_multiplier(np.minimum(h, METRIC.far)) * vertical_multiplier(np.minimum(v, METRIC.highest))
    kept = kept * distance_multiplier(np.minimum(d, METRIC.longest))
    kept = METRIC.load * kept * asymmetry_multiplier(np.minimum(a, MOST_ASYMMETRY_DEG))
    good, poor = (_grips(lifts.task, grips, unsaid, v) for unsaid in ("good", "poor"))
    often, never = _frequencies(lifts, v)
    fili = load[:, None] * _origin_and_worst(1.0 / (kept * good), 1.0 / (kept * poor))
    index = load[:, None] * _origin_and_worst(1.0 / (kept * good * often), 1.0 / (kept * poor * often))
    return Indices(fili, index, beyond.any(axis=1) | never)


def _origin_and_worst(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """(L, 2): at its origin only, and at the worse of its two ends."""
    return np.stack([low[:, 0], high.max(axis=1)], axis=1)


def _grips(task: np.ndarray, grips: list[str | None], unsaid: str, height: np.ndarray) -> np.ndarray:
    """(L, 2) CM of each lift at its two ends."""
    found = np.ones(height.shape)
    for rank in np.unique(task).tolist():
        found[task == rank] = grip_multiplier(grips[rank] or unsaid, height[task == rank])
    return found


def _frequencies(lifts: Lifts, height: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(L, 2) FM of each lift at its two ends, and (L,) whether its frequency is beyond the table."""
    found, beyond = np.ones(height.shape), np.zeros(len(height), bool)
    for rank in np.unique(lifts.worker).tolist():
        own = lifts.worker == rank
        when = pattern(lifts.start_s[own], lifts.end_s[own])
        for task in np.unique(lifts.task[own]).tolist():
            rows = np.flatnonzero(own & (lifts.task == task))
            multiplier = frequency_multiplier(rows.size / when.minutes, when.hours, height[rows])
            beyond[rows] = (multiplier <= 0).any(axis=1)
            found[rows] = np.maximum(multiplier, least_multiplier(when.hours))
    return found, beyond


def least_multiplier(hours: int) -> float:
    """The least FM of a duration that is not 0: it stands for what is beyond the table."""
    return min(value for below in (True, False) for value in FM[hours, below] if value > 0)


def composite_of(lifts: Lifts, found: Indices, side: int) -> float:
    """CLI of one worker's lifts, of which those of a task are one kind: its mean index, height and frequency.

    side : 0 at least, 1 at most. 0 for no lifts.
    """
    when = pattern(lifts.start_s, lifts.end_s)
    kinds = [_kind(lifts, found, side, task, when) for task in np.unique(lifts.task).tolist()]
    kinds.sort(key=lambda kind: (-kind[0], -kind[1]))
    _, fili, heights, per_min = zip(*kinds) if kinds else ((), (), (), ())
    return composite_index(fili, per_min, heights, when.hours, least=least_multiplier(when.hours))


def _kind(lifts: Lifts, found: Indices, side: int, task: int, when: Pattern) -> tuple[float, float, float, float]:
    """STLI, FILI, height in cm and lifts a minute of one task."""
    own = lifts.task == task
    fili, height = float(found.fili[own, side].mean()), float(lifts.height_m[own, 0].mean() * CM)
    per_min = float(own.sum() / when.minutes)
    often = max(float(frequency_multiplier(per_min, when.hours, height)), least_multiplier(when.hours))
    return fili / often, fili, height, per_min


def too_often(lifts: Lifts) -> bool:
    """Whether one worker's lifts together are more a minute than the table of FM has, at the height of any of them."""
    when = pattern(lifts.start_s, lifts.end_s)
    per_min = lifts.worker.size / when.minutes
    return bool((frequency_multiplier(per_min, when.hours, lifts.height_m * CM) <= 0).any())
