"""OWAS of one posture: the code of back, arms, legs and load, and its action category.

Source: Karhu, Kansi & Kuorinka 1977, Correcting working postures in industry, Applied Ergonomics 8, 199-201; categories
as in Louhevaara & Suurnakki 1992. The papers give pictures, not angles: from which angle a back is bent, twisted or a
knee bent is ``Thresholds``. An arm is up where its elbow is at the height of its shoulder or above.
"""

from __future__ import annotations

from dataclasses import dataclass

from opsim.ergonomics.options import DISPUTED, Thresholds
from opsim.ergonomics.scores.scoring import angles_checked, choice_checked
from opsim.ergonomics.scores.tables import owas_level, owas_load, owas_table
from opsim.problems import shown

LEGS = {
    1: "sitting",
    2: "standing on both straight legs",
    3: "standing on one straight leg",
    4: "standing or squatting on both bent knees",
    5: "standing or squatting on one bent knee",
    6: "kneeling",
    7: "walking",
}
DIGITS = {"back": 4, "arms": 3, "legs": 7, "load": 3}
"""Digits of a code in their order, and the largest of each."""
USUAL = Thresholds()


@dataclass(frozen=True, slots=True)
class Owas:
    """The digits of a code, and its action category (1-4)."""

    back: int
    arms: int
    legs: int
    load: int
    category: int

    @property
    def code(self) -> str:
        """Back, arms, legs, load: "2121"."""
        return f"{self.back}{self.arms}{self.legs}{self.load}"


def owas(code: str, disputed: tuple[str, ...] = ()) -> Owas:
    """The action category of a code such as "2121". ``disputed``: codes whose alternative category is taken.

    Raises ValueError that says each digit that is wrong, and each code that is not disputed.
    """
    mistakes = [found for one in disputed for found in choice_checked("disputed", one, DISPUTED)]
    text = str(code)
    if len(text) != len(DIGITS) or not (text.isascii() and text.isdigit()):
        mistakes.append(f"code: found {shown(code)}, expected four digits: {', '.join(DIGITS)}")
    else:
        mistakes += [
            f"code {text}: {name} is {digit}, expected 1 to {most}"
            for digit, (name, most) in zip(text, DIGITS.items())
            if not 1 <= int(digit) <= most
        ]
    if mistakes:
        raise ValueError("\n".join(mistakes))
    back, arms, legs, load = (int(digit) for digit in text)
    category = int(owas_table(tuple(disputed))[back - 1, arms - 1, legs - 1, load - 1])
    return Owas(back, arms, legs, load, owas_level(category).number)


def owas_code(
    *,
    trunk_flex: float,
    trunk_side: float = 0.0,
    trunk_twist: float = 0.0,
    arms_up: int = 0,
    left_knee: float = 0.0,
    right_knee: float = 0.0,
    one_legged: bool = False,
    sitting: bool = False,
    walking: bool = False,
    load_kg: float = 0.0,
    thresholds: Thresholds = USUAL,
) -> str:
    """The code of a posture. Angles in degrees; knees 0 for a straight leg; arms_up: how many elbows.

    Kneeling is not to be told from these. A body on both legs, one of them bent, has no picture in the method: here it
    stands on both straight legs (2); ``scoring.py`` also allows for both bent (4).
    Raises ValueError that lists every number that is none or out of its range.
    """
    angles_checked(
        trunk_flex=trunk_flex,
        trunk_side=trunk_side,
        trunk_twist=trunk_twist,
        left_knee=left_knee,
        right_knee=right_knee,
        load_kg=load_kg,
        words=choice_checked("arms_up", arms_up, (0, 1, 2)),
    )
    bent = abs(trunk_flex) >= thresholds.owas_back
    twisted = max(abs(trunk_side), abs(trunk_twist)) >= thresholds.owas_twist
    knees = sum(knee > 180 - thresholds.owas_knee for knee in (left_knee, right_knee))
    legs = 7 if walking else 1 if sitting else _standing(knees, one_legged)
    return f"{1 + bent + 2 * twisted}{1 + arms_up}{legs}{owas_load(load_kg)}"


def _standing(knees_bent: int, one_legged: bool) -> int:
    """On one leg with one knee bent, the bent leg is taken to be the one that is lifted."""
    bent = knees_bent == 2
    return (5 if bent else 3) if one_legged else (4 if bent else 2)
