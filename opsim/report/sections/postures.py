"""The worst postures of a run as cards: a person from the side and from the front, scores, and what they come from.

How bent people worked: a bar a worker, and the sentence above it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from opsim.kpi.parts import REGION_NAMES
from opsim.report.material import Material
from opsim.report.numbers import TRUNK_SHARES, digits, is_number, listing, quantity
from opsim.report.page import Chart, Section, Words
from opsim.report.plot import plotly
from opsim.report.plot.posture import posture_svg, room_of, warm
from opsim.report.sections.summary import find, with_interval

VIEWS = ("side", "front")
WIDE_PX = 210
PARTS = {
    "trunk": "trunk",
    "neck": "neck",
    "upper_arm": "upper arm",
    "lower_arm": "lower arm",
    "wrist": "wrist",
    "wrist_twist": "forearm twist",
    "legs": "legs",
    "force": "load, force",
    "time": "repeated, held",
}
"""RULA's sub-scores in words, in the order in which they are shown."""
LEAST = {"force": 0, "time": 0}


def posture_cards(worst: Sequence[Any]) -> list[dict[str, Any]]:
    """Each: ``title``, ``scores``, ``when``, ``drives`` in words, ``parts`` of (name, score, colour), ``pictures`` (SVG
    text). worst : of ``ergonomics.worst``; all people in one scale"""
    return [
        {
            "title": f"{one.worker} at {one.task}" + (f", {one.station}" if one.station else ""),
            "scores": f"RULA {pair(one.rula)}, REBA {pair(one.reba)}, OWAS {pair(one.owas)}",
            "when": f"{one.clock}; {_minutes(one)}",
            "drives": _drives(one.why["rula"]["drives"]),
            "parts": [
                (PARTS[name], pair(score), _colour(name, one)) for name, score in _parts(one.why["rula"]["parts"])
            ],
            "pictures": _pictures(one, worst),
        }
        for one in worst
    ]


def pair(low_high: Sequence[int]) -> str:
    """``7``, or ``5 to 7`` where it is an interval."""
    low, high = low_high
    return f"{low}" if low == high else f"{low} to {high}"


def _parts(parts: Mapping[str, Any]) -> list[tuple[str, Any]]:
    return [(name, parts[name]) for name in PARTS if name in parts]


def _colour(part: str, one: Any) -> str:
    """That of the region in the picture; none of what is as low as can be."""
    region = {"upper_arm": "arms", "lower_arm": "arms", "wrist": "wrists", "wrist_twist": "wrists", "force": "load"}
    points = one.why["rula"]["drives"].get(region.get(part, part), 0.0)
    return warm(points) if one.why["rula"]["parts"][part][1] > LEAST.get(part, 1) else "#ffffff"


def _drives(drives: Mapping[str, float]) -> str:
    named = [
        f"{REGION_NAMES.get(part, part)} ({digits(points, 0.1)})" for part, points in drives.items() if points >= 0.05
    ]
    return f"Points of the score come from {listing(named)}." if named else ""


def _minutes(one: Any) -> str:
    return f"{digits(one.seconds / 60, 0.1)} min of the run at RULA {one.rula[0]} or more in this task"


def _pictures(one: Any, worst: Sequence[Any]) -> list[str]:
    side = one.why["rula"]["side"]
    alike = [other.joints_m for other in worst if other.skeleton.names == one.skeleton.names]
    load_kg = one.load_kg if one.carrying else None
    return [
        posture_svg(
            one.joints_m,
            one.skeleton,
            drives=one.why["rula"]["drives"],
            side=side,
            load_kg=load_kg,
            view=view,
            room=room_of(alike, one.skeleton, view, side),
            width_px=WIDE_PX,
            label=f"{one.worker} at {one.task}, from the {view}",
        )
        for view in VIEWS
    ]


Row = Mapping[str, Any]


def posture_section(material: Material) -> Section | None:
    """What is said of trunks; None where the run's postures were not asked for."""
    rows = material.summary["kpis"]
    shares = [row for row in rows if row["kpi"] == TRUNK_SHARES and row["subject"]]
    if not shares:
        return None
    said = "; ".join(f"{row['subject']} {row['part']} {quantity(row['mean'], 'share')}" for row in shares)
    chart = Chart(TRUNK_SHARES, plotly.states(shares), said, legend=plotly.legend(shares))
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
