"""How far an upper arm is from hanging, and whether it is behind the trunk."""

from __future__ import annotations

import numpy as np

from opsim.ergonomics.columns import AT

BEHIND_DEG = 5.0
"""An elbow so far behind the plane of its trunk is behind it, for how a neutral is measured. Source: design."""


def arm_angle_deg(measures: np.ndarray, side: str) -> np.ndarray:
    """(N,) elevation of the upper arm of a side, ``left`` or ``right``, from measures (N, COLUMNS); less than 0 behind
    the trunk.

    Behind is where flexion is backward, not beyond level, and the arm leaves the plane of the trunk by more than
    ``BEHIND_DEG``: sin = cos(abduction) sin(flexion). The sign of flexion alone would turn arms around that are held to
    the side, by a wink of noise. Where flexion or abduction is not known, arms are taken as before the trunk.
    """
    at = {name: np.asarray(measures[:, AT[f"{side}_arm_{name}"]], float) for name in ("flexion", "abduction")}
    flexion, elevation = at["flexion"], np.asarray(measures[:, AT[f"{side}_arm_elevation"]], float)
    out_of_plane = np.cos(np.deg2rad(at["abduction"])) * np.sin(np.deg2rad(flexion))
    behind = (flexion > -90.0) & (out_of_plane < -np.sin(np.deg2rad(BEHIND_DEG)))
    return np.where(behind, -elevation, elevation)
