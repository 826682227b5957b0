"""Stillness: where a recording stands still, found by speed in spite of tracking noise."""

from __future__ import annotations

import numpy as np

from emulator.motion import Motion
from emulator.runs import stretches

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
