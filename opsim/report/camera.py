"""From where moving bodies are looked at, the same for all of them: on the page and in films."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.report.view import TRAVEL_M, view_axes

LIFT_RAD = 0.17
"""How steeply one looks down."""
FLOOR_M, SQUARE_M = -0.03, 0.25
"""The floor lies a sole below the lowest joint; its squares."""
NARROWEST_M = 0.45


@dataclass(frozen=True)
class Camera:
    """A view without perspective: from ``turn_deg`` about the vertical, 0 along x, looking down by LIFT_RAD.

    middle_m : (x, y) at the middle of the picture, unless it follows the root of each body
    wide_m   : from the middle to the edge, as much as any view of any body needs; tall_m : above the floor's zero
    """

    turn_deg: int
    follow: bool
    middle_m: tuple[float, float]
    wide_m: float
    tall_m: float

    @property
    def height_per_width(self) -> float:
        """Of the picture."""
        tall_m = (self.tall_m - FLOOR_M) * np.cos(LIFT_RAD) + 2 * self.wide_m * np.sin(LIFT_RAD)
        return float(tall_m / (2 * self.wide_m))

    def see(self, points_m: np.ndarray, middle_m: np.ndarray) -> np.ndarray:
        """Points (..., 3) -> (..., 3): metres to the right of the middle, up from the lower edge, near the viewer."""
        turn, away = np.radians(self.turn_deg), points_m[..., :2] - middle_m
        near = away @ np.array([np.cos(turn), np.sin(turn)])
        across = away @ np.array([-np.sin(turn), np.cos(turn)])
        up, lean = np.cos(LIFT_RAD), np.sin(LIFT_RAD)
        high = self.wide_m * lean + (points_m[..., 2] - FLOOR_M) * up - near * lean
        return np.stack([across, high, near * up + points_m[..., 2] * lean], axis=-1)

    def as_dict(self) -> dict[str, Any]:
        """What a page's script needs to look in the same way."""
        return {
            "turn_deg": self.turn_deg,
            "follow": self.follow,
            "middle": [round(value, 4) for value in self.middle_m],
            "wide": round(self.wide_m, 4),
            "tall": round(self.tall_m, 4),
            "lift": LIFT_RAD,
            "floor": FLOOR_M,
            "square": SQUARE_M,
        }


def camera_of(positions_m: Sequence[np.ndarray], skeleton: Any) -> Camera:
    """The view of bodies (T, J, 3) that stand side by side; who walks is followed."""
    root = skeleton.parents.index(-1)
    ways = [joints[:, root, :2] for joints in positions_m]
    follow = bool(max(np.linalg.norm(np.ptp(way, axis=0)) for way in ways) > TRAVEL_M)
    low, high = np.min([way.min(axis=0) for way in ways], axis=0), np.max([way.max(axis=0) for way in ways], axis=0)
    middle = (low + high) / 2
    reach = [
        np.linalg.norm(joints[..., :2] - (way[:, None] if follow else middle), axis=-1).max()
        for joints, way in zip(positions_m, ways)
    ]
    return Camera(
        _turn_deg(positions_m, skeleton),
        follow,
        (float(middle[0]), float(middle[1])),
        max(float(max(reach)), NARROWEST_M) + 0.1,
        float(max(joints[..., 2].max() for joints in positions_m)) + 0.16,
    )


def _turn_deg(positions_m: Sequence[np.ndarray], skeleton: Any) -> int:
    """Whence all are looked at first: one direction, from the movements of all."""
    if not {"left_hip", "right_hip"} <= set(skeleton.names):
        return 30
    _, viewer = view_axes(np.concatenate(positions_m), skeleton)
    return round(float(np.degrees(np.arctan2(viewer[1], viewer[0]))))
