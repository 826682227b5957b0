"""The parts of a body as it is seen, the far ones first: what films and pictures of single postures draw alike."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from opsim.report.body import STEADY_M

TORSO = -1
"""In place of a joint."""
Shape = tuple[str, Any]
"""("taper", (a, b, radius at a, radius at b)), ("disc", (middle, radius)) or ("inside", corners), all in pixels."""


class Part(NamedTuple):
    """How near it is to the viewer, the number of its colour, the joint that it ends in, and what it is made of."""

    near: float
    colour: int
    joint: int
    shapes: list[Shape]


def body_parts(table: Mapping[str, Any], seen: np.ndarray, often: np.ndarray, px_per_mm: float) -> list[Part]:
    """The parts of the body of ``body.body`` at joints seen (J, 3): x and y in pixels, nearness in metres.

    often : (J, 3) the same of the usual posture: a limb about as near as usual keeps its place in the order
    """
    torso = table["torso"] or [table["root"]]
    here, there = seen[torso, 2].mean(), often[torso, 2].mean()
    parts: list[Part] = []
    for parent, joint, from_mm, to_mm, side in table["bones"]:
        now, then = seen[[parent, joint], 2].mean() - here, often[[parent, joint], 2].mean() - there
        near = (then if abs(now - then) < STEADY_M else now) if side else now - 0.3
        limb = ("taper", (seen[parent, :2], seen[joint, :2], from_mm * px_per_mm, to_mm * px_per_mm))
        parts.append(Part(near, side, joint, [limb]))
    if table["torso"]:
        parts.append(Part(-0.02, 0, TORSO, _rounded(seen[torso, :2], table["torso_mm"] * px_per_mm)))
    if table["head"] >= 0:
        head = seen[table["head"]]
        disc = ("disc", (head[:2], table["head_mm"] * px_per_mm))
        parts.append(Part(head[2] - here, 0, table["head"], [disc]))
    return sorted(parts, key=lambda part: part.near)


def outer_tangents(a: np.ndarray, b: np.ndarray, a_px: float, b_px: float) -> np.ndarray:
    """(4, 2) corners of what lies between two discs: on a, on b, on b again, on a; (0, 2) where one holds the other."""
    far = float(np.hypot(*(b - a)))
    if far <= abs(a_px - b_px) + 1e-6:
        return np.empty((0, 2))
    along, open_rad = np.arctan2(b[1] - a[1], b[0] - a[0]), np.arccos((a_px - b_px) / far)
    ends = ((a, a_px, open_rad), (b, b_px, open_rad), (b, b_px, -open_rad), (a, a_px, -open_rad))
    ways = [(middle, radius, along + turn) for middle, radius, turn in ends]
    return np.array([middle + radius * np.array([np.cos(turn), np.sin(turn)]) for middle, radius, turn in ways])


def _rounded(corners: np.ndarray, round_px: float) -> list[Shape]:
    """A filled outline with round corners: its inside, and a limb along each side."""
    sides = zip(corners, np.roll(corners, -1, axis=0))
    return [("inside", corners), *(("taper", (a, b, round_px, round_px)) for a, b in sides)]
