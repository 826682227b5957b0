"""Lifts in a run: what is carried in a performance, from where to where, as the hands show it.

Lifting indices of a run: of each lift, of each task, and composite of each worker, as intervals.

What nobody said widens them: whether the load is put down with care (then the end of the lift counts as well as its
origin), how well it can be gripped, and, of who has no shifts, how long he goes on. Beyond the equation's range (hands
farther than 63 cm, more lifts a minute than its table has) an index has no bound; there the edge of the range stands
for it, "at most" bounds nothing, and the share of such lifts is told.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.ergonomics.angles import AT
from opsim.ergonomics.shift.frames import Frames
from opsim.ergonomics.strain.lifting_pattern import Kind, Pattern, composite_range, least_multiplier, pattern_of
from opsim.ergonomics.strain.niosh import (
    METRIC,
    MOST_ASYMMETRY_DEG,
    asymmetry_multiplier,
    distance_multiplier,
    frequency_multiplier,
    grip_multiplier,
    horizontal_multiplier,
    vertical_multiplier,
)
from opsim.plan import Plan

LEAST_TRAVEL_M = 0.1
"""The hands go up or down by at least so much, or it is carried and not lifted. Source: design."""


@dataclass(frozen=True, slots=True, eq=False)
class Lifts:
    """L lifts and lowers, each (L,) but the ends (L, 2): where what is in the hands is taken, and where it is let go.

    worker, task : ranks; start_s, end_s : when it is taken and let go
    height_m, horizontal_m : of the hands above the floor, and level from the ankles to them
    asymmetry_deg : how far to a side of straight ahead the hands are; knee_deg : bend of the knees, 0 straight
    """

    worker: np.ndarray
    task: np.ndarray
    start_s: np.ndarray
    end_s: np.ndarray
    height_m: np.ndarray
    horizontal_m: np.ndarray
    asymmetry_deg: np.ndarray
    knee_deg: np.ndarray

    @property
    def travel_m(self) -> np.ndarray:
        """(L,) how far up or down."""
        return np.abs(self.height_m[:, 1] - self.height_m[:, 0])

    def some(self, rows: np.ndarray) -> Lifts:
        """A few of them."""
        return Lifts(*(getattr(self, name)[rows] for name in self.__slots__))


def loads_kg(plan: Plan) -> np.ndarray:
    """(tasks,) what is in the hands; 0 where nothing is, or nobody said."""
    return np.array([task.handling.load_kg or 0.0 for task in plan.tasks])


class Lifted:
    """A fold over workers' days that finds the first and the last posture of each performance with its load."""

    def __init__(self, plan: Plan):
        self._loaded = np.r_[loads_kg(plan) > 0, False, False]
        self._parts: list[np.ndarray] = []
        self.carried_s = np.zeros((len(plan.workers), len(plan.tasks)))

    def add(self, frames: Frames, scores: Any = None) -> None:
        """The next stretch."""
        at = np.flatnonzero(frames.carrying & self._loaded[frames.task])
        np.add.at(self.carried_s[frames.worker], frames.task[at], frames.seconds[at])
        hands = _hands(frames.measures[at])
        at, hands = at[np.isfinite(hands).all(axis=1)], hands[np.isfinite(hands).all(axis=1)]
        named = np.stack([frames.task[at], frames.k[at]], axis=1)
        first, last = _ends(named)
        who = np.full(first.size, frames.worker)
        columns = [who, *named[first].T, frames.start_s[at[first]], frames.end_s[at[last]]]
        self._parts.append(np.column_stack([*columns, hands[first], hands[last]]))

    def lifts(self) -> Lifts:
        """All performances in which the hands go up or down with a load."""
        found = np.concatenate([np.empty((0, 13)), *self._parts])
        found = found[np.lexsort([found[:, 3], *found[:, 2::-1].T])]
        first, last = _ends(found[:, :3])
        taken, let_go = found[first, 5:9], found[last, 9:13]
        ends = (np.stack([one, other], axis=1) for one, other in zip(taken.T, let_go.T))
        worker, task = found[first, 0].astype(int), found[first, 1].astype(int)
        lifts = Lifts(worker, task, found[first, 3], found[last, 4], *ends)
        return lifts.some(np.flatnonzero(lifts.travel_m >= LEAST_TRAVEL_M))


