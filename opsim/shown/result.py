"""Results in a notebook: what was run, and its figures with their intervals."""

from __future__ import annotations

from typing import Any

from opsim.results import Result
from opsim.shown.html import count, sentence, table


def result_html(result: Result) -> str:
    """A sentence and the headline figures; of other results all."""
    said = result.summary
    rows = said["kpis"]
    front = [row for row in rows if row.get("headline")] or rows
    words = (
        f"{said.get('scenario', result.folder.name)}, variant {said.get('variant', '')}: "
        f"{count(said['replications'], 'replication')}, seed {said['seed']}."
    )
    columns = ("figure", "of", "part", "mean", "±", "unit")
    return sentence("Result:", words) + table(columns, [_row(row) for row in front])


def _row(row: dict[str, Any]) -> tuple[object, ...]:
    return row["kpi"], row["subject"], row["part"], row["mean"], row["half_width"], row["unit"]
