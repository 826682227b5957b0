"""A comparison in a notebook, and as a table: what differs from the base, and how sure that is."""

from __future__ import annotations

from typing import Any

from opsim.shown.html import sentence, table

COLUMNS = ("variant", "kpi", "subject", "part", "unit", "base", "mean", "difference", "low", "high", "p", "verdict")


def comparison_rows(comparison: Any) -> list[tuple[object, ...]]:
    """A row for each figure of each variant, in the order of ``COLUMNS``."""
    return [
        (
            *(one.variant, *one.key, one.base, one.mean, one.interval.mean, one.interval.low, one.interval.high),
            *(one.p_together, one.verdict),
        )
        for one in comparison.differences
    ]


def comparison_html(comparison: Any) -> str:
    """What is clear stands first."""
    rows = comparison_rows(comparison)
    rows.sort(key=lambda row: row[-1] not in ("higher", "lower"))
    return sentence("Comparison:", f"differences from {comparison.base}, {comparison.pairs}.") + table(COLUMNS, rows)
