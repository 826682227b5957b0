"""The table of a run: a row a figure, a column a variant."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_ALWAYS = ("work", "blocked", "loaded")
_WHERE_LARGE = {
    "station_states": (
        *("setup", "down", "repair", "parts", "tool", "place", "pickup", "away", "takt", "line_stop", "pause"),
        "waiting",
    ),
    "worker_states": ("setup", "walk", "held", "behind", "team", "tool", "absent"),
}
"""States beside those of ``_ALWAYS``, shown where some variant has more of them than ``_LARGE``; the report has all."""
_LARGE = 0.05
_BY_STOP = (
    *("stops_per_h", "down_s", "wait_for_repair_s", "stop_share"),
    *("incomplete_share", "line_stopped_share", "handoff_position", "experience"),
)
Cells = dict[str, dict[str, Any]]


def print_results(title: str, results: dict[str, Any]) -> None:
    """One row a figure, one column a variant; of states those that matter (``_ALWAYS``, ``_WHERE_LARGE``)."""
    from opsim.cli.console import print_table
    from opsim.report.parts import part_name
    from opsim.report.words import kpi_name, largest_mean, plus_minus

    hours = any("scheduled_h" in result.summary for result in results.values())
    found: dict[str, dict[tuple[str, str], Cells]] = {}
    for name, result in results.items():
        for row in result.summary["kpis"]:
            if row["headline"]:
                found.setdefault(row["kpi"], {}).setdefault((row["subject"], row["part"]), {})[name] = row
    rows = []
    for kpi, by_subject in found.items():
        kept = {of: c for of, c in by_subject.items() if matters(kpi, of[1], c) and not _says_again(of, by_subject)}
        largest = largest_mean(row for cells in kept.values() for row in cells.values())
        for of, cells in kept.items():
            texts = [plus_minus(cells[name], largest) if name in cells else "" for name in results]
            named = of[0], part_name(kpi, of[1])
            rows.append((kpi_name(kpi, hours), " ".join(filter(None, named)), *texts))
    heading = _heading(title, [result.summary for result in results.values()])
    print_table(heading, ("figure", "of", *results), without_repeats(rows), words=2)


def matters(kpi: str, part: str, cells: Mapping[str, Mapping[str, Any]]) -> bool:
    """Whether a row is shown. cells : by variant, the row of its summary."""
    from opsim.report.parts import SHOWN_WHERE_ANY, is_shown

    if not part or part in _ALWAYS or kpi in _BY_STOP:
        return True
    if kpi.startswith("exposure_by_") and part.endswith("_at_most"):
        return False
    if kpi in SHOWN_WHERE_ANY:
        return is_shown(kpi, part, cells.values())
    return part in _WHERE_LARGE.get(kpi, ()) and any((row["mean"] or 0) > _LARGE for row in cells.values())


def _says_again(of: tuple[str, str], found: Mapping[tuple[str, str], Cells]) -> bool:
    """Whether a row is one of at most that is the same as at least in all variants."""
    from opsim.report.parts import says_again

    own = {part: cells for (subject, part), cells in found.items() if subject == of[0]}
    beside = {part: [cells.get(name, {}) for name in found[of]] for part, cells in own.items()}
    return says_again(of[1], list(found[of].values()), beside)


def without_repeats(rows: list[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Rows whose first cell is left out where it is that of the row above."""
    return [("", *row[1:]) if i and row[0] == rows[i - 1][0] else row for i, row in enumerate(rows)]


def _heading(title: str, summaries: list[dict[str, Any]]) -> str:
    counts = sorted({summary["replications"] for summary in summaries})
    count = " to ".join(str(n) for n in dict.fromkeys((counts[0], counts[-1])))
    noun = "replication" if counts == [1] else "replications"
    first = summaries[0]
    return f"{title}: {count} {noun}, seed {first['seed']}, mean ± half-width of the {first['confidence']:.0%} interval"
