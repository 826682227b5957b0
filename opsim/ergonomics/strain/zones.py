"""Seconds in the zones of EN 1005-4: held, reached rarely, reached often; movements counted minute by minute."""

from __future__ import annotations

import numpy as np

from opsim.ergonomics.columns import AT
from opsim.ergonomics.strain.arm_angle import arm_angle_deg
from opsim.ergonomics.strain.limits import (
    EN_1005_4,
    NOT_RECOMMENDED,
    OFTEN,
    RARELY,
    STATIC,
    En1005,
    Zones,
    judged_moving,
    zone,
)
from opsim.ergonomics.strain.movements import Movements

ZONED = ("trunk", "sideways", "left_arm", "right_arm", "neck")
MINUTE_S = 60.0


def zoned_angles_deg(measures: np.ndarray) -> dict[str, np.ndarray]:
    """The angle (N,) of each of ``ZONED``; sideways: side bend or twist, whichever is more; neck: the whole head; arms:
    elevation, less than 0 behind the trunk."""
    at = {name: np.asarray(measures[:, place], float) for name, place in AT.items()}
    return {
        "trunk": at["trunk_flexion"],
        "sideways": np.fmax(np.abs(at["trunk_side"]), np.abs(at["trunk_twist"])),
        "left_arm": arm_angle_deg(measures, "left"),
        "right_arm": arm_angle_deg(measures, "right"),
        "neck": at["trunk_flexion"] + at["neck_flexion"],
    }


def per_minute(moved: np.ndarray, start_s: np.ndarray) -> np.ndarray:
    """(N,) how many movements there are in the minute of the clock in which each frame begins."""
    minute = np.floor(start_s / MINUTE_S).astype(np.int64)
    _, which = np.unique(minute, return_inverse=True)
    return np.bincount(which, moved)[which] if moved.size else np.zeros(0)


def ways(held: np.ndarray, a_minute: np.ndarray, often_per_min: float) -> np.ndarray:
    """(N,) STATIC, OFTEN or RARELY."""
    return np.where(held, STATIC, np.where(a_minute >= often_per_min, OFTEN, RARELY))


class Zoned:
    """Judges the angle of one of ``ZONED`` of one worker, stretch after stretch.

    How often one moves is counted for each zone by itself, by the movements that cross the edge at which it begins,
    away from upright: who bends from 40 to 70 degrees again and again moves into zone 3 and not into zone 2. What goes
    beyond zone 2 has crossed its edge too, and coming back is no movement of its own. One backward is over when half of
    the leeway is left, as who stands upright need not lean forward. Source of that: design
    """

    def __init__(self, region: str, said: En1005 = EN_1005_4):
        self._arm, self._said = region.endswith("_arm"), said
        self.zones: Zones = getattr(said, "arm" if self._arm else region)
        self._backward = Movements(-self.zones.backward_from, self.zones.leeway_deg / 2.0)
        self._into_2, self._into_3 = Movements(self.zones.free), Movements(self.zones.far)

    def verdicts(self, angle_deg: np.ndarray, held: np.ndarray, start_s: np.ndarray) -> np.ndarray:
        """(N,) ACCEPTABLE, CONDITIONAL, NOT_RECOMMENDED, or -1 where nobody knows, for the angles (N,) of a stretch.

        held : (N,) whether the frame is in a static posture; start_s : (N,) on the clock. A minute is of one stretch.
        """
        a_minute = self._a_minute(angle_deg, start_s)
        found = judged_moving(angle_deg, ways(held, a_minute, self._said.often_per_min), self.zones)
        if self._arm:
            too_often = ~held & (zone(angle_deg, self.zones) == 2) & (a_minute >= self._said.arm_often_per_min)
            found = np.where(too_often, NOT_RECOMMENDED, found)
        return found

    def _a_minute(self, angle_deg: np.ndarray, start_s: np.ndarray) -> np.ndarray:
        """(N,) movements a minute into the zone in which each frame is; zone 1 accepts all."""
        moved = (self._backward.next(-angle_deg), self._into_2.next(angle_deg), self._into_3.next(angle_deg))
        backward, into_2, into_3 = (per_minute(one, start_s) for one in moved)
        return np.choose(np.maximum(zone(angle_deg, self.zones), 0), (backward, np.zeros(into_2.size), into_2, into_3))


def verdicts(
    angle_deg: np.ndarray, held: np.ndarray, start_s: np.ndarray, region: str, said: En1005 = EN_1005_4
) -> np.ndarray:
    """(N,) verdicts of a whole day, as ``Zoned`` gives them."""
    return Zoned(region, said).verdicts(angle_deg, held, start_s)
