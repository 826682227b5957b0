"""A load as a box between the hands of a body that faces along x."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from opsim.report.svg_shapes import polygon

KG_PER_M3 = 300.0
"""Of what is carried in factories, packed: only for the size of the picture."""
SMALLEST_M, LARGEST_M = 0.12, 0.45
WIDEST_M, LEVEL_M = 0.7, 0.15
"""Hands that hold one box on both sides are no further apart, nor one of them so much higher or further ahead."""
BESIDE_M = 0.06
"""From the middle of a hand or wrist to what it holds: further off it does not touch."""
FACES = (((0, 1), "#c9a97c"), ((1, 1), "#b8945f"), ((1, -1), "#b8945f"), ((0, -1), "#c9a97c"), ((2, 1), "#dcc298"))
"""Axis and side of each face that may be seen, with its colour: lighter above."""


def load_box(
    joints_m: np.ndarray, skeleton: Any, load_kg: float, seen: Callable[[np.ndarray], np.ndarray]
) -> list[tuple[float, str]]:
    """[(nearness, svg)] of a box of load_kg between hands, or wrists, of joints (J, 3); empty where there is none.

    Where both hands are level and further apart than its mass makes it wide, it is as wide as they are apart; where
    one is too far off to hold it, it hangs in the lower hand.
    seen : points (..., 3) in metres -> x and y in pixels, nearness in metres
    """
    hands = _hands_m(joints_m, list(skeleton.names))
    if load_kg <= 0 or hands is None:
        return []
    half, middle = _held(hands, float(np.clip(np.cbrt(load_kg / KG_PER_M3), SMALLEST_M, LARGEST_M)) / 2)
    faces = [(_corners(axis, side) * half + middle, colour) for (axis, side), colour in FACES]
    ordered = sorted(
        ((seen(corners), colour) for corners, colour in faces), key=lambda face: float(face[0][:, 2].mean())
    )
    near = float(seen(middle)[2])
    edge = 'stroke="#8a6b3d" stroke-width="1" stroke-linejoin="round"'
    shown = [f'<path d="{polygon(corners[:, :2])}" fill="{colour}" {edge}/>' for corners, colour in ordered]
    return [(near, "".join(shown))]


def _held(hands: np.ndarray, half_m: float) -> tuple[np.ndarray, np.ndarray]:
    """(3,) half the box along each axis, and (3,) its middle: between both hands, or below the lower one."""
    half, apart = np.full(3, half_m), np.abs(hands[1] - hands[0])
    if (apart <= 2 * (half + BESIDE_M)).all():
        return half, hands.mean(axis=0)
    if apart[1] <= WIDEST_M and max(apart[0], apart[2]) <= LEVEL_M:
        half[1] = apart[1] / 2
        return half, hands.mean(axis=0)
    lower = hands[int(hands[1, 2] < hands[0, 2])]
    return half, lower - [0.0, 0.0, min(half_m, float(lower[2]) / 2)]


def _hands_m(joints_m: np.ndarray, names: list[str]) -> np.ndarray | None:
    """(2, 3) hands, or wrists; None where one of them is not known."""
    for joint in ("hand", "wrist"):
        if {f"left_{joint}", f"right_{joint}"} <= set(names):
            found = np.asarray(joints_m[[names.index(f"left_{joint}"), names.index(f"right_{joint}")]])
            if np.isfinite(found).all():
                return found
    return None


def _corners(axis: int, side: int) -> np.ndarray:
    """(4, 3) corners of a face of the cube from -1 to 1."""
    corners = np.full((4, 3), float(side))
    others = [other for other in range(3) if other != axis]
    corners[:, others] = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    return corners
