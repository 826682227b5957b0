"""A body to be drawn with thickness: round limbs that taper, a torso between shoulders and hips, a head."""

from __future__ import annotations

from typing import Any

from opsim.report.person import LEFT, RIGHT, TORSO

TRUNK = "#9aa2ad"
COLOURS = (TRUNK, LEFT, RIGHT)
HEAD_M, TORSO_M = 0.105, 0.085
OTHER_M = (0.036, 0.032)
STEADY_M = 0.15
"""A limb that is about as far before the torso as it usually is keeps its place in the order of drawing."""
LIMB_M = {
    "neck": (0.06, 0.055),
    "head": (0.055, 0.05),
    "elbow": (0.052, 0.041),
    "wrist": (0.041, 0.029),
    "hand": (0.034, 0.030),
    "fingers": (0.026, 0.018),
    "thumb": (0.020, 0.014),
    "knee": (0.084, 0.058),
    "ankle": (0.058, 0.037),
    "toe": (0.040, 0.032),
    "heel": (0.040, 0.036),
}
"""Radii (m) at both ends of the bone that ends in this joint, of a person of middle size."""


def body(skeleton: Any) -> dict[str, Any]:
    """What a page needs to draw this skeleton, lengths in whole mm.

    bones : rows (parent, child, radius at parent, radius at child, colour number), without those that tie the torso
    torso : four joint numbers round the torso, or none; head : its joint, or -1; feet : joints that throw a shadow
    """
    names, parents = list(skeleton.names), list(skeleton.parents)
    torso = [names.index(name) for name in TORSO] if set(TORSO) <= set(names) else []
    bones = [
        (parent, joint, *(round(1000 * radius) for radius in LIMB_M.get(_joint(names[joint]), OTHER_M)), _side(name))
        for joint, (name, parent) in enumerate(zip(names, parents))
        if parent >= 0 and joint not in torso
    ]
    return {
        "bones": bones,
        "torso": torso,
        "torso_mm": round(1000 * TORSO_M),
        "head": names.index("head") if "head" in names else -1,
        "head_mm": round(1000 * HEAD_M),
        "feet": [i for i, name in enumerate(names) if _joint(name) in ("ankle", "toe", "foot", "heel")],
        "root": parents.index(-1),
        "colours": COLOURS,
    }


def _joint(name: str) -> str:
    return name.removeprefix("left_").removeprefix("right_")


def _side(name: str) -> int:
    return 1 if name.startswith("left_") else 2 if name.startswith("right_") else 0
