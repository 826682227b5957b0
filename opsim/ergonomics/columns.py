"""The measures of a posture, a column each: the one order in which arrays (..., COLUMNS) hold them."""

from __future__ import annotations

ANGLES = (
    *("trunk_flexion", "trunk_side", "trunk_twist", "neck_flexion", "neck_side"),
    *(f"{side}_{angle}" for angle in ("arm_flexion", "arm_abduction", "arm_elevation") for side in ("left", "right")),
    *(f"{side}_{angle}" for angle in ("elbow", "wrist", "knee") for side in ("left", "right")),
)
"""Degrees; nan where a posture does not have one. Arm flexion and abduction are against ``Options.arm_reference``,
arm elevation is always against gravity; the rest as ``angles.py``. Neck flexion is less the neutral of the body."""
LENGTHS = (
    *("left_elbow_above_m", "right_elbow_above_m"),
    *("left_across_m", "right_across_m", "left_outside_m", "right_outside_m"),
    *(
        "left_hand_up_m",
        "right_hand_up_m",
        "hands_forward_m",
        "hands_left_m",
        "left_ankle_up_m",
        "right_ankle_up_m",
        "pelvis_up_m",
    ),
)
"""Metres: elbow above its shoulder; hand beyond the midline, and outside its own shoulder, both in the trunk's frame;
hands above the floor (the lowest foot), the middle of the hands forward and to the left of the middle of the ankles, in
the body's frame (level); ankles and pelvis above the floor. The wrist stands for a hand that is missing."""
COLUMNS = (*ANGLES, *LENGTHS)
AT = {name: place for place, name in enumerate(COLUMNS)}
