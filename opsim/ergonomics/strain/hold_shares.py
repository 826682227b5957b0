"""What share of strength a posture asks, from one angle: the weight of what leans, against the joint that holds it."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.ergonomics.joint_loads.segments import segments_of
from opsim.ergonomics.joint_loads.strength import HEIGHT_M, MASS_KG, strength_nm

G = 9.80665
TRUNK, UPPER_ARM, FOREARM, HEAD = 0.30, 0.186, 0.146, 0.36
"""Shares of body height: hips to neck, shoulder to elbow, elbow to wrist; hips to the centre of the head. Source:
Drillis & Contini 1966, as in Winter, Biomechanics and motor control of human movement, figure 4.1; trunk and head
rounded."""


def hold_share(region: str, angle_deg: np.ndarray | float, body: Any = None) -> np.ndarray:
    """Share of the strength of the back (``trunk``) or a shoulder (``left_arm``, ``right_arm``), 0 to 1, for its angle.

    Statics of a trunk leaning with arms and head, and of one straight arm: a bent elbow asks for less. No load.
    body : mass_kg, height_m, sex, age_years, None where not known
    """
    mass = _said(body, "mass_kg", MASS_KG)
    height, segments = _said(body, "height_m", HEIGHT_M), segments_of(getattr(body, "sex", None))
    arm = segments.upper_arm + segments.forearm + segments.hand
    if region == "trunk":
        lever = TRUNK * (segments.back * segments.back_centre + 2.0 * arm) + HEAD * segments.head
        strength = strength_nm("back", body)
    else:
        lower = FOREARM * (segments.forearm * segments.forearm_centre + segments.hand)
        lever = UPPER_ARM * (segments.upper_arm * segments.upper_arm_centre + segments.forearm + segments.hand) + lower
        strength = strength_nm("shoulder", body)
    turning = np.abs(np.sin(np.deg2rad(np.asarray(angle_deg, float))))
    return np.minimum(G * mass * height * lever * turning / strength, 1.0)


def _said(body: Any, name: str, otherwise: float) -> float:
    said = getattr(body, name, None)
    return otherwise if said is None else float(said)
