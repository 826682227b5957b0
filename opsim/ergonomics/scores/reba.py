"""REBA of one posture and arm, from angles and flags that somebody has read off.

Source: Hignett & McAtamney 2000, Rapid entire body assessment (REBA), Applied Ergonomics 31, 201-205. Twisting and side
bending add 1 together, as in the paper (some worksheets add 1 each). An angle on the edge of two bands takes the lower
score; a knee counts from 30 degrees.
"""

from __future__ import annotations

from dataclasses import dataclass

from opsim.ergonomics.options import PAPER, Thresholds
from opsim.ergonomics.scores.rula import lower_arm_score, trunk_score, upper_arm_score, wrist_score
from opsim.ergonomics.scores.scoring import angles_checked, choice_checked
from opsim.ergonomics.scores.tables import REBA_A, REBA_B, REBA_C, reba_level, reba_load


@dataclass(frozen=True, slots=True)
class Reba:
    """Every sub-score on the way to ``score_c``, to ``reba`` (1-15) and its action level (0-4)."""

    neck: int
    trunk: int
    legs: int
    upper_arm: int
    lower_arm: int
    wrist: int
    load: int
    coupling: int
    activity: int
    table_a: int
    table_b: int
    score_a: int
    score_b: int
    score_c: int
    reba: int
    action_level: int


def reba(
    *,
    neck_flex: float,
    trunk_flex: float,
    upper_arm_flex: float,
    elbow_flex: float,
    wrist_flex: float,
    knee_flex: float = 0.0,
    neck_twisted: bool = False,
    neck_side_bent: bool = False,
    trunk_twisted: bool = False,
    trunk_side_bent: bool = False,
    bilateral: bool = True,
    sitting: bool = False,
    upper_arm_abducted_or_rotated: bool = False,
    shoulder_raised: bool = False,
    arm_supported: bool = False,
    wrist_dev_or_twisted: bool = False,
    load_kg: float = 0.0,
    shock: bool = False,
    coupling: int = 0,
    activity: int = 0,
    thresholds: Thresholds = PAPER,
) -> Reba:
    """REBA of one arm and the body. Angles in degrees, flexion positive, extension negative; flags as the paper asks.

    knee_flex : of the knee that is bent more; not asked for where the body sits
    coupling  : 0 good, 1 fair, 2 poor, 3 unacceptable
    activity  : 0-3, one each: parts held for more than a minute; repeated more than four times a minute; quick large
                changes or an unstable base
    Raises ValueError that lists every number that is none or out of its range.
    """
    angles_checked(
        neck_flex=neck_flex,
        trunk_flex=trunk_flex,
        upper_arm_flex=upper_arm_flex,
        elbow_flex=elbow_flex,
        wrist_flex=wrist_flex,
        knee_flex=knee_flex,
        load_kg=load_kg,
        words=(
            *choice_checked("coupling", coupling, (0, 1, 2, 3)),
            *choice_checked("activity", activity, (0, 1, 2, 3)),
        ),
    )
    raised = bool(upper_arm_abducted_or_rotated) + bool(shoulder_raised) - bool(arm_supported)
    codes = {
        "neck": reba_neck_score(neck_flex, thresholds.neck_extended) + bool(neck_twisted or neck_side_bent),
        "trunk": reba_trunk_score(trunk_flex, thresholds.trunk_upright) + bool(trunk_twisted or trunk_side_bent),
        "legs": 1 if sitting else 1 + (not bilateral) + knee_score(knee_flex),
        "upper_arm": max(1, upper_arm_score(upper_arm_flex) + raised),
        "lower_arm": lower_arm_score(elbow_flex),
        "wrist": reba_wrist_score(wrist_flex) + bool(wrist_dev_or_twisted),
    }
    return _total(codes, reba_load(load_kg, shock=shock), int(coupling), int(activity))


def _total(codes: dict[str, int], load: int, coupling: int, activity: int) -> Reba:
    neck, trunk, legs, upper_arm, lower_arm, wrist = (code - 1 for code in codes.values())
    a, b = int(REBA_A[neck, trunk, legs]), int(REBA_B[upper_arm, lower_arm, wrist])
    score_a, score_b = min(a + load, 12), b + coupling
    score_c = int(REBA_C[score_a - 1, score_b - 1])
    total = score_c + activity
    level = reba_level(total).number
    return Reba(**codes, load=load, coupling=coupling, activity=activity, table_a=a, table_b=b, score_a=score_a,
                score_b=score_b, score_c=score_c, reba=total, action_level=level)  # fmt: skip


def reba_neck_score(flexion: float, extended: float = 0.0) -> int:
    """1 to 20 degrees, 2 above or extended."""
    return 1 if -extended <= flexion <= 20 else 2


def reba_trunk_score(flexion: float, upright: float = 0.0) -> int:
    """1 upright, 2 to 20 degrees either way, 3 to 60 or extended further, 4 above."""
    return 3 if flexion < -20 else trunk_score(flexion, upright)


def knee_score(flexion: float) -> int:
    """How much a knee adds: 1 from 30 to 60 degrees, 2 above."""
    return (flexion >= 30) + (flexion > 60)


def reba_wrist_score(flexion: float) -> int:
    """1 to 15 degrees either way, 2 beyond."""
    return max(1, wrist_score(flexion) - 1)
