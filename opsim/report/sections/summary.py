"""The run in a few sentences, each figure with its interval.

Whether the floor keeps up with what is asked of it, so that no station but demand sets the pace.

What workers, stations and vehicles were doing: a bar each of shares that sum to 1.

The figures of a run as tables: those that matter most in sight, the others to unfold by what they are of.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from opsim.kpi.catalogue import KINDS, kind_of
from opsim.kpi.parts import part_name
from opsim.kpi.window import in_window
from opsim.log import CREATE, LEAVING_KINDS
from opsim.plan.loads.flows import flows_of
from opsim.report.material import Material
from opsim.report.numbers import (
    TRUNK_SHARES,
    clock,
    digits,
    interval_cells,
    is_number,
    kpi_name,
    largest_mean,
    listing,
    quantity,
    scale_of,
)
from opsim.report.page import Block, Caution, Chart, Folded, Grid, Section, Words
from opsim.report.plot import plotly
from opsim.report.sections.common import is_shown, without_again

Row = Mapping[str, Any]


def find(rows: Sequence[Row], kpi: str, subject: str = "", part: str = "") -> Row | None:
    """The row of one figure, or None where it has no value."""
    named = (row for row in rows if (row["kpi"], row["subject"], row.get("part", "")) == (kpi, subject, part))
    row = next(named, None)
    return row if row is not None and is_number(row.get("mean")) else None


def with_interval(row: Row) -> str:
    """``60.1 per hour (59.1 to 61.1)``."""
    mean = quantity(row["mean"], row["unit"], row.get("half_width"))
    if not is_number(row.get("half_width")):
        return mean
    factor, _ = scale_of(row["unit"], row["mean"])
    low, high = (digits(row[edge] * factor, row["half_width"] * factor) for edge in ("low", "high"))
    return f"{mean} ({low} to {high})"


def sentences(summary: Mapping[str, Any]) -> list[str]:
    """What came out, how long it stayed, who and what was busiest, and how surely this is known."""
    rows = summary["kpis"]
    said = [
        _output(rows, "scheduled_h" in summary),
        busiest_worker(rows),
        _busiest(rows, "station_states", "station"),
        _overtime(rows),
    ]
    return [text for text in [*said, _certainty(summary)] if text]


def _output(rows: Sequence[Row], hours: bool) -> str:
    """hours : whether the floor keeps hours; what lies in stores is inside, and none of it ever finishes by itself."""
    stocked = ", stock included" if any(row["kpi"] == "stock" for row in rows) else ""
    parts = [
        words.format(with_interval(row).replace(" per hour", ""))
        for kpi, words in (
            ("throughput_per_h", "{} jobs " + ("per scheduled" if hours else "an") + " hour are finished"),
            ("time_in_system_s", "a job stays {}"),
            ("work_in_progress", "{} are inside on average" + stocked),
        )
        if (row := find(rows, kpi)) is not None
    ]
    text = listing(parts)
    return text[:1].upper() + text[1:] + "." if text else ""


def busiest_worker(rows: Sequence[Row]) -> str:
    """Who has the least time to spare; nothing where nobody works."""
    return _busiest_on_duty(rows) or _busiest(rows, "worker_states", "worker")


def _busiest(rows: Sequence[Row], kpi: str, noun: str) -> str:
    working = [row for row in rows if row["kpi"] == kpi and row["part"] == "work" and is_number(row["mean"])]
    if not working:
        return ""
    top = max(working, key=lambda row: row["mean"])
    verb = "of the time at work" if noun == "worker" else "of its servers' time at work"
    text = f"The busiest {noun} is {top['subject']}: {with_interval(top)} {verb}"
    blocked = [row for row in rows if row["kpi"] == kpi and row["part"] == "blocked" and is_number(row["mean"])]
    most = max(blocked, key=lambda row: row["mean"], default=None)
    if most is not None and most["mean"] >= 0.01:
        text += f"; the one most often blocked is {most['subject']}: {with_interval(most)}"
    return text + "."


def _busiest_on_duty(rows: Sequence[Row]) -> str:
    """Where people work in shifts, time off is nobody's idleness."""
    on_shifts = [row for row in rows if row["kpi"] == "duty_use" and row["subject"] and is_number(row["mean"])]
    if not on_shifts:
        return ""
    top = max(on_shifts, key=lambda row: row["mean"])
    return (
        f"The busiest worker is {top['subject']}: at work or on the way for {with_interval(top)} of the time on duty, "
        "breaks aside."
    )


