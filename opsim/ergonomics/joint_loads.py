"""Torques at joints from posture, body and load, as a share of strength.

Torques of gravity about joints, of a body that stands still in each posture, and what share of strength they ask.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from opsim.ergonomics.angles import SIDES
from opsim.ergonomics.anthropometry import MASS_KG, segments_of, strength_nm

G = 9.80665
"""m/s^2."""
JOINTS = ("left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "back", "hips", "knees")
"""The order of the last axis. hips, knees: of one leg, where both carry alike; back: low back, at the hips."""
_STRENGTH = ("shoulder", "shoulder", "elbow", "elbow", "back", "hip", "knee")


class _Hung:
    """Weights that hang on a body, with where they are: (..., 2) level metres, and (...,) kilograms."""

    def __init__(self) -> None:
        self.parts: list[tuple[Any, np.ndarray]] = []

    def add(self, mass_kg: Any, at_m: np.ndarray) -> _Hung:
        self.parts.append((mass_kg, at_m[..., :2]))
        return self

    def about_nm(self, joint_m: np.ndarray) -> np.ndarray:
        """(...,) how strongly they turn about a point."""
        moment = sum(np.asarray(mass)[..., None] * (at - joint_m[..., :2]) for mass, at in self.parts)
        return np.asarray(G * np.linalg.norm(moment, axis=-1))


def torques_nm(
    positions_m: np.ndarray, names: Sequence[str], body: Any = None, load_kg: float | np.ndarray = 0.0
) -> np.ndarray:
    """(..., 7) newton metres by which gravity turns about ``JOINTS``, from joints (..., J, 3) in metres, z up.

    body    : ``mass_kg`` and ``sex``, None where not known (75 kg; the mean of men and women)
    load_kg : (...,) in both hands together, half in each
    nan where the joints that it takes are missing: shoulder, elbow and wrist of an arm; these, neck and pelvis for the
    back and the hips, and hips and knees for the knees. Without a hand what it holds is at the wrist, without a head it
    is at the neck.

    Quasi-static: nothing that is slowed or sped up counts, nor what carries a part of the body; both legs carry alike.
    Source: Chaffin, Andersson & Martin, Occupational Biomechanics, static model; segments: de Leva 1996.
    """
    positions_m = np.asarray(positions_m, dtype=float)
    at = {name: positions_m[..., place, :] for place, name in enumerate(names)}
    nowhere = np.full((*positions_m.shape[:-2], 3), np.nan)

    def joint(*wanted: str) -> np.ndarray:
        return next((at[name] for name in wanted if name in at), nowhere)

    segments = segments_of(getattr(body, "sex", None))
    said = getattr(body, "mass_kg", None)
    mass_kg = MASS_KG if said is None else said
    each_kg = 0.5 * np.asarray(load_kg, dtype=float)
    out = np.empty((*positions_m.shape[:-2], len(JOINTS)))
    above = _Hung()
    for place, side in enumerate(SIDES):
        shoulder, elbow, wrist = (joint(f"{side}_{name}") for name in ("shoulder", "elbow", "wrist"))
        hand = joint(f"{side}_hand", f"{side}_wrist")
        lower = [
            (segments.forearm * mass_kg, elbow + segments.forearm_centre * (wrist - elbow)),
            (segments.hand * mass_kg, wrist + segments.hand_centre * (hand - wrist)),
            (each_kg, hand),
        ]
        arm = [(segments.upper_arm * mass_kg, shoulder + segments.upper_arm_centre * (elbow - shoulder)), *lower]
        out[..., 2 + place] = _sum(lower).about_nm(elbow)
        out[..., place] = _sum(arm).about_nm(shoulder)
        above.parts.extend(_sum(arm).parts)
    pelvis, neck = joint("pelvis"), joint("neck")
    above.add(segments.head * mass_kg, joint("head", "neck"))
    bent = _Hung()
    bent.parts = [*above.parts]
    bent.add(segments.back * mass_kg, pelvis + segments.back_centre * (neck - pelvis))
    out[..., 4] = bent.about_nm(pelvis)
    hips = [joint(f"{side}_hip", "pelvis") for side in SIDES]
    knees = [joint(f"{side}_knee") for side in SIDES]
    middle = 0.5 * (hips[0] + hips[1])
    above.add(segments.trunk * mass_kg, pelvis + segments.trunk_centre * (neck - pelvis))
    out[..., 5] = 0.5 * above.about_nm(middle)
    for hip, knee in zip(hips, knees):
        above.add(segments.thigh * mass_kg, hip + segments.thigh_centre * (knee - hip))
    out[..., 6] = 0.5 * above.about_nm(0.5 * (knees[0] + knees[1]))
    return out


def shares(torque_nm: np.ndarray, body: Any = None) -> np.ndarray:
    """(..., 7) torques of ``JOINTS`` as shares of the strength of a body, 0 to 1."""
    strength = np.array([strength_nm(joint, body) for joint in _STRENGTH])
    return np.minimum(torque_nm / strength, 1.0)


def _sum(parts: list[tuple[Any, np.ndarray]]) -> _Hung:
    hung = _Hung()
    for mass_kg, at_m in parts:
        hung.add(mass_kg, at_m)
    return hung
