"""The published tables of RULA, REBA and OWAS. A code counts from 1, so a table is asked at codes less one.

Sources: McAtamney & Corlett 1993, RULA, Applied Ergonomics 24(2), 91-99; Hignett & McAtamney 2000, REBA, Applied
Ergonomics 31, 201-205; Karhu, Kansi & Kuorinka 1977, OWAS, Applied Ergonomics 8, 199-201, with the action categories of
Louhevaara & Suurnakki 1992. Every cell agrees with at least two public transcriptions.
All tables of RULA and REBA rise with each of their codes. OWAS rises with arms and load only. It falls from a bent
back (2) to a twisted one (3) in 35 cells, and with the legs in 47: from sitting (1) to standing (2) in 13, from one
bent knee (5) to kneeling (6) in 19, from kneeling to walking (7) in 15. Its interval is therefore taken over every code
that a posture may have.

What the papers say is to be done about a score: action levels with their words.

Loads in kilograms, in both hands together, as the methods count them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opsim.problems import did_you_mean, shown
from opsim.subjects.exposure.plan import FORCES


def _table(text: str, *shape: int) -> np.ndarray:
    """Digits in the order of reading, spaces between groups; read only."""
    table = np.array([int(digit) for digit in "".join(text.split())], np.int8).reshape(shape)
    table.flags.writeable = False
    return table


RULA_A = {
    "published": _table(
        """12 22 23 33  22 22 33 33  23 33 33 44
           23 33 34 44  33 33 34 44  34 44 44 55
           33 44 44 55  34 44 44 55  44 44 45 55
           44 44 45 55  44 44 45 55  44 45 55 66
           55 55 56 67  56 66 67 77  66 67 77 78
           77 77 78 89  88 88 89 99  99 99 99 99""",
        *(6, 3, 4, 2),
    ),
    "worksheet2000": _table(
        """12 22 23 33  22 22 33 33  23 23 33 44
           22 23 33 44  22 23 33 44  23 33 34 45
           23 33 44 55  23 33 44 55  23 34 44 55
           34 44 44 55  34 44 44 55  34 45 55 66
           55 55 56 67  56 66 67 77  66 67 77 78
           77 77 78 89  78 88 89 99  99 99 99 99""",
        *(6, 3, 4, 2),
    ),
}
"""[upper arm 1-6][lower arm 1-3][wrist 1-4][wrist twist 1-2]. In the worksheet of 2000 31 of 144 cells are
lower, 30 by 1 and one by 2: perhaps the table as first printed in 1993, which nobody here has seen."""
RULA_B = _table(
    """13 23 34 55 66 77
       23 23 45 55 67 77
       33 34 45 56 67 77
       55 56 67 77 77 88
       77 77 78 88 88 88
       88 88 88 89 99 99""",
    *(6, 6, 2),
)
"""[neck 1-6][trunk 1-6][legs 1-2]."""
RULA_C = _table("1233455 2234455 3334456 3334566 4445677 4456677 5566777 5567777", 8, 7)
"""[score C, 8 and more the same][score D, 7 and more the same]."""
REBA_A = _table(
    """1234 2345 2456 3567 4678
       1234 3456 4567 5678 6789
       3356 4567 5678 6789 7899""",
    *(3, 5, 4),
)
"""[neck 1-3][trunk 1-5][legs 1-4]."""
REBA_B = _table("122 123  123 234  345 455  455 567  678 788  788 899", 6, 2, 3)
"""[upper arm 1-6][lower arm 1-2][wrist 1-3]."""
REBA_C = np.array(
    [
        [1, 1, 1, 2, 3, 3, 4, 5, 6, 7, 7, 7],
        [1, 2, 2, 3, 4, 4, 5, 6, 6, 7, 7, 8],
        [2, 3, 3, 3, 4, 5, 6, 7, 7, 8, 8, 8],
        [3, 4, 4, 4, 5, 6, 7, 8, 8, 9, 9, 9],
        [4, 4, 4, 5, 6, 7, 8, 8, 9, 9, 9, 9],
        [6, 6, 6, 7, 8, 8, 9, 9, 10, 10, 10, 10],
        [7, 7, 7, 8, 9, 9, 9, 10, 10, 11, 11, 11],
        [8, 8, 8, 9, 10, 10, 10, 10, 10, 11, 11, 11],
        [9, 9, 9, 10, 10, 10, 11, 11, 11, 12, 12, 12],
        [10, 10, 10, 11, 11, 11, 11, 12, 12, 12, 12, 12],
        [11, 11, 11, 11, 12, 12, 12, 12, 12, 12, 12, 12],
        [12, 12, 12, 12, 12, 12, 12, 12, 12, 12, 12, 12],
    ],
    np.int8,
)
"""[score A 1-12][score B 1-12]."""
REBA_C.flags.writeable = False
OWAS = _table(
    """111 111 111 222 222 111 111  111 111 111 222 222 111 111  111 111 111 223 223 111 112
       223 223 223 333 333 222 233  223 223 233 344 344 334 234  334 223 333 344 444 444 234
       111 111 112 333 444 111 111  223 111 112 444 444 333 111  223 111 233 444 444 444 111
       233 223 223 444 444 444 234  334 234 334 444 444 444 234  444 234 334 444 444 444 234""",
    *(4, 3, 7, 3),
)
"""[back 1-4][arms 1-3][legs 1-7][load 1-3]."""
OWAS_ALTERNATIVES = {"3373": 2, "4132": 3}
"""Codes for which one transcription, and what was copied from it, has another category than all others."""


def owas_table(disputed: tuple[str, ...] = ()) -> np.ndarray:
    """OWAS, (4, 3, 7, 3), with the alternative category of some disputed codes. Raises KeyError for another code."""
    table = OWAS.copy()
    for code in disputed:
        table[tuple(int(digit) - 1 for digit in code)] = OWAS_ALTERNATIVES[code]
    return table


@dataclass(frozen=True, slots=True)
class Level:
    """An action level or category: its number, the scores from ``least`` to ``most``, and the published words."""

    number: int
    least: int
    most: int
    text: str


RULA = (
    Level(1, 1, 2, "acceptable if not maintained or repeated for long periods"),
    Level(2, 3, 4, "further investigation, changes may be required"),
    Level(3, 5, 6, "investigation and changes required soon"),
    Level(4, 7, 7, "investigation and changes required immediately"),
)
"""McAtamney & Corlett 1993, Applied Ergonomics 24(2), 91-99."""
REBA = (
    Level(0, 1, 1, "negligible risk, no action necessary"),
    Level(1, 2, 3, "low risk, action may be necessary"),
    Level(2, 4, 7, "medium risk, action necessary"),
    Level(3, 8, 10, "high risk, action necessary soon"),
    Level(4, 11, 15, "very high risk, action necessary now"),
)
"""Hignett & McAtamney 2000, Applied Ergonomics 31, 201-205."""
OWAS_LEVELS = (
    Level(1, 1, 1, "normal, no action"),
    Level(2, 2, 2, "slightly harmful, action in the near future"),
    Level(3, 3, 3, "distinctly harmful, action as soon as possible"),
    Level(4, 4, 4, "extremely harmful, action immediately"),
)
"""Karhu, Kansi & Kuorinka 1977, Applied Ergonomics 8, 199-201; its categories are scores themselves."""


def rula_level(score: int) -> Level:
    """The action level (1-4) of a RULA grand score of 1-7. Raises ValueError for another."""
    return _level(RULA, "RULA", score)


def reba_level(score: int) -> Level:
    """The action level (0-4) of a REBA score of 1-15. Raises ValueError for another."""
    return _level(REBA, "REBA", score)


def owas_level(category: int) -> Level:
    """The action category (1-4) of OWAS itself, with its words. Raises ValueError for another."""
    return _level(OWAS_LEVELS, "OWAS", category)


def _level(levels: tuple[Level, ...], method: str, score: int) -> Level:
    for level in levels:
        if level.least <= score <= level.most and score == int(score):
            return level
    raise ValueError(f"{method}: no score {shown(score)}, expected {levels[0].least} to {levels[-1].most}")


RULES = ("paper", "worksheet")


def rula_force(load_kg: float, pattern: str = "intermittent", rule: str = "paper") -> int:
    """RULA's force score: 0 less than 2 kg; 1 from 2 to 10 kg now and then; 2 from 2 to 10 kg static or repeated, or
    more than 10 kg now and then; 3 more than 10 kg static or repeated, or a shock of any size.

    pattern : ``intermittent``, ``repeated``, ``static`` or ``shock``
    rule    : ``paper``, or ``worksheet``, by which more than 10 kg is always 3
    Raises ValueError for an unknown word, with the nearest. Source: McAtamney & Corlett 1993, fig. 6.
    """
    _known("force", pattern, FORCES)
    _known("rule of force", rule, RULES)
    if pattern == "shock":
        return 3
    if load_kg < 2:
        return 0
    if load_kg > 10 and rule == "worksheet":
        return 3
    return 1 + (load_kg > 10) + (pattern != "intermittent")


def reba_load(load_kg: float, *, shock: bool = False) -> int:
    """REBA's load or force score: 0 less than 5 kg, 1 to 10 kg, 2 above; 1 more for a shock or rapid build up.

    Source: Hignett & McAtamney 2000, table A's load.
    """
    return (load_kg >= 5) + (load_kg > 10) + bool(shock)


def owas_load(load_kg: float) -> int:
    """OWAS's fourth digit: 1 to 10 kg, 2 to 20 kg, 3 above. Source: Karhu, Kansi & Kuorinka 1977."""
    return 1 + (load_kg > 10) + (load_kg > 20)


def _known(what: str, word: str, words: tuple[str, ...]) -> None:
    if word not in words:
        raise ValueError(f"no {what} {shown(word)}; {did_you_mean(word, words)}")
