"""Stillness: where a recording stands still, found by speed in spite of tracking noise.

Holds: pauses in a recording, found by speed, cut out before registration and carried as dwell times.

A pause that some repetitions make and others do not cannot be aligned: the posture's velocity is 0 in it, so that the
warp runs at its slope limit beside it (a pause of 60 frames: 24 frames wrong; cut out: 2). What is left is the moving
time; see ``dwells`` for the model.
Stillness at the start and at the end is a hold too, at moving share 0 or 1: it belongs to the recorded duration.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from emulator.motion import Motion, MotionSet, stretches

SLOW_SHARE = 0.05
"""Slower than this share of the repetition's own typical speed is still. A soft turn at 10 % is no hold."""
SHORTEST_S = 0.25
"""A hold lasts at least this long. A minimum-jerk movement of 2 s is slower than 5 % for 0.1 s at its ends."""
HALF_WINDOW_S = 0.1
"""A speed compares the mean posture of this time before with that after: tracking noise is averaged away."""
MOVING_RAD = 0.05
"""A repetition of which every bone stays within this angle of its mean does not move."""


def find(motion: Motion) -> list[tuple[int, int]]:
    """Pauses of a motion as frames (first, last), both within the pause, in order; none where nothing moves.

    Speed is the root mean square over bones, the root's path (1 m/s as 1 rad/s) and the heading, with the variance of
    the tracking noise (from third differences) taken off; typical is the mean over the way, sum of v^2 over sum of v,
    which stillness does not change.
    """
    rate_hz = (len(motion.time_s) - 1) / motion.duration_s
    half = max(1, round(HALF_WINDOW_S * rate_hz))
    if len(motion.time_s) < 4 * half + 4 or not moves(motion):
        return []
    state = state_of(motion)
    square = _square_speed(state, half)
    if _plainly_moving(square, state, half):
        return []
    noise = _noise_rad(state)
    feigned = _feigned(noise**2, half)
    speed = np.sqrt(np.maximum(square - feigned, 0.0))
    typical = np.sum(speed**2) / max(float(np.sum(speed)), 1e-300)
    shaky = np.sqrt(2 * feigned * np.sqrt(1 / state.shape[1]))  # what noise feigns at two standard errors
    limit = np.hypot(SLOW_SHARE * typical, min(shaky, 0.5 * SLOW_SHARE * typical))
    near = float(np.hypot(1.3 * np.sqrt(3.0) * noise, limit * half / 2))
    runs = _joined(state, [(start, stop - 1) for start, stop in stretches(speed < limit)], half, near)
    wide = _apart_again([_widened(state, run, half, near) for run in runs])
    return [(first, last) for first, last in wide if last - first + 1e-9 >= SHORTEST_S * rate_hz]


def moves(motion: Motion) -> bool:
    """Whether some bone leaves its mean by more than ``MOVING_RAD``, and by more than tracking noise does."""
    away = motion.directions - motion.directions.mean(axis=0)
    far = float(np.sqrt(np.einsum("tbc,tbc->tb", away, away).max()))
    if far <= MOVING_RAD or far > 10 * MOVING_RAD or len(away) <= 3:
        return far > MOVING_RAD
    return far > 10 * _noise_rad(motion.directions)


def state_of(motion: Motion) -> np.ndarray:
    """(T, B + 2, 3): the directions, the root's path in metres, the heading in radians."""
    yaw = np.zeros((len(motion.time_s), 3))
    yaw[:, 0] = motion.yaw_rad
    return np.concatenate([motion.directions, motion.root_m[:, None], yaw[:, None]], axis=1)


def _noise_rad(state: np.ndarray) -> float:
    """Tracking noise: standard deviation a coordinate, root mean square over coordinates, from third differences."""
    third = np.abs(np.diff(state, n=3, axis=0)) / np.sqrt(20.0)
    return float(np.sqrt(np.mean((np.median(third, axis=0) / 0.6745) ** 2)))


def _plainly_moving(square: np.ndarray, state: np.ndarray, half: int) -> bool:
    """Whether no frame can be still, by a bound on the noise that costs no medians (they are half the time)."""
    third = np.diff(state, n=3, axis=0)
    most = _feigned(2.25 * float(np.einsum("tbc,tbc->", third, third)) / third.size / 20.0, half)
    return bool(square.min() > (1.2 * SLOW_SHARE * square.sum() / np.sqrt(square).sum()) ** 2 + most)


def _square_speed(state: np.ndarray, half: int) -> np.ndarray:
    """Squared speed (T,) in radians a frame: between the mean state of the ``half`` frames before and after each."""
    extended = np.concatenate([2 * state[:1] - state[half:0:-1], state, 2 * state[-1:] - state[-2 : -half - 2 : -1]])
    sums = np.concatenate([np.zeros_like(extended[:1]), np.cumsum(extended, axis=0)])
    at = np.arange(len(state)) + half
    step = (sums[at + 1 + half] - sums[at + 1] - sums[at] + sums[at - half]) / half
    return np.asarray(np.einsum("tbc,tbc->t", step, step) / step.shape[1] / (half + 1) ** 2)


def _feigned(square_noise: float, half: int) -> float:
    """Squared speed that noise of this variance a coordinate feigns."""
    return 3 * 2 * square_noise / half / (half + 1) ** 2


def _joined(state: np.ndarray, runs: list[tuple[int, int]], half: int, near: float) -> list[tuple[int, int]]:
    """The runs, with those taken as one that noise parted: a window apart at most, in one posture."""
    whole: list[tuple[int, int]] = []
    for first, last in runs:
        if whole and first - whole[-1][1] <= 2 * half:
            before = state[max(whole[-1][0], whole[-1][1] - half) : whole[-1][1] + 1].mean(0)
            if _apart(before, state[first : min(last, first + half) + 1].mean(0)) <= near:
                whole[-1] = (whole[-1][0], last)
                continue
        whole.append((first, last))
    return whole


def _widened(state: np.ndarray, run: tuple[int, int], half: int, near: float) -> tuple[int, int]:
    """The run, with the frames that the window blurred: up to its width, those near the posture at its edge."""
    first, last = run
    size = min(half, last - first) + 1
    for _ in range(half):
        if first > 0 and _apart(state[first - 1], state[first : first + size].mean(0)) <= near:
            first -= 1
        if last < len(state) - 1 and _apart(state[last + 1], state[last + 1 - size : last + 1].mean(0)) <= near:
            last += 1
    return first, last


def _apart_again(runs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """The runs, those that overlap after widening as one."""
    apart: list[tuple[int, int]] = []
    for first, last in runs:
        if apart and first <= apart[-1][1] + 1:
            apart[-1] = (apart[-1][0], max(last, apart[-1][1]))
        else:
            apart.append((first, last))
    return apart


def _apart(one: np.ndarray, other: np.ndarray) -> float:
    """Root mean square over bones of the chord between two postures (B, 3)."""
    return float(np.sqrt(np.mean(np.sum((one - other) ** 2, axis=-1))))


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
