"""Joints by their canonical names."""

from collections.abc import Sequence

import numpy as np

from opsim.problems import did_you_mean, shown

_TRUNK = ("pelvis", "spine", "chest", "neck", "head")
_ARM = ("shoulder", "elbow", "wrist", "hand")
_LEG = ("hip", "knee", "ankle", "toe")
CANONICAL = (
    *_TRUNK,
    *(f"{side}_{joint}" for limb in (_ARM, _LEG) for side in ("left", "right") for joint in limb),
)
"""The joints that angles are made of: trunk, left arm, right arm, left leg, right leg."""

SIDES = ("left", "right")
"""Their order along an axis of length 2."""


def joints_m(positions_m: np.ndarray, names: Sequence[str], *wanted: str) -> tuple[np.ndarray, ...]:
    """The positions (..., 3) of some joints out of (..., J, 3), which are named by ``names`` (J,).

    Raises ValueError that names every joint that is missing, with the nearest that is there.
    """
    positions_m, known = np.asarray(positions_m, dtype=float), list(names)
    if positions_m.shape[-2:] != (len(known), 3):
        raise ValueError(f"positions of {len(known)} joints must be (..., {len(known)}, 3), found {positions_m.shape}")
    missing = [f"no joint {shown(name)}; {did_you_mean(name, known)}" for name in wanted if name not in known]
    if missing:
        raise ValueError("\n".join(missing))
    return tuple(positions_m[..., known.index(name), :] for name in wanted)


def both_sides_m(positions_m: np.ndarray, names: Sequence[str], joint: str) -> np.ndarray:
    """The positions (..., 2, 3) of a joint of the limbs, left and right. Raises ValueError as ``joints_m``."""
    return np.stack(joints_m(positions_m, names, *(f"{side}_{joint}" for side in SIDES)), axis=-2)
