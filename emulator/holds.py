"""Holds: pauses in a recording, found by speed, cut out before registration and carried as dwell times.

A pause that some repetitions make and others do not cannot be aligned: the posture's velocity is 0 in it, so that the
warp runs at its slope limit beside it (a pause of 60 frames: 24 frames wrong; cut out: 2). What is left is the moving
time; see ``dwells`` for the model.
Stillness at the start and at the end is a hold too, at moving share 0 or 1: it belongs to the recorded duration.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from emulator.motion import Motion, MotionSet
from emulator.stillness import find, state_of

FEWEST_FRAMES = 10


@dataclass(frozen=True)
class Hold:
    """One pause of a repetition: frames ``first`` to ``last`` are one posture; ``dwell_s`` of them were cut out.

    moving_share : where it lies in the moving time, from 0 (start) to 1 (end)
    mark_share   : (E,) how much of the pause had passed at each mark, 0 for a mark before it, 1 for one after it
    """

    first: int
    last: int
    dwell_s: float
    moving_share: float
    mark_share: tuple[float, ...]


def cut(motions: MotionSet) -> tuple[MotionSet, tuple[tuple[Hold, ...], ...]]:
    """The motions without their pauses, and the pauses of each; the very same set where there are none.

    A pause keeps as many frames as its drift takes at typical speed, so that the movement goes on without a jump.
    """
    found = [_cut(motion, find(motion)) for motion in motions.motions]
    if not any(holds for _, holds in found):
        return motions, tuple(() for _ in found)
    return replace(motions, motions=tuple(m for m, _ in found)), tuple(holds for _, holds in found)


def _cut(motion: Motion, runs: list[tuple[int, int]]) -> tuple[Motion, tuple[Hold, ...]]:
    step_s = motion.duration_s / (len(motion.time_s) - 1)
    drop, state = np.zeros(len(motion.time_s), bool), state_of(motion)
    for first, last in runs:
        inside = np.arange(first + 1, last + 1)
        drop[np.setdiff1d(inside, _kept(state, first, last))] = True
    keep = np.flatnonzero(~drop)
    if not runs or len(keep) < FEWEST_FRAMES:
        return motion, ()
    # moving time stands still where a frame is dropped; a frame dropped at the end ends the pause with the motion
    moving_s = step_s * np.concatenate([[0], np.cumsum(~drop[1:])])
    moving = replace(
        motion,
        directions=motion.directions[keep],
        time_s=moving_s[keep],
        root_m=motion.root_m[keep],
        yaw_rad=motion.yaw_rad[keep],
        mark_s=np.interp(motion.mark_s, motion.time_s, moving_s),
        stretch=None if motion.stretch is None else motion.stretch[keep],
    )
    return moving, tuple(_hold(motion, moving_s, first, last) for first, last in runs)


def _hold(motion: Motion, moving_s: np.ndarray, first: int, last: int) -> Hold:
    start_s, end_s = motion.time_s[first], motion.time_s[last]
    middle_s = (moving_s[first] + moving_s[last]) / 2
    if first == 0:
        middle_s = 0.0
    if last == len(moving_s) - 1:
        middle_s = moving_s[-1]
    passed = np.clip((motion.mark_s - start_s) / (end_s - start_s), 0.0, 1.0)
    dwell_s = (end_s - start_s) - (moving_s[last] - moving_s[first])
    return Hold(first, last, float(dwell_s), float(middle_s / moving_s[-1]), tuple(passed.tolist()))


def _kept(state: np.ndarray, first: int, last: int) -> np.ndarray:
    """Frames of a pause that stay: as many as its drift takes at the typical speed of the frames, evenly spread."""
    step = np.sqrt(np.mean(np.sum(np.diff(state, axis=0) ** 2, axis=-1), axis=-1))
    third = max(1, (last - first + 1) // 3)
    ends = state[first : first + third].mean(0), state[last - third + 1 : last + 1].mean(0)
    drift = np.sqrt(np.mean(np.sum((ends[1] - ends[0]) ** 2, axis=-1)))
    count = int(drift / (np.sum(step**2) / np.sum(step)))
    return np.linspace(first, last, count + 2).astype(int)[1:-1]
