"""Rows of the summary as bars: of each subject the minutes at RULA 7, at 5 or more, and at most."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from opsim.report.words import is_number

Row = Mapping[str, Any]
LEVELS = (("rula_from_7", ""), ("rula_from_5", ""), ("rula_from_5", "at_most"))
NOWHERE = "none"
REGION = "exposure_by_region"


@dataclass(frozen=True, slots=True)
class Bar:
    """Minutes of an hour, means over replications. most : at RULA 5 or more, if all that is not said were at its worst

    low, high : interval of ``five``; nan where there is none
    """

    subject: str
    seven: float
    five: float
    most: float
    low: float = float("nan")
    high: float = float("nan")

    @property
    def is_open(self) -> bool:
        """Whether there may be more than is sure."""
        return self.most > self.five + 1e-9


def bars_of_workers(rows: Sequence[Row]) -> list[Bar]:
    """A bar a worker, in their order; none where RULA was not asked for, or never known."""
    found = {(row["kpi"], row["subject"], row["part"]): row for row in rows}
    names = [subject for kpi, subject, part in found if (kpi, part) == ("rula_from_5_min_per_h", "") and subject]
    return _made((name, [found.get((f"{kpi}_min_per_h", name, part)) for kpi, part in LEVELS]) for name in names)


def bar_of_all(rows: Sequence[Row]) -> Bar | None:
    """All workers together, in an hour of all workers' time."""
    found = {(row["kpi"], row["part"]): row for row in rows if not row["subject"]}
    made = _made([("all", [found.get((f"{kpi}_min_per_h", part)) for kpi, part in LEVELS])])
    return made[0] if made else None


def bars_by(rows: Sequence[Row], kpi: str) -> list[Bar]:
    """A bar a subject of ``exposure_by_...``; what is at no station, or with no task, only where it is something."""
    own = {(row["subject"], row["part"]): row for row in rows if row["kpi"] == kpi}
    subjects = dict.fromkeys(subject for subject, _ in own)
    made = _made((s, [own.get((s, "_".join(filter(None, level)))) for level in LEVELS]) for s in subjects)
    return [bar for bar in made if bar.subject != NOWHERE or bar.most > 0]


def bars_of_regions(rows: Sequence[Row]) -> list[Bar]:
    """A bar a region, the longest first, those without any left out; what only may be is not dealt out."""
    own = {(row["subject"], row["part"]): row for row in rows if row["kpi"] == REGION}
    levels = ("rula_from_7", "rula_from_5", "rula_from_5")
    made = _made((s, [own.get((s, level)) for level in levels]) for s in dict.fromkeys(subject for subject, _ in own))
    return sorted((bar for bar in made if bar.five > 0), key=lambda bar: -bar.five)


def _made(found: Any) -> list[Bar]:
    """found : (subject, its rows at RULA 7, at 5 and at most) each; left out where one is not known"""
    return [
        Bar(subject, seven["mean"], five["mean"], max(most["mean"], five["mean"]), *map(_number(five), ("low", "high")))
        for subject, (seven, five, most) in found
        if all(row is not None and is_number(row["mean"]) for row in (seven, five, most))
    ]


def _number(row: Row) -> Callable[[str], float]:
    return lambda edge: row[edge] if is_number(row.get(edge)) else float("nan")