def _overtime(rows: Sequence[Row]) -> str:
    """Overtime and absence of all together, where there was some."""
    over, missed = find(rows, "overtime_h"), find(rows, "absent_share")
    said = []
    if over is not None and over["mean"] > 0:
        said.append(f"after their shifts people stay for {with_interval(over)} in all")
    if missed is not None and missed["mean"] > 0:
        said.append(f"{with_interval(missed)} of the time of shifts is missed")
    return listing(said)[:1].upper() + listing(said)[1:] + "." if said else ""


def _certainty(summary: Mapping[str, Any]) -> str:
    low, high = summary["window_s"]
    window = f"{clock(summary['start'], low)} to {clock(summary['start'], high)}"
    if summary["replications"] == 1:
        return f"One replication, counted from {window}: there is no interval, and nothing to tell luck from cause."
    return (
        f"{summary['replications']} replications, counted from {window}; in brackets the "
        f"{100 * summary['confidence']:.0f} % intervals of the means."
    )


ASKED, LEFT, LOST = 0.9, 0.95, 0.03
"""Shares: of what the sources would release, that came in; of what came in, that left; of what arrived, turned away."""


def keeps_up(material: Material) -> bool:
    """Whether jobs come in by themselves, all that arrive are let in, and as many leave; in the first replication.

    False where the floor decides what comes in, and where no rows are kept to see it by.
    """
    plan, log, lost = material.plan, material.log, find(material.rows("lost_share"), "lost_share")
    flows = flows_of(plan)
    if log is None or flows.saturated or flows.per_h <= 0 or (lost is not None and lost["mean"] > LOST):
        return False
    low_s, high_s = plan.window_s
    came = (log["kind"] == CREATE) & in_window(log["end_s"], plan)
    left = np.isin(log["kind"], list(LEAVING_KINDS)) & in_window(log["end_s"], plan)
    asked = flows.per_h * (high_s - low_s) / 3600
    return bool(came.sum() >= ASKED * asked and left.sum() >= LEFT * came.sum())


STATE_KPIS = {"worker_states": "Workers", "station_states": "Stations", "transporter_states": "Transporters"}


def states_section(material: Material) -> Section | None:
    """A figure a kind; where shares do not sum to 1, that is said."""
    blocks: list[Block] = []
    for kpi, title in STATE_KPIS.items():
        if rows := material.rows(kpi):
            said = "; ".join(f"{row['subject']} {row['part']} {quantity(row['mean'], 'share')}" for row in rows)
            blocks += [_wrong(*of) for of in plotly.wrong_sums(rows)]
            blocks.append(Chart(kpi, plotly.states(rows), said, title, plotly.legend(rows)))
    return Section("states", "What workers and stations were doing", blocks, "States") if blocks else None


def _wrong(subject: str, total: float) -> Caution:
    return Caution(
        f"The states of {subject} sum to {quantity(total, 'share')}, not to 100 %: do not trust this figure."
    )


MOST = 10
"""Workers, products or stations of one figure in the table in sight."""
NUMBERS = "Half-width: that of the interval, in per cent of the mean. n: replications that have a value."
CELLS = ("mean", "interval", "unit", "relative", "n")


def kpi_section(material: Material) -> Section:
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
    return bool(row.get("headline")) and row["kpi"] not in (*STATE_KPIS, TRUNK_SHARES)


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
