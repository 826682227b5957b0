"""A made body: joint positions by forward kinematics, limbs placed by two-bone reach. For synthetic tasks only.

Facing x, left is y, up is z. Lengths are those of a person 1.75 m tall; the body scales them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.skeleton import CANONICAL

STATURE_M = 1.75
SIDES = (("left", 1.0), ("right", -1.0))
REST = {
    "pelvis": np.array([0.0, 0.0, 0.968]),
    "pitch": np.array([0.03]),
    "lean": np.array([0.0]),
    "twist": np.array([0.0]),
    "nod": np.array([0.10]),
    "look": np.array([0.0]),
    "left_wrist": np.array([0.08, 0.25, 0.885]),
    "right_wrist": np.array([0.08, -0.25, 0.885]),
    "left_ankle": np.array([0.0, 0.11, 0.08]),
    "right_ankle": np.array([0.0, -0.11, 0.08]),
    "left_toe": np.array([0.0]),
    "right_toe": np.array([0.0]),
}
"""Standing at rest. Metres of the average body in the frame of the floor; radians. pitch, lean, twist turn the trunk,
nod and look the head beyond it; left_toe and right_toe pitch the foot, positive with the toes down."""
_ELBOW_POLE = np.array([-0.45, 0.55, -0.75])
_KNEE_POLE = np.array([1.0, 0.18, 0.0])
_STRAIGHT = 0.999
_SOFT = 0.90
Fields = dict[str, np.ndarray]


@dataclass(frozen=True)
class Body:
    """One person: stature in metres and the ratios of arms and legs to the average person's of that stature."""

    stature_m: float = STATURE_M
    arm: float = 1.0
    leg: float = 1.0

    @property
    def scale(self) -> float:
        return self.stature_m / STATURE_M


def joints_m(pose: dict[str, np.ndarray], body: Body) -> np.ndarray:
    """Joint positions (T, 21, 3) in metres, in canonical order, from the fields of ``REST``, each (T, 3) or (T, 1).

    A wrist or ankle out of reach is approached along the straight line to 99.9 % of the limb.
    """
    rise = np.array([0.0, 0.0, (body.leg - 1) * 0.85])
    place = {"pelvis": pose["pelvis"] + rise}
    trunk = _turn(pose["pitch"], pose["lean"], pose["twist"])
    _trunk(place, pose, trunk)
    for side, sign in SIDES:
        _arm(place, side, sign, trunk, pose[f"{side}_wrist"] + rise, body.arm)
        _leg(place, side, sign, pose[f"{side}_ankle"], pose[f"{side}_toe"][..., 0], body.leg)
    return np.stack([place[name] for name in CANONICAL], axis=-2) * body.scale


def _trunk(place: Fields, pose: Fields, trunk: np.ndarray) -> None:
    low = _turn(0.6 * pose["pitch"], 0.6 * pose["lean"], 0.4 * pose["twist"])
    head = _turn(pose["pitch"] + pose["nod"], pose["lean"], pose["twist"] + pose["look"])
    place["spine"] = place["pelvis"] + low @ np.array([0.0, 0.0, 0.11])
    place["chest"] = place["spine"] + trunk @ np.array([0.0, 0.0, 0.16])
    place["neck"] = place["chest"] + trunk @ np.array([0.0, 0.0, 0.23])
    place["head"] = place["neck"] + head @ np.array([0.03, 0.0, 0.16])


def _arm(
    place: dict[str, np.ndarray], side: str, sign: float, trunk: np.ndarray, wrist: np.ndarray, ratio: float
) -> None:
    mirror = np.array([1.0, sign, 1.0])
    shoulder = place["chest"] + trunk @ (mirror * [0.0, 0.19, 0.17])
    wrist = soft_target(shoulder, wrist, 0.55 * ratio)
    elbow, wrist = two_bones(shoulder, wrist, 0.29 * ratio, 0.26 * ratio, trunk @ (mirror * _ELBOW_POLE))
    hand = wrist + 0.085 * ratio * _unit(wrist - elbow)
    place |= {
        f"{side}_{joint}": at
        for joint, at in zip(("shoulder", "elbow", "wrist", "hand"), (shoulder, elbow, wrist, hand))
    }


def soft_target(start: np.ndarray, target: np.ndarray, length: float) -> np.ndarray:
    """Targets (T, 3), those beyond ``_SOFT`` of a limb's length drawn in smoothly: a limb never locks straight."""
    apart = target - start
    distance = np.linalg.norm(apart, axis=-1, keepdims=True) / length
    room = _STRAIGHT - _SOFT
    soft = _SOFT + room * -np.expm1(-np.maximum(distance - _SOFT, 0.0) / room)
    return start + apart * np.where(distance > _SOFT, soft / np.maximum(distance, 1e-12), 1.0)


def _leg(
    place: dict[str, np.ndarray], side: str, sign: float, ankle: np.ndarray, toe_pitch: np.ndarray, ratio: float
) -> None:
    mirror = np.array([1.0, sign, 1.0])
    hip = place["pelvis"] + mirror * [0.0, 0.10, -0.05]
    knee, ankle = two_bones(hip, ankle, 0.43 * ratio, 0.41 * ratio, np.broadcast_to(mirror * _KNEE_POLE, hip.shape))
    toe = ankle + np.stack(
        [0.16 * np.cos(toe_pitch + 0.36), sign * 0.03 + 0 * toe_pitch, -0.16 * np.sin(toe_pitch + 0.36)], -1
    )
    _put(place, side, hip=hip, knee=knee, ankle=ankle, toe=toe)


def _put(place: Fields, side: str, **joints: np.ndarray) -> None:
    for joint, at in joints.items():
        place[f"{side}_{joint}"] = at


def two_bones(
    start: np.ndarray, target: np.ndarray, upper: float, lower: float, pole: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Middle joint and end (T, 3) of a limb from ``start`` towards ``target``, its middle joint bent towards ``pole``.

    The end is the target where the limb can reach it, else the point 99.9 % of the limb's length away on the way there.
    """
    along = _unit(target - start)
    reach = np.clip(np.linalg.norm(target - start, axis=-1), abs(upper - lower) + 0.02, _STRAIGHT * (upper + lower))
    fore = (upper**2 - lower**2 + reach**2) / (2 * reach)
    side = _unit(pole - np.sum(pole * along, axis=-1, keepdims=True) * along)
    height = np.sqrt(np.maximum(upper**2 - fore**2, 0.0))
    return start + fore[:, None] * along + height[:, None] * side, start + reach[:, None] * along


def _turn(pitch: np.ndarray, lean: np.ndarray, twist: np.ndarray) -> np.ndarray:
    """(T, 3, 3): twist about z, after pitch about y (forward), after lean about x, from angles (T, 1)."""
    (cp, sp), (cl, sl), (ct, st) = ((np.cos(a[..., 0]), np.sin(a[..., 0])) for a in (pitch, lean, twist))
    rows = [
        [ct * cp, -st * cl + ct * sp * sl, st * sl + ct * sp * cl],
        [st * cp, ct * cl + st * sp * sl, -ct * sl + st * sp * cl],
        [-sp, cp * sl, cp * cl],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
