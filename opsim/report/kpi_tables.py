"""The figures of a run as tables: those that matter most in sight, the others to unfold by what they are of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from opsim.report.kinds import KINDS, kind_of
from opsim.report.material import Material
from opsim.report.parts import is_shown, part_name, without_again
from opsim.report.posture import SHARES
from opsim.report.section import Block, Folded, Grid, Section, Words
from opsim.report.states_shown import STATE_KPIS
from opsim.report.words import interval_cells, is_number, kpi_name, largest_mean

Row = Mapping[str, Any]
MOST = 10
"""Workers, products or stations of one figure in the table in sight."""
NUMBERS = "Half-width: that of the interval, in per cent of the mean. n: replications that have a value."
CELLS = ("mean", "interval", "unit", "relative", "n")


def section(material: Material) -> Section:
    """Every figure of the summary, each once."""
    summary = material.summary
    shown = without_again([row for row in summary["kpis"] if is_shown(row["kpi"], row.get("part", ""), [row])])
    hours, sure = "scheduled_h" in summary, f"{100 * summary['confidence']:.0f} % interval"
    headline = [row for row in shown if _is_headline(row)]
    others = [row for row in shown if not _is_headline(row)]
    front, folded = in_front(headline)
    first = [_grid("", front, hours, sure)] if front else []
    each = [_grid(f"{kpi_name(kpi, hours)}, each of {len(of)}", of, hours, sure) for kpi, of in folded.items()]
    blocks: list[Block] = [*first, Words(NUMBERS, muted=True), *each, *_groups(others, hours, sure)]
    return Section("figures-table", "What came out", blocks)


def in_front(rows: Sequence[Row]) -> tuple[list[Row], dict[str, list[Row]]]:
    """(rows of the table in sight, by figure those that are folded away): of a figure of many the whole stays.

    Of one that nobody sums over many, the least and the most.
    """
    front: list[Row] = []
    folded: dict[str, list[Row]] = {}
    for kpi in dict.fromkeys(row["kpi"] for row in rows):
        of = [row for row in rows if row["kpi"] == kpi]
        single = [row for row in of if row["subject"]]
        if len(single) > MOST:
            of = [row for row in of if not row["subject"]] or _ends(single)
            folded[kpi] = single
        front += of
    return front, folded


def _ends(rows: Sequence[Row]) -> list[Row]:
    known = sorted((row for row in rows if is_number(row["mean"])), key=lambda row: row["mean"])
    return [known[-1], known[0]] if len(known) > 1 else list(rows[:1])


def _is_headline(row: Row) -> bool:
    return bool(row.get("headline")) and row["kpi"] not in (*STATE_KPIS, SHARES)


def _groups(rows: Sequence[Row], hours: bool, sure: str) -> list[Folded]:
    """By what figures are of, tables to unfold."""
    by_kind = {kind: [row for row in rows if kind_of(row["kpi"]) == kind] for kind in KINDS}
    return [
        Folded(f"Other figures: {kind}", _unfolded(kind, of, hours, sure), on_paper=False)
        for kind, of in by_kind.items()
        if of
    ]


def _unfolded(of_what: str, rows: Sequence[Row], hours: bool, sure: str) -> list[Grid]:
    """Those of the whole together, the others each by itself."""
    whole = [row for row in rows if not row["subject"]]
    kinds = dict.fromkeys(row["kpi"] for row in rows if row["subject"])
    tables = [(kpi_name(kind, hours), [row for row in rows if row["kpi"] == kind and row["subject"]]) for kind in kinds]
    return [_grid(title, of, hours, sure) for title, of in [(f"Of the whole: {of_what}", whole), *tables] if of]


def _grid(title: str, rows: Sequence[Row], hours: bool, sure: str) -> Grid:
    """A figure's name is written at its first row only, and all its rows have one unit."""
    kinds = dict.fromkeys(row["kpi"] for row in rows)
    cells = [row for kind in kinds for row in _rows_of(kind, [row for row in rows if row["kpi"] == kind], hours)]
    columns = ("Figure", "Of", "Mean", sure, "Unit", "Half-width", "n")
    return Grid(columns, cells, title, words=2, folded=bool(title), left=(4,), strong=2, said="what came out")


def _rows_of(kpi: str, rows: Sequence[Row], hours: bool) -> list[tuple[str, ...]]:
    largest, name = largest_mean(rows), kpi_name(kpi, hours)
    named = [(row["subject"], part_name(kpi, row.get("part", ""))) for row in rows]
    subjects = [" · ".join(filter(None, of)) or "all" for of in named]
    cells = [interval_cells(row, largest) for row in rows]
    return [
        ("" if i else name, of, *(str(cell[key]) for key in CELLS)) for i, (of, cell) in enumerate(zip(subjects, cells))
    ]
