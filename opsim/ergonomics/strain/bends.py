"""How often bodies go down and come up again, beside what lifts of loads already count."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from opsim.ergonomics.columns import AT
from opsim.ergonomics.shift.stretch import Frames
from opsim.ergonomics.strain.garg import BENCH_M, moved_kcal

BENT_DEG = 20.0
"""Trunk flexion from which one stands bent. Source: design; the paper says "standing bent position"."""
SQUAT_DEG = 60.0
"""Bend of the knees at the lower end from which a lift is a squat and not a stoop. Source: design."""


@dataclass(frozen=True, slots=True, eq=False)
class Bends:
    """B bends (B,): whose (rank), the lowest height of the hands in metres, whether the knees bend for it, and whether
    the way down and the way up are without a load."""

    worker: np.ndarray
    low_m: np.ndarray
    squat: np.ndarray
    down: np.ndarray
    up: np.ndarray


def bends_of(frames: Frames, held: np.ndarray, may: np.ndarray) -> Bends:
    """Hands below BENCH_M while trunk or knees are bent, as long as it lasts without a break.

    held : (N,) bool, with a load; may : (N,) bool, which frames count
    """
    hands_m, knees, trunk = _at(frames, "hand_up_m"), _at(frames, "knee"), frames.measures[:, AT["trunk_flexion"]]
    low = may & (hands_m < BENCH_M) & ((trunk >= BENT_DEG) | (knees >= SQUAT_DEG))
    at = np.flatnonzero(low)
    if not at.size:
        none = np.empty(0, bool)
        return Bends(np.empty(0, int), np.empty(0), none, none, none)
    apart = (np.diff(at) > 1) | (frames.start_s[at[1:]] - frames.end_s[at[:-1]] > 1e-3)
    begins = np.flatnonzero(np.r_[True, apart])
    ends = np.r_[begins[1:], at.size]
    least_m, deepest = np.minimum.reduceat(hands_m[at], begins), np.maximum.reduceat(np.nan_to_num(knees[at]), begins)
    who = np.full(begins.size, frames.worker)
    return Bends(who, least_m, deepest >= SQUAT_DEG, ~held[at[begins]], ~held[at[ends - 1]])


def joined(parts: list[Bends]) -> Bends:
    """All of some."""
    if not parts:
        none = np.empty(0, bool)
        return Bends(np.empty(0, int), np.empty(0), none, none, none)
    return Bends(*(np.concatenate([getattr(one, name) for one in parts]) for name in Bends.__slots__))


def bending_kcal(bends: Bends, worker: int, body_kg: float, sex: float) -> float:
    """Net, of one worker's ways down and up without a load: the body's own part of lowering and lifting.

    Source: Garg, Chaffin & Herrin 1978 with a load of 0; that this may stand for a bend without one is the design's.
    """
    own = bends.worker == worker
    low_m, squat = bends.low_m[own], bends.squat[own]
    down = moved_kcal(body_kg, 0.0, BENCH_M, low_m, sex, squat)
    up = moved_kcal(body_kg, 0.0, low_m, BENCH_M, sex, squat)
    return float(down[bends.down[own]].sum() + up[bends.up[own]].sum())


def _at(frames: Frames, name: str) -> np.ndarray:
    """(N,) the mean of both sides, or the side that is known."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # numpy: "mean of empty slice" where both sides are missing
        return np.asarray(np.nanmean(frames.measures[:, [AT[f"left_{name}"], AT[f"right_{name}"]]], axis=1))
