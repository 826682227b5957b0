"""A load as a box between the hands of a body that faces along x."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from opsim.report.svg_shapes import polygon

KG_PER_M3 = 300.0
"""Of what is carried in factories, packed: only for the size of the picture."""
SMALLEST_M, LARGEST_M = 0.12, 0.45
WIDEST_M = 0.7
"""Between hands that hold one box."""
FACES = (((0, 1), "#c9a97c"), ((1, 1), "#b8945f"), ((1, -1), "#b8945f"), ((0, -1), "#c9a97c"), ((2, 1), "#dcc298"))
"""Axis and side of each face that may be seen, with its colour: lighter above."""


def load_box(
    joints_m: np.ndarray, skeleton: Any, load_kg: float, seen: Callable[[np.ndarray], np.ndarray]
) -> list[tuple[float, str]]:
    """[(nearness, svg)] of a box of load_kg between hands, or wrists, of joints (J, 3); empty where there is none,
    or where hands are too far apart to hold one thing.

    seen : points (..., 3) in metres -> x and y in pixels, nearness in metres
    """
    hands = _hands_m(joints_m, list(skeleton.names))
    if load_kg <= 0 or hands is None or np.linalg.norm(hands[1] - hands[0]) > WIDEST_M:
        return []
    half = np.clip(np.cbrt(load_kg / KG_PER_M3), SMALLEST_M, LARGEST_M) / 2
    middle = hands.mean(axis=0)
    faces = [(_corners(axis, side) * half + middle, colour) for (axis, side), colour in FACES]
    ordered = sorted(
        ((seen(corners), colour) for corners, colour in faces), key=lambda face: float(face[0][:, 2].mean())
    )
    near = float(seen(middle)[2])
    edge = 'stroke="#8a6b3d" stroke-width="1" stroke-linejoin="round"'
    shown = [f'<path d="{polygon(corners[:, :2])}" fill="{colour}" {edge}/>' for corners, colour in ordered]
    return [(near, "".join(shown))]


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
