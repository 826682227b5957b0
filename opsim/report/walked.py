"""How each worker of a run walks: a walk of the run over his most usual way, drawn again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from opsim.report.material import Material
from opsim.report.movements import LIMBS, origin_of
from opsim.report.section import Picture, Section, Words
from opsim.report.walk_picture import Walk, draw_walk

MOST = 6
"""Workers shown: those who walk furthest."""
SAID = (
    "A walk of each worker over the way he takes most often, drawn again from the first replication, to scale. Below, "
    "where his feet bear, seen from above, at thirty moments a second: a foot that does not slide leaves one print, "
    "rolling from heel to toe."
)
RATE_HZ = 60.0
"""Of what is looked at: a foot goes over from its heel to its toe within a few hundredths of a second."""


def section(material: Material) -> Section | None:
    """How people walk; None where the scenario names no walking emulator or nobody walks."""
    if material.log is None or material.plan.walking is None:
        return None
    walks, n_more = usual_walks(material.plan, material.log)
    return section_of(walks, n_more, material.summary.get("walking", {})) if walks else None


def section_of(walks: Sequence[Walk], n_more: int, source: Mapping[str, Any]) -> Section:
    """The pictures of some walks, and what they were learned from.

    n_more : how many more people walk; source : of the summary: model, library, source, licence, counts
    """
    wide_m = max(walk.distance_m for walk in walks)
    pictures = [
        Picture(draw_walk(walk, wide_m), said_of(walk), caption=f"{walk.worker}: {words(walk)}.") for walk in walks
    ]
    more = [Words(f"{n_more} more walk, less far.", muted=True)] if n_more else []
    learned = Words(origin_of(source["model"], source), muted=True)
    return Section("walking", "How people walk", [Words(SAID), LIMBS, *pictures, *more, learned], "Walking")


def said_of(walk: Walk) -> str:
    """The picture in words."""
    return f"{walk.worker} walking, seen from the side, with footprints seen from above"


def words(walk: Walk) -> str:
    """Speed, step and cadence of a walk, and whether feet slide in it."""
    speed = walk.distance_m / walk.duration_s
    steps = "" if np.isnan(walk.step_length_m) else f"steps of {walk.step_length_m:.2f} m, "
    return (
        f"{speed:.2f} m/s, {steps}{walk.cadence_per_min:.0f} a minute; "
        f"bearing feet slide by at most {walk.slide_mm:.1f} mm a step"
    )


def usual_walks(plan: Any, log: Any) -> tuple[list[Walk], int]:
    """A walk of each worker over his most usual way in the first replication; how many more workers walk."""
    from opsim.walks import walks_of

    walks = walks_of(log, plan)
    whole = walks.end_s - walks.start_s >= walks.whole_s - 1e-9
    metres = np.bincount(walks.worker, walks.distance_m, len(plan.workers))
    walkers = [rank for rank in np.argsort(-metres, kind="stable").tolist() if metres[rank] > 0]
    chosen = [_usual(walks, np.flatnonzero(whole & (walks.worker == rank)), plan) for rank in sorted(walkers[:MOST])]
    return [_walk(plan, log, walks, row) for row in chosen if row is not None], max(0, len(walkers) - MOST)


def _usual(walks: Any, rows: np.ndarray, plan: Any) -> int | None:
    """The first walk over the way that some walks take most often (back or forth), of those that can be drawn."""
    from opsim.ergonomics.walks import drawable

    rows = rows[drawable(plan.walking.model, walks.distance_m[rows])]
    if not rows.size:
        return None
    _, first, counts = np.unique(walks.distance_m[rows], return_index=True, return_counts=True)
    return int(rows[first[np.argmax(counts)]])


def _walk(plan: Any, log: Any, walks: Any, row: int) -> Walk:
    """One of the walks, drawn again by its number."""
    from opsim.ergonomics.walks import walk_again

    rank, distance_m = int(walks.worker[row]), float(walks.distance_m[row])
    drawn = walk_again(plan, log.replication, rank, int(walks.k[row]), distance_m)
    n_times = max(round(float(walks.whole_s[row]) * RATE_HZ), 8) + 1
    way = f"{plan.places[walks.place_from[row]]} to {plan.places[walks.place_to[row]]}"
    return Walk(
        plan.workers[rank].name,
        way,
        distance_m,
        float(walks.whole_s[row]),
        drawn.decoded("positions_m", n_times=n_times),
        drawn.decoded("contact", n_times=n_times),
        drawn.block.skeleton,
    )
