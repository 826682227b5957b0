"""What bodies went through in the first replication: a strip over the clock a worker, and the worst postures drawn."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from opsim.ergonomics.shift.regions import REGIONS, Regions
from opsim.ergonomics.shift.timeline import MINUTE_S, Minutes, Timeline
from opsim.ergonomics.shift.worst import Worst, WorstSeen
from opsim.kpi.names import EXPOSURE
from opsim.log import BREAK, EventLog
from opsim.plan import Plan
from opsim.report.day_picture import Strip, draw_day, legend
from opsim.report.days import CELL_S, LONGEST_S, MOST, MOST_CELLS
from opsim.report.exposure_rows import Bar
from opsim.report.exposure_sentences import region_sentences
from opsim.report.material import Material
from opsim.report.words import quantity
from opsim.report.worst_picture import posture_cards

FILE = "postures.json"
MOST_POSTURES = 4


def bodies_of(material: Material) -> dict[str, Any] | None:
    """What there is to show: ``picture`` (SVG bytes) and ``legend`` of the day, ``postures`` of ``posture_cards``,
    ``regions`` in sentences. The postures are also written into the results folder, for whatever wants to open them.

    None where the scenario asks for nothing that needs all postures, or nothing is known of any.
    """
    from opsim.ergonomics.shift.fold import fold

    if not {row["kpi"] for row in material.summary["kpis"]}.intersection(EXPOSURE) or material.log is None:
        return None
    plan, log = material.plan, material.log
    minutes, seen, regions = Minutes(plan), WorstSeen(), Regions(plan)
    fold(log, plan, [minutes, seen, regions])
    worst = seen.worst(log, plan, MOST_POSTURES, one_a_task=True)
    write_postures(worst, material.result.folder / FILE)
    day = minutes.close()
    if not day.known_s.any():
        return None
    said = {"postures": posture_cards(worst), "regions": regions_said(regions)}
    return day_of(day, plan, material.summary["start"], log) | said


def regions_said(found: Regions) -> list[str]:
    """From which regions of the body the high scores come, in this replication."""
    minutes = found.seconds.sum(axis=0) / 60.0
    bars = [Bar(name, seven, five, five) for name, (five, seven) in zip(REGIONS, minutes.tolist())]
    five, seven = minutes.sum(axis=0).tolist()
    return list(region_sentences(Bar("all", seven, five, five), bars))


def day_of(day: Timeline, plan: Plan, start: str, log: EventLog | None = None) -> dict[str, Any]:
    """The strips of a timeline: its window, or the first 24 hours of it; with the breaks that a log says."""
    n = min(day.known_s.shape[1], round(LONGEST_S / MINUTE_S))
    every = next(
        (round(cell / MINUTE_S) for cell in CELL_S if cell >= MINUTE_S and n * MINUTE_S / cell <= MOST_CELLS), 5
    )
    from_s, to_s = float(day.edge_s[0]), float(day.edge_s[0] + n * MINUTE_S)
    strips = [
        Strip(
            worker.name,
            _shares(day, rank, n, every),
            shifts=_shifts(worker, from_s, to_s),
            pauses=() if log is None else pauses(log, rank, from_s, to_s),
        )
        for rank, worker in enumerate(plan.workers)
    ]
    return {
        "picture": draw_day(strips[:MOST], start, from_s, to_s),
        "legend": legend(strips[:MOST]),
        "minutes": every,
        "cut": n < day.known_s.shape[1],
        "alt": _alt(strips[:MOST]),
        "more": max(0, len(strips) - MOST),
    }


def _shares(day: Timeline, rank: int, n: int, every: int) -> dict[str, np.ndarray]:
    seconds = {
        "rula_from_5": day.from_5_s,
        "perhaps_from_5": day.from_5_at_most_s - day.from_5_s,
        "rula_below_5": day.known_s - day.from_5_at_most_s,
        "unmeasured": day.unknown_s,
    }
    edges = np.arange(0, n, every)
    lasts = np.diff(np.r_[edges, n]) * MINUTE_S
    found = {state: np.add.reduceat(of[rank, :n], edges) / lasts for state, of in seconds.items()}
    return {state: np.clip(share, 0.0, 1.0) for state, share in found.items() if (share > 1e-6).any()}


def _shifts(worker: Any, from_s: float, to_s: float) -> list[tuple[float, float]]:
    """His shifts as shares of the time shown."""
    both = [np.clip([duty.start_s, duty.end_s], from_s, to_s) for duty in worker.duties or ()]
    return [tuple(((edges - from_s) / (to_s - from_s)).tolist()) for edges in both if edges[1] > edges[0]]


def pauses(log: EventLog, rank: int, from_s: float, to_s: float) -> list[tuple[float, float]]:
    """Somebody's breaks, meetings and rests as shares of the time shown; those that follow each other are one."""
    rows = np.flatnonzero((log["kind"] == BREAK) & (log["worker"] == rank))
    found: list[tuple[float, float]] = []
    for begin_s, end_s in sorted(np.clip([log["start_s"][rows], log["end_s"][rows]], from_s, to_s).T.tolist()):
        begin, end = ((at - from_s) / (to_s - from_s) for at in (begin_s, end_s))
        if found and begin <= found[-1][1] + 1e-9:
            found[-1] = found[-1][0], max(end, found[-1][1])
        elif end > begin:
            found.append((begin, end))
    return found


def _alt(strips: Sequence[Strip]) -> str:
    """The picture in words."""
    return "; ".join(
        f"{strip.worker}: {quantity(float(strip.shares['rula_from_5'].mean()), 'share')} of the time at RULA 5 or more"
        for strip in strips
        if "rula_from_5" in strip.shares
    )


def write_postures(worst: Sequence[Worst], path: Path) -> None:
    """The worst postures as JSON: who, where, when, scores, what drives them, joints in metres, their names."""
    from opsim.whole import write_json

    names = (
        "worker",
        "task",
        "station",
        "product",
        "at_s",
        "clock",
        "k",
        "progress",
        "seconds",
        "rula",
        "reba",
        "owas",
    )
    said = ("carrying", "repeated", "static", "load_kg", "why")
    found = [
        {name: getattr(one, name) for name in (*names, *said)}
        | {
            "joints": list(one.skeleton.names),
            "parents": list(one.skeleton.parents),
            "joints_m": [[None if np.isnan(v) else round(float(v), 4) for v in joint] for joint in one.joints_m],
        }
        for one in worst
    ]
    write_json(path, {"replication": 0, "worst": found})
