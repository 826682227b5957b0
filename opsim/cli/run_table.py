"""The table of a run: a row a figure, a column a variant."""

from __future__ import annotations

from typing import Any

_PARTS = ("", "work", "blocked", "loaded", "down", "repair")
"""Of figures that have parts, what is shown; the report has all."""
_BY_STOP = ("stops_per_h", "down_s", "wait_for_repair_s", "stop_share")


def print_results(title: str, results: dict[str, Any]) -> None:
    """One row a figure, one column a variant; of states what stands in ``_PARTS``."""
    from opsim.cli.console import print_table
    from opsim.report.words import kpi_name, largest_mean, plus_minus

    found: dict[str, dict[tuple[str, str], dict[str, Any]]] = {}
    for name, result in results.items():
        for row in result.summary["kpis"]:
            if row["headline"] and (row["part"] in _PARTS or row["kpi"] in _BY_STOP):
                found.setdefault(row["kpi"], {}).setdefault((row["subject"], row["part"]), {})[name] = row
    rows = []
    for kpi, by_subject in found.items():
        largest = largest_mean(row for cells in by_subject.values() for row in cells.values())
        for of, cells in by_subject.items():
            texts = [plus_minus(cells[name], largest) if name in cells else "" for name in results]
            rows.append((kpi_name(kpi), " ".join(filter(None, of)), *texts))
    heading = _heading(title, [result.summary for result in results.values()])
    print_table(heading, ("figure", "of", *results), without_repeats(rows), words=2)


def without_repeats(rows: list[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Rows whose first cell is left out where it is that of the row above."""
    return [("", *row[1:]) if i and row[0] == rows[i - 1][0] else row for i, row in enumerate(rows)]


def _heading(title: str, summaries: list[dict[str, Any]]) -> str:
    counts = sorted({summary["replications"] for summary in summaries})
    count = " to ".join(str(n) for n in dict.fromkeys((counts[0], counts[-1])))
    noun = "replication" if counts == [1] else "replications"
    first = summaries[0]
    return f"{title}: {count} {noun}, seed {first['seed']}, mean ± half-width of the {first['confidence']:.0%} interval"
