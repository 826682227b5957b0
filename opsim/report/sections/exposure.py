"""What bodies went through, from the figures of the summary.

What bodies went through in the first replication: a strip over the clock a worker, and the worst postures drawn.

What bodies go through: minutes at high scores, limits, the day over the clock, and the worst postures.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from opsim.ergonomics.shift.ledger import MINUTE_S, REGIONS, Minutes, Regions, Timeline
from opsim.ergonomics.shift.worst import Worst, WorstSeen
from opsim.kpi.catalogue import EXPOSURE
from opsim.kpi.parts import REGION_NAMES
from opsim.log import BREAK, EventLog
from opsim.plan import Plan
from opsim.report.material import Material
from opsim.report.numbers import quantity
from opsim.report.page import Block, Bullets, Card, Chart, Heading, Legend, Panels, Picture, Section, Words
from opsim.report.sections.exposure_summary import (
    REGION,
    Bar,
    bar_legend,
    bars_by,
    bars_of_regions,
    bars_of_workers,
    exposure_sentences,
    level_bars,
    limit_sentences,
    region_sentences,
    said,
)
from opsim.report.sections.postures import posture_cards
from opsim.report.sections.worker_timeline import CELL_S, LONGEST_S, MOST, MOST_CELLS, Strip, draw_day, left_out, legend

Row = Mapping[str, Any]
MOST_WORKERS = 30
"""Workers shown: those with most, where there are more."""
TITLES = {
    "exposure_workers": "By worker, in an hour in which he is there, breaks included",
    "exposure_by_hour": "By the hour of the day, in an hour of who is there, breaks included",
    "exposure_by_task": "By task, in an hour of all workers' time",
    "exposure_by_station": "By station, in an hour of all workers' time",
    "exposure_by_region": "By what the score comes from, in an hour of all workers' time",
}


def exposure_blocks(rows: Sequence[Row], confidence: float) -> list[Block]:
    """Sentences and small charts of exposure; none where no RULA was asked for.

    rows : of the summary; each figure appears only where it tells of more than one
    """
    sentences = exposure_sentences(rows)
    if not sentences:
        return []
    bars = _bars(rows)
    panels = [_chart(name, of) for name, of in bars.items() if _tells(name, of)]
    note = (
        f"Minutes of an hour, means over the replications; the black line is the {100 * confidence:.0f} % interval of "
        "the minutes at RULA 5 or more."
    )
    key = Legend(bar_legend([bar for of in bars.values() for bar in of]))
    return [*map(Words, sentences), key, Panels(panels), Words(note, muted=True)]


def has_regions(rows: Sequence[Row]) -> bool:
    """Whether the figures say from which regions of the body high scores come."""
    return bool(bars_of_regions(rows)) and bool(exposure_sentences(rows))


def _bars(rows: Sequence[Row]) -> dict[str, list[Bar]]:
    named = [
        Bar(
            REGION_NAMES.get(bar.subject, bar.subject).removeprefix("the "),
            bar.seven,
            bar.five,
            bar.most,
            bar.low,
            bar.high,
        )
        for bar in bars_of_regions(rows)
    ]
    by = {kpi: bars_by(rows, kpi) for kpi in ("exposure_by_hour", "exposure_by_task", "exposure_by_station")}
    by["exposure_by_task"].sort(key=lambda bar: -bar.most)
    return {"exposure_workers": _most_exposed(bars_of_workers(rows)), **by, REGION: named}


def _most_exposed(workers: list[Bar]) -> list[Bar]:
    """In their order; of more than ``MOST`` those with most."""
    least = (
        sorted((bar.most for bar in workers), reverse=True)[MOST_WORKERS - 1] if len(workers) > MOST_WORKERS else 0.0
    )
    return [bar for bar in workers if bar.most >= least][:MOST_WORKERS]


def _tells(name: str, bars: Sequence[Bar]) -> bool:
    return bool(bars) and (name == "exposure_workers" or len(bars) > 1)


def _chart(name: str, bars: Sequence[Bar]) -> Chart:
    return Chart(name, level_bars(bars, upright=name == "exposure_by_hour"), said(bars), TITLES[name])


FILE = "postures.json"
MOST_POSTURES = 4


def bodies_of(material: Material) -> dict[str, Any] | None:
    """What there is to show: ``picture`` (SVG bytes) and ``legend`` of the day, ``postures`` of ``posture_cards``,
    ``regions`` in sentences. The postures are also written into the results folder, for whatever wants to open them.

    None where the scenario asks for nothing that needs all postures, or nothing is known of any.
    """
    from opsim.ergonomics.shift.day import fold

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
    from opsim.files import write_json

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


WORST = (
    "The worst of each task in the first replication, from the side of the arm that scores higher and from the front. "
    "The warmer a part of the body, the more points of RULA it brings in; a box is what the hands hold. Sub-scores of "
    "the method stand beside."
)
CARD_PX = 430
"""The least width of a posture's card."""


def exposure_section(material: Material) -> Section | None:
    """None where nothing of it was asked for."""
    rows = material.summary["kpis"]
    limits, went = limit_sentences(rows), bodies_of(material)
    blocks = exposure_blocks(rows, material.summary["confidence"])
    if limits:
        blocks += [Heading("Limits of lifting, holding and rest"), Bullets(limits)]
    if went is not None:
        blocks += [*_day(went, regions=not has_regions(rows)), *_postures(went["postures"])]
    return Section("exposure", "What bodies go through", blocks, "Exposure") if blocks else None


def _day(went: Mapping[str, Any], *, regions: bool) -> list[Block]:
    """regions : whether it is to be said here from which of them high scores come"""
    cut = ", its first 24 hours after the warm-up" if went["cut"] else ""
    every = "minute by minute" if went["minutes"] == 1 else f"every {went['minutes']} minutes"
    text = (
        f"The first replication{cut}, {every}: the height of a colour is its share of the time. White is waiting, and "
        "walking that was not looked at; breaks are hatched; a dark line marks a shift."
    )
    picture = Picture(went["picture"], went["alt"], caption=left_out(went["more"]), legend=went["legend"])
    said = map(Words, went["regions"] if regions else ())
    return [Heading("Over the clock"), *said, Words(text), picture]


def _postures(postures: list[dict[str, Any]]) -> list[Block]:
    cards = [
        Card(one["title"], one["scores"], one["when"], one["pictures"], one["parts"], one["drives"]) for one in postures
    ]
    return [Heading("The worst postures"), Words(WORST), Panels(cards, least_px=CARD_PX)] if cards else []
