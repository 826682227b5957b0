"""What bodies go through: angles of joints from positions, and how long workers spend in them."""

from importlib import import_module
from typing import Any

_HOMES = {
    "CANONICAL": "opsim.ergonomics.joints",
    "Exposure": "opsim.ergonomics.exposure",
    "NeckAngles": "opsim.ergonomics.angles",
    "TrunkAngles": "opsim.ergonomics.angles",
    "UpperArmAngles": "opsim.ergonomics.angles",
    "Walked": "opsim.ergonomics.walking",
    "body_frame": "opsim.ergonomics.frames",
    "elbow_bend_rad": "opsim.ergonomics.angles",
    "knee_bend_rad": "opsim.ergonomics.angles",
    "neck_angles": "opsim.ergonomics.angles",
    "neck_neutral_rad": "opsim.ergonomics.angles",
    "trunk_angles": "opsim.ergonomics.angles",
    "trunk_exposure": "opsim.ergonomics.exposure",
    "trunk_flexion_rad": "opsim.ergonomics.angles",
    "trunk_frame": "opsim.ergonomics.frames",
    "upper_arm_angles": "opsim.ergonomics.angles",
    "walking_exposure": "opsim.ergonomics.walking",
    "wrist_bend_rad": "opsim.ergonomics.angles",
}
__all__ = [
    "CANONICAL",
    "Exposure",
    "NeckAngles",
    "TrunkAngles",
    "UpperArmAngles",
    "Walked",
    "body_frame",
    "elbow_bend_rad",
    "knee_bend_rad",
    "neck_angles",
    "neck_neutral_rad",
    "trunk_angles",
    "trunk_exposure",
    "trunk_flexion_rad",
    "trunk_frame",
    "upper_arm_angles",
    "walking_exposure",
    "wrist_bend_rad",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"opsim.ergonomics has no {name!r}")
    return getattr(import_module(_HOMES[name]), name)