def _ends(named: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places of the first and the last row of each name, of rows (N, names) of ranks in the order of time.

    NOTE: names as one number, as np.unique takes 20 times as long over rows.
    """
    number = np.zeros(len(named), np.int64)
    for column in named.T.astype(np.int64):
        number = number * (column.max(initial=0) + 1) + column
    order = np.argsort(number, kind="stable")
    begins = np.flatnonzero(np.r_[True, np.diff(number[order]) > 0][: order.size])
    return order[begins], order[np.r_[begins[1:], order.size][: begins.size] - 1]


def _hands(measures: np.ndarray) -> np.ndarray:
    """(N, 4) height, level distance, asymmetry in degrees, bend of the knees; one side stands for a missing other."""
    forward, left = measures[:, AT["hands_forward_m"]], measures[:, AT["hands_left_m"]]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # numpy: "mean of empty slice" where both sides are missing
        height = np.nanmean(measures[:, [AT["left_hand_up_m"], AT["right_hand_up_m"]]], axis=1)
        knee = np.nanmean(measures[:, [AT["left_knee"], AT["right_knee"]]], axis=1)
    asymmetry = np.rad2deg(np.abs(np.arctan2(left, forward)))
    return np.column_stack([height, np.hypot(forward, left), asymmetry, np.nan_to_num(knee)])


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
    """Each lift with the frequency of its task in its worker's lifting, and the duration of all his lifting.

    nan, and out of range, for what somebody lifts sitting: the equation is for those who stand.
    """
    load, grips = loads_kg(plan)[lifts.task], [task.handling.grip for task in plan.tasks]
    v, d = lifts.height_m * CM, lifts.travel_m[:, None] * CM
    h, a = lifts.horizontal_m * CM, lifts.asymmetry_deg
    beyond = (h > METRIC.far) | (v > METRIC.highest) | (d > METRIC.longest) | (a > MOST_ASYMMETRY_DEG)
    kept = horizontal_multiplier(np.minimum(h, METRIC.far)) * vertical_multiplier(np.minimum(v, METRIC.highest))
    kept = kept * distance_multiplier(np.minimum(d, METRIC.longest))
    kept = METRIC.load * kept * asymmetry_multiplier(np.minimum(a, MOST_ASYMMETRY_DEG))
    good, poor = (_grips(lifts.task, grips, unsaid, v) for unsaid in ("good", "poor"))
    short, long, never = _frequencies(lifts, plan, v)
    sits = seated(plan)[lifts.task]
    load = np.where(sits, np.nan, load)[:, None]
    fili = load * _origin_and_worst(1.0 / (kept * good), 1.0 / (kept * poor))
    index = load * _origin_and_worst(1.0 / (kept * good * short), 1.0 / (kept * poor * long))
    return Indices(fili, index, beyond.any(axis=1) | never | sits)


def seated(plan: Plan) -> np.ndarray:
    """(tasks,) those that the scenario says are done sitting."""
    return np.array([task.handling.sitting is True for task in plan.tasks], bool)


def _origin_and_worst(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """(L, 2): at its origin only, and at the worse of its two ends."""
    return np.stack([low[:, 0], high.max(axis=1)], axis=1)


def _grips(task: np.ndarray, grips: list[str | None], unsaid: str, height: np.ndarray) -> np.ndarray:
    """(L, 2) CM of each lift at its two ends."""
    found = np.ones(height.shape)
    for rank in np.unique(task).tolist():
        found[task == rank] = grip_multiplier(grips[rank] or unsaid, height[task == rank])
    return found


def _frequencies(lifts: Lifts, plan: Plan, height: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(L, 2) FM of each lift at its two ends, of the shortest and the longest duration that it may be of, and (L,)
    whether its frequency may be beyond the table."""
    short, long, beyond = np.ones(height.shape), np.ones(height.shape), np.zeros(len(height), bool)
    for rank in np.unique(lifts.worker).tolist():
        own = lifts.worker == rank
        when = pattern_of(plan, rank, lifts.start_s[own], lifts.end_s[own])
        for task in np.unique(lifts.task[own]).tolist():
            rows = np.flatnonzero(own & (lifts.task == task))
            for found, hours in ((short, when.hours), (long, when.most_hours)):
                multiplier = frequency_multiplier(rows.size / when.minutes, hours, height[rows])
                beyond[rows] |= (multiplier <= 0).any(axis=1)
                found[rows] = np.maximum(multiplier, least_multiplier(hours))
    return short, long, beyond


def composite_of(lifts: Lifts, found: Indices, plan: Plan) -> tuple[float, float]:
    """CLI of one worker's lifts at least and at most, of which those of a task are one kind, with its mean index.

    What he lifts sitting is left out; 0 for no lifts, nan where he lifts sitting only.
    """
    rows = np.flatnonzero(~seated(plan)[lifts.task])
    if not rows.size:
        return (np.nan, np.nan) if lifts.task.size else (0.0, 0.0)
    lifts, found = lifts.some(rows), found.some(rows)
    when = pattern_of(plan, int(lifts.worker[0]), lifts.start_s, lifts.end_s)
    kinds = [_kind(lifts, found, task, when) for task in np.unique(lifts.task).tolist()]
    return composite_range(kinds, when.columns)


def _kind(lifts: Lifts, found: Indices, task: int, when: Pattern) -> Kind:
    own = lifts.task == task
    low, high = found.fili[own].mean(axis=0).tolist()
    taken_m, all_m = lifts.height_m[own, 0], lifts.height_m[own]
    heights = (tuple((CM * np.array([part.min(), part.max()])).tolist()) for part in (taken_m, all_m))
    return Kind((low, high), float(own.sum() / when.minutes), *heights)


def too_often(lifts: Lifts, plan: Plan) -> bool:
    """Whether one worker's lifts together may be more a minute than the table of FM has, at the height of any."""
    if not lifts.worker.size:
        return False
    when = pattern_of(plan, int(lifts.worker[0]), lifts.start_s, lifts.end_s)
    per_min = lifts.worker.size / when.minutes
    return bool((frequency_multiplier(per_min, when.most_hours, lifts.height_m * CM) <= 0).any())
