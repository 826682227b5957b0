"""When and where each foot bears in one performance, at any moment: planted stances with swings between.

A planted foot does not twist. While it points up from the floor it turns about its ankle, once it points further down
than it stands about its toe; the point about which it turns does not move. Between two stances it flies as the posture
says, plus what is missing at both ends, eased. Where a leg is too short for a foot behind, the heel rises further;
where it is too short for a foot in flight, that comes nearer.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np


@dataclass(frozen=True, eq=False)
class FootStances:
    """The S stances of one foot, in order. Times in seconds, places in metres, angles in radians.

    on_s, rise_s, off_s : (S,) the foot comes down, its heel rises for good, it leaves the floor
    ankle_m   : (S, 3) where the ankle stands; way_rad : (S,) where the foot points to, seen from above
    flat      : height of the toe below the ankle of a standing foot, as a share of its length foot_m (a negative sine)
    toe_least_m : no toe is lower; leg_m : length of thigh and shank
    missing, missing_per_s : (S, 2, 5) planted ankle, angle and pitch of the foot less the posture's, coming and leaving
    """

    on_s: np.ndarray
    rise_s: np.ndarray
    off_s: np.ndarray
    ankle_m: np.ndarray
    way_rad: np.ndarray
    flat: float
    foot_m: float
    toe_least_m: float
    leg_m: float
    missing: np.ndarray
    missing_per_s: np.ndarray

    def bears(self, time_s: np.ndarray) -> np.ndarray:
        """(T,) whether the foot is planted."""
        at = self._at(time_s)
        return np.asarray((time_s >= self.on_s[at]) & (time_s <= self.off_s[at]))

    def targets(
        self, time_s: np.ndarray, joints_m: np.ndarray, leg: np.ndarray, ankles: np.ndarray, feet: np.ndarray
    ) -> None:
        """Writes ankles and unit vectors of the feet (T, 3) at times (T,), for postures with joints (T, J, 3).

        leg : (4,) joint numbers from hip to toe
        """
        from emulator.kernels.planting import targets

        targets(time_s, joints_m, leg, self._kernel, ankles, feet)

    @cached_property
    def _kernel(self) -> Any:
        from emulator.kernels.planting import Foot

        return Foot(**{name: getattr(self, name) for name in Foot._fields})

    def _at(self, time_s: np.ndarray) -> np.ndarray:
        """(T,) the stance that holds, or the last one before."""
        return np.clip(np.searchsorted(self.on_s, time_s, side="right") - 1, 0, len(self.on_s) - 1)


def stances(
    time_s: np.ndarray,
    runs: list[tuple[int, int]],
    joints_m: np.ndarray,
    leg: np.ndarray,
    place_m: np.ndarray,
    foot_m: float,
    toe_least_m: float,
    leg_m: float,
) -> FootStances:
    """The stances of one foot: runs (start, stop) of nodes at time_s (N,) in which it bears.

    joints_m (N, J, 3) of the postures, leg (4,) joint numbers from hip to toe, place_m (S, 3) where the ankles stand
    """
    from emulator.kernels.planting import settle

    flat = float(np.clip((toe_least_m - place_m[0, 2]) / foot_m, -0.95, 0.95))
    n, both = len(runs), np.array(runs, dtype=np.int64)
    rise_s, way_rad, missing, rates = np.empty(n), np.empty(n), np.empty((n, 2, 5)), np.empty((n, 2, 5))
    settle(time_s, both, joints_m, leg, place_m, foot_m, leg_m, flat, rise_s, way_rad, missing, rates)
    on_s, off_s = time_s[both[:, 0]], time_s[both[:, 1] - 1]
    if runs[0][0] == 0:
        on_s[0] = -np.inf
    if runs[-1][1] == len(time_s):
        off_s[-1] = np.inf
    return FootStances(on_s, rise_s, off_s, place_m, way_rad, flat, foot_m, toe_least_m, leg_m, missing, rates)
