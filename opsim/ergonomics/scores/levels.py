"""What the papers say is to be done about a score: action levels with their words."""

from __future__ import annotations

from dataclasses import dataclass

from opsim.problems import shown


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
OWAS = (
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
    return _level(OWAS, "OWAS", category)


def _level(levels: tuple[Level, ...], method: str, score: int) -> Level:
    for level in levels:
        if level.least <= score <= level.most and score == int(score):
            return level
    raise ValueError(f"{method}: no score {shown(score)}, expected {levels[0].least} to {levels[-1].most}")
