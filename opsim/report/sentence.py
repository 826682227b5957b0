"""The run in a few sentences, each figure with its interval."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from opsim.report.words import clock, digits, is_number, listing, quantity, scale_of

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
    worker = _busiest_on_duty(rows) or _busiest(rows, "worker_states", "worker")
    said = [
        _output(rows, "scheduled_h" in summary),
        worker,
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
