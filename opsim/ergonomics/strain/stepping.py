"""When somebody walks within a task: his feet leave the floor in turn."""

from __future__ import annotations

import numpy as np

from opsim.ergonomics.columns import AT

LIFTED_M = 0.02
"""One ankle is higher than the other by more than this, and its foot is off the floor. Source: design."""
LONGEST_S = 1.2
"""Feet that follow each other after more than this do not walk: slower than any walk at work. Source: design."""


def stepping(measures: np.ndarray, start_s: np.ndarray, seconds: np.ndarray) -> np.ndarray:
    """(N,) bool: frames within half of ``LONGEST_S`` of an instant at which one foot is lifted after the other.

    measures : (N, COLUMNS), in the order of time; what is not known is no step
    """
    higher = measures[:, AT["left_ankle_up_m"]] - measures[:, AT["right_ankle_up_m"]]
    side = np.where(np.abs(higher) > LIFTED_M, np.sign(np.nan_to_num(higher)), 0.0)
    lifted = np.flatnonzero(side)
    middle_s = start_s + 0.5 * seconds
    follows = (np.diff(side[lifted]) != 0) & (np.diff(middle_s[lifted]) <= LONGEST_S)
    steps_s = middle_s[lifted[1:][follows]]
    if not steps_s.size:
        return np.zeros(start_s.size, bool)
    after = np.searchsorted(steps_s, middle_s)
    near_s = [np.abs(middle_s - steps_s[np.clip(place, 0, steps_s.size - 1)]) for place in (after - 1, after)]
    return np.minimum(*near_s) <= 0.5 * LONGEST_S
