"""The variability budget: what each source costs, all together, and what they do to each other.

Each number is a figure with something switched off minus the full one, of the same workforce on the same day. So the
parts and the interaction add up to the whole, workforce by workforce and day by day.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from opsim.results import Key
from opsim.study.compare import ROUNDING
from opsim.study.interval import CONFIDENCE, Interval
from opsim.study.labour.parts import CROSSED
from opsim.study.labour.squares import mean_interval


@dataclass(frozen=True, slots=True)
class FigureBudget:
    """Of one figure: each an interval of "off minus full".

    full, all_off : the figure itself; parts : by source, switched off alone; whole : all off; interaction : whole minus
    the sum of the parts; alone : by source, where asked: what the source changes where it is the only one
    """

    key: Key
    full: Interval
    all_off: Interval
    parts: dict[str, Interval]
    interaction: Interval
    whole: Interval
    alone: dict[str, Interval]


def figure_budget(
    key: Key,
    full: np.ndarray,
    off: Mapping[str, np.ndarray],
    all_off: np.ndarray,
    alone: Mapping[str, np.ndarray] | None = None,
    design: str = CROSSED,
) -> FigureBudget:
    """All arrays (W, R), of the same workforces and days; nan where a figure was not observed."""
    crossed = design == CROSSED
    whole = all_off - full
    changes = {name: table - full for name, table in off.items()}
    left = whole - sum(changes.values(), np.zeros_like(whole))
    return FigureBudget(
        key,
        table_interval(full, crossed),
        table_interval(all_off, crossed),
        {name: difference_interval(table, full, crossed) for name, table in changes.items()},
        difference_interval(left, full, crossed),
        difference_interval(whole, full, crossed),
        {name: difference_interval(all_off - table, full, crossed) for name, table in (alone or {}).items()},
    )


def difference_interval(
    apart_by: np.ndarray, of: np.ndarray, crossed: bool, confidence: float = CONFIDENCE
) -> Interval:
    """Of a table of paired differences; what is only the order in which numbers were added is 0."""
    if np.abs(apart_by).max(initial=0) <= ROUNDING * np.abs(of).max(initial=0):
        apart_by = np.zeros_like(apart_by)
    return table_interval(apart_by, crossed, confidence)


def table_interval(table: np.ndarray, crossed: bool, confidence: float = CONFIDENCE) -> Interval:
    """``mean_interval``, or nan where something is missing: a table with holes is told as not known."""
    if not np.isfinite(table).all():
        return Interval(np.nan, np.nan, np.nan, int(np.count_nonzero(np.isfinite(table))))
    return mean_interval(table, crossed, confidence)
