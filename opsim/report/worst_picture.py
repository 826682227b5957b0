"""The worst postures of a run as cards: a person from the side and from the front, scores, and what they come from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from opsim.report.exposure_words import REGIONS
from opsim.report.posture_picture import posture_svg, room_of, warm
from opsim.report.words import digits, listing

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
    named = [f"{REGIONS.get(part, part)} ({digits(points, 0.1)})" for part, points in drives.items() if points >= 0.05]
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
