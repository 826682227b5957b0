"""Movements beyond an angle, counted from one stretch of frames to the next."""

from __future__ import annotations

import numpy as np

BACK_DEG = 5.0
"""A movement is over when the angle has come back so far below where it counts from. Source: design."""


class Movements:
    """Of one worker: when an angle goes beyond a threshold, having been below it by ``back_deg`` before."""

    def __init__(self, beyond_deg: float, back_deg: float = BACK_DEG):
        self._beyond_deg, self._back_deg = beyond_deg, back_deg
        self._beyond = False

    def next(self, angle_deg: np.ndarray) -> np.ndarray:
        """(N,) bool: the frames of the next stretch with which a movement begins.

        What begins a day beyond the threshold counts as a movement, and what begins a later stretch there does not;
        frames between, and unknown ones, change nothing.
        """
        angle = np.asarray(angle_deg, float)
        low_deg = self._beyond_deg - self._back_deg
        state = np.r_[1 if self._beyond else -1, np.where(angle > self._beyond_deg, 1, -1 * (angle < low_deg))]
        state = state[np.maximum.accumulate(np.where(state != 0, np.arange(state.size), 0))]
        self._beyond = bool(state[-1] == 1)
        return (state[1:] == 1) & (state[:-1] == -1)


def movements(angle_deg: np.ndarray, beyond_deg: float, back_deg: float = BACK_DEG) -> np.ndarray:
    """(N,) bool: the same of a whole day."""
    return Movements(beyond_deg, back_deg).next(angle_deg)
