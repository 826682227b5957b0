"""How fast the fastest joint moves, and new people kept from moving faster than anybody's body was seen to.

Six people span a law of pace and posture in which the next one may rush with his hand through the very part of the task
where the quick among the six do nothing: in recorded sit-to-stands, one drawn person in ten had a typical performance
faster than any recorded one, at worst four times as fast. How long he takes is not touched: only how he spreads it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from emulator.density import regression
from emulator.motion import Motion, MotionSet

if TYPE_CHECKING:
    from emulator.density import LowRankNormal
    from emulator.model import MotionEmulator

N_TIMES = 101
ROOM = 1.25
"""A new person's typical performance may be so many times as fast as the fastest recorded performance."""
STEPS = np.linspace(1.0, 0.0, 9)[1:]


def recorded_m_per_s(motions: MotionSet) -> float:
    """The greatest speed of any joint between ``N_TIMES`` even points of a recorded performance."""
    return max(_fastest_m_per_s(_resampled(m), np.array([m.duration_s]))[0] for m in motions.motions)


def emulated_m_per_s(model: MotionEmulator, scores: np.ndarray) -> np.ndarray:
    """(n,) the same of performances with these joint coordinates (n, K)."""
    drawn = model.performances(scores)
    return _fastest_m_per_s(drawn.positions_m(n_times=N_TIMES), drawn.duration_s)


def no_faster(model: MotionEmulator, z: np.ndarray, law: LowRankNormal) -> np.ndarray:
    """A new person's mean z (K,), or, if too fast, drawn towards the typical person of his own pace until he is not.

    law : of new people. His log moving time stays to the bit, so that the law of times is what it was. z itself where
    the library does not say how fast the recordings were.
    """
    limit = ROOM * model.report.fastest_m_per_s
    if not emulated_m_per_s(model, z[None])[0] > limit:
        return z
    at = model.scale.block("duration").start
    alike = law.mean + regression(law.covariance_with(at), at) * (z[at] - law.mean[at])
    towards = alike + STEPS[:, None] * (z - alike)
    towards[:, at] = z[at]
    slow_enough = emulated_m_per_s(model, towards) <= limit
    return np.asarray(towards[np.argmax(slow_enough)] if slow_enough.any() else towards[-1])


def _resampled(motion: Motion) -> np.ndarray:
    """(1, N_TIMES, J, 3) joints of a recording at even times."""
    joints = motion.skeleton.positions(motion.directions, motion.bone_length_m, motion.root_m)
    even, flat = np.linspace(0.0, motion.duration_s, N_TIMES), joints.reshape(len(joints), -1)
    return np.stack([np.interp(even, motion.time_s, column) for column in flat.T], axis=1).reshape(1, N_TIMES, -1, 3)


def _fastest_m_per_s(joints: np.ndarray, duration_s: np.ndarray) -> np.ndarray:
    """(n,) from joints (n, T, J, 3) at even times of durations (n,)."""
    step_m = np.linalg.norm(np.diff(joints, axis=1), axis=-1).max(axis=(1, 2))
    return np.asarray(step_m * (joints.shape[1] - 1) / duration_s)
