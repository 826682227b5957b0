"""RULA, REBA and OWAS: a posture's scores as intervals, and what drives them.

RULA of one posture and arm, from angles and flags that somebody has read off.

Source: McAtamney & Corlett 1993, RULA: a survey method for the investigation of work-related upper limb disorders,
Applied Ergonomics 24(2), 91-99. An angle on the edge of two bands takes the lower score. Forks: ``options.py``.
"""

from __future__ import annotations

from dataclasses import dataclass

from opsim.ergonomics.options import CHOICES, PAPER, Thresholds
from opsim.ergonomics.scores.scoring import angles_checked, choice_checked
from opsim.ergonomics.scores.tables import RULA_A, RULA_B, RULA_C, rula_force, rula_level
from opsim.subjects.exposure.plan import FORCES


@dataclass(frozen=True, slots=True)
class Rula:
    """Every sub-score on the way to ``grand`` (1-7) and its action level (1-4)."""

    upper_arm: int
    lower_arm: int
    wrist: int
    wrist_twist: int
    neck: int
    trunk: int
    legs: int
    muscle_use: int
    force: int
    table_a: int
    table_b: int
    score_c: int
    score_d: int
    grand: int
    action_level: int


def rula(
    *,
    upper_arm_flex: float,
    elbow_flex: float,
    wrist_flex: float,
    neck_flex: float,
    trunk_flex: float,
    shoulder_raised: bool = False,
    upper_arm_abducted: bool = False,
    arm_supported: bool = False,
    across_midline_or_out: bool = False,
    wrist_deviated: bool = False,
    wrist_twist: int = 1,
    neck_twisted: bool = False,
    neck_side_bent: bool = False,
    trunk_twisted: bool = False,
    trunk_side_bent: bool = False,
    seated_supported: bool = False,
    legs_supported: bool = True,
    muscle_use: bool = False,
    force_kg: float = 0.0,
    force_pattern: str = "intermittent",
    table_a: str = "published",
    force_rule: str = "paper",
    thresholds: Thresholds = PAPER,
) -> Rula:
    """RULA of one arm and the body. Angles in degrees, flexion positive, extension negative; flags as the paper asks.

    seated_supported : sits well supported, hip and trunk at 90 degrees or more: trunk 1
    wrist_twist      : 1 mid range, 2 near the end of the range
    muscle_use       : held mostly still for more than a minute, or repeated four times a minute and more
    Raises ValueError that lists every angle that is no number and every word that is unknown.
    """
    angles_checked(
        upper_arm_flex=upper_arm_flex,
        elbow_flex=elbow_flex,
        wrist_flex=wrist_flex,
        neck_flex=neck_flex,
        trunk_flex=trunk_flex,
        force_kg=force_kg,
        words=(
            *choice_checked("table_a", table_a, CHOICES["rula_table_a"]),
            *choice_checked("force_rule", force_rule, CHOICES["rula_force"]),
            *choice_checked("force_pattern", force_pattern, FORCES),
            *choice_checked("wrist_twist", wrist_twist, (1, 2)),
        ),
    )
    raised = bool(shoulder_raised) + bool(upper_arm_abducted) - bool(arm_supported)
    leaning = bool(trunk_twisted) + bool(trunk_side_bent)
    codes = {
        "upper_arm": max(1, upper_arm_score(upper_arm_flex) + raised),
        "lower_arm": lower_arm_score(elbow_flex) + bool(across_midline_or_out),
        "wrist": wrist_score(wrist_flex, thresholds.wrist_straight) + bool(wrist_deviated),
        "wrist_twist": int(wrist_twist),
        "neck": neck_score(neck_flex, thresholds.neck_extended) + bool(neck_twisted) + bool(neck_side_bent),
        "trunk": (1 if seated_supported else trunk_score(trunk_flex, thresholds.trunk_upright)) + leaning,
        "legs": 1 if legs_supported else 2,
    }
    return _grand(codes, int(bool(muscle_use)), rula_force(force_kg, force_pattern, force_rule), table_a)


def _grand(codes: dict[str, int], muscle_use: int, force: int, table_a: str) -> Rula:
    upper_arm, lower_arm, wrist, wrist_twist, neck, trunk, legs = (code - 1 for code in codes.values())
    a, b = int(RULA_A[table_a][upper_arm, lower_arm, wrist, wrist_twist]), int(RULA_B[neck, trunk, legs])
    c, d = a + muscle_use + force, b + muscle_use + force
    grand = int(RULA_C[min(c, 8) - 1, min(d, 7) - 1])
    level = rula_level(grand).number
    return Rula(**codes, muscle_use=muscle_use, force=force, table_a=a, table_b=b, score_c=c, score_d=d, grand=grand,
                action_level=level)  # fmt: skip


def upper_arm_score(flexion: float) -> int:
    """1 within 20 degrees of hanging; 2 extended further, or to 45; 3 to 90; 4 above.

    Nobody's arm extends by more than 90 degrees: such an angle is an arm overhead that leans back.
    """
    if abs(flexion) <= 20:
        return 1
    if -90 <= flexion <= 45:
        return 2
    return 3 if 0 < flexion <= 90 else 4


def lower_arm_score(elbow: float) -> int:
    """1 from 60 to 100 degrees, else 2."""
    return 1 if 60 <= elbow <= 100 else 2


def wrist_score(flexion: float, straight: float = 0.0) -> int:
    """1 straight, 2 to 15 degrees either way, 3 beyond."""
    return 1 if abs(flexion) <= straight else 2 if abs(flexion) <= 15 else 3


def neck_score(flexion: float, extended: float = 0.0) -> int:
    """1 to 10 degrees, 2 to 20, 3 above, 4 extended."""
    if flexion < -extended:
        return 4
    return 1 if flexion <= 10 else 2 if flexion <= 20 else 3


def trunk_score(flexion: float, upright: float = 0.0) -> int:
    """1 upright, 2 to 20 degrees, 3 to 60, 4 above. The paper draws no extension: it counts as flexion of its size."""
    size = abs(flexion)
    return 1 if size <= upright else 2 if size <= 20 else 3 if size <= 60 else 4
