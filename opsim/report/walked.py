"""How each worker of a run walks: a walk of the run over his most usual way, drawn again."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.report.walk_picture import Walk, draw_walk

MOST = 6
"""Workers shown: those who walk furthest."""
RATE_HZ = 60.0
"""Of what is looked at: a foot goes over from its heel to its toe within a few hundredths of a second."""


def walks_section(loaded: Any, result: Any) -> dict[str, Any] | None:
    """What the page shows of walking: ``walks`` (worker, picture as SVG bytes, words), and how many more walk.

    loaded : the variant that was read; result : its results, with the rows of its first replication
    None where the scenario names no walking emulator or nobody walks. Raises ValueError or OSError as reading does.
    """
    if loaded.scenario.walking is None or not result.events_files:
        return None
    walks, n_more = usual_walks(loaded, result)
    if not walks:
        return None
    wide_m = max(walk.distance_m for walk in walks)
    shown = [{"worker": walk.worker, "picture": draw_walk(walk, wide_m), "words": words(walk)} for walk in walks]
    return {"source": result.summary.get("walking", {}), "walks": shown, "more": n_more}


def words(walk: Walk) -> str:
    """Speed, step and cadence of a walk, and whether feet slide in it."""
    speed = walk.distance_m / walk.duration_s
    steps = "" if np.isnan(walk.step_length_m) else f"steps of {walk.step_length_m:.2f} m, "
    return (
        f"{speed:.2f} m/s, {steps}{walk.cadence_per_min:.0f} a minute; "
        f"bearing feet slide by at most {walk.slide_mm:.1f} mm a step"
    )


def usual_walks(loaded: Any, result: Any) -> tuple[list[Walk], int]:
    """A walk of each worker over his most usual way in the first replication; how many more workers walk."""
    from opsim.log_store import read_events
    from opsim.plan import compile_plan
    from opsim.walks import walks_of

    plan = compile_plan(loaded, seed=result.summary["seed"])
    log = read_events(result.events_files[0])
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
