"""Lifts in a run: what is carried in a performance, from where to where, as the hands show it."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.ergonomics.columns import AT
from opsim.ergonomics.shift.stretch import Frames
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
