"""How bent people worked: a bar a worker, and the sentence above it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from opsim.report import figures
from opsim.report.material import Material
from opsim.report.section import Chart, Section, Words
from opsim.report.sentence import find, with_interval
from opsim.report.words import is_number, quantity

SHARES = "trunk_flexion_share"
Row = Mapping[str, Any]


def section(material: Material) -> Section | None:
    """What is said of trunks; None where the run's postures were not asked for."""
    rows = material.summary["kpis"]
    shares = [row for row in rows if row["kpi"] == SHARES and row["subject"]]
    if not shares:
        return None
    said = "; ".join(f"{row['subject']} {row['part']} {quantity(row['mean'], 'share')}" for row in shares)
    chart = Chart(SHARES, figures.states(shares), said, legend=figures.legend(shares))
    return Section("bodies", "How bent people worked", [*map(Words, _sentences(rows)), chart], "Trunks")


def _sentences(rows: Sequence[Row]) -> list[str]:
    """Who worked most bent, and how much of the work has a known posture."""
    measured = find(rows, "posture_measured_share")
    if measured is None or measured["mean"] == 0:
        unknown = "No task that was worked on has a body: nothing is known of how bent people worked."
        return [text for text in (unknown, _walking(rows)) if text]
    known = f"{with_interval(measured)} of the time at work has a known posture."
    if measured["mean"] < 1:
        known += " Nobody knows how bent the rest was (grey), so that minutes at an angle are at least these."
    return [text for text in (_most(rows, 60), _most(rows, 20), known, _walking(rows)) if text]


def _walking(rows: Sequence[Row]) -> str:
    """How much people walk, and how bent, where walking has postures."""
    minutes, steps, mean = (
        find(rows, *named)
        for named in (("walking_min_per_h",), ("steps_per_h",), ("trunk_flexion_mean_deg", "", "walking"))
    )
    if minutes is None or steps is None or minutes["mean"] == 0:
        return ""
    walked = with_interval(minutes).replace(" min/h", " minutes of each hour of a worker")
    count = with_interval(steps).replace(" per hour", "")
    bent = "" if mean is None else f", with the trunk flexed {with_interval(mean).replace(' °', '°')} on average"
    return f"Walking takes {walked}, {count} steps{bent}."


def _most(rows: Sequence[Row], limit: int) -> str:
    kpi = f"trunk_beyond_{limit}_min_per_h"
    people = [
        row for row in rows if row["kpi"] == kpi and row["subject"] and not row["part"] and is_number(row["mean"])
    ]
    top = max(people, key=lambda row: row["mean"], default=None)
    if top is None:
        return ""
    if top["mean"] == 0:
        return f"Trunk flexed {limit}° or more: seen of nobody."
    said = with_interval(top).replace(" min/h", " minutes of each hour")
    return f"Trunk flexed {limit}° or more: {top['subject']} for longest, {said}."
