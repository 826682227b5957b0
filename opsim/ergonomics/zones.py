"""Seconds in the zones of EN 1005-4: held, reached rarely, reached often; movements counted minute by minute."""

from __future__ import annotations

import numpy as np

from opsim.ergonomics.columns import AT
from opsim.ergonomics.limits import EN_1005_4, OFTEN, RARELY, STATIC, En1005, Zones, judged_moving, zone

ZONED = ("trunk", "sideways", "left_arm", "right_arm", "neck")
BACK_DEG = 5.0
"""A movement is over when the angle has come back so far below the edge of zone 1. Source: design."""
MINUTE_S = 60.0


def zoned_angles_deg(measures: np.ndarray) -> dict[str, np.ndarray]:
    """The angle (N,) of each of ``ZONED``; sideways: side bend or twist, whichever is more; neck: the whole head."""
    at = {name: np.asarray(measures[:, place], float) for name, place in AT.items()}
    return {
        "trunk": at["trunk_flexion"],
        "sideways": np.fmax(np.abs(at["trunk_side"]), np.abs(at["trunk_twist"])),
        "left_arm": at["left_arm_elevation"],
        "right_arm": at["right_arm_elevation"],
        "neck": at["trunk_flexion"] + at["neck_flexion"],
    }


def movements(angle_deg: np.ndarray, beyond_deg: float, back_deg: float = BACK_DEG) -> np.ndarray:
    """(N,) bool: frames with which an angle goes beyond a threshold, having been below it by ``back_deg`` before.

    What begins beyond it counts as a movement; frames between, and unknown ones, change nothing.
    """
    angle = np.asarray(angle_deg, float)
    state = np.where(angle > beyond_deg, 1, np.where(angle < beyond_deg - back_deg, -1, 0))
    last = np.maximum.accumulate(np.where(state != 0, np.arange(1, angle.size + 1), 0))
    state = np.where(last > 0, state[np.maximum(last - 1, 0)], -1)
    return (state == 1) & np.r_[True, state[:-1] == -1][: angle.size]


def per_minute(moved: np.ndarray, start_s: np.ndarray) -> np.ndarray:
    """(N,) how many movements there are in the minute of the clock in which each frame begins."""
    minute = np.floor(start_s / MINUTE_S).astype(np.int64)
    _, which = np.unique(minute, return_inverse=True)
    return np.bincount(which, moved)[which] if moved.size else np.zeros(0)


def ways(held: np.ndarray, a_minute: np.ndarray, often_per_min: float) -> np.ndarray:
    """(N,) STATIC, OFTEN or RARELY."""
    return np.where(held, STATIC, np.where(a_minute >= often_per_min, OFTEN, RARELY))


def verdicts(
    angle_deg: np.ndarray, held: np.ndarray, start_s: np.ndarray, region: str, said: En1005 = EN_1005_4
) -> np.ndarray:
    """(N,) ACCEPTABLE, CONDITIONAL, NOT_RECOMMENDED, or -1 where nobody knows, for one of ``ZONED``.

    held : (N,) whether the frame is in a static posture; start_s : (N,) on the clock
    """
    arm = region.endswith("_arm")
    zones: Zones = getattr(said, "arm" if arm else region)
    a_minute = per_minute(movements(angle_deg, zones.free), start_s)
    found = judged_moving(angle_deg, ways(held, a_minute, said.often_per_min), zones)
    if arm:
        far_too_often = ~held & (zone(angle_deg, zones) == 2) & (a_minute >= said.arm_often_per_min)
        found = np.where(far_too_often, 2, found)
    return found
