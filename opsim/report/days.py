"""What people did through the first replication, as strips over the clock."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from opsim.kpi.states import STATES, states_of_rows
from opsim.log import SETUP, WORK, EventLog
from opsim.plan import Plan
from opsim.report.day_picture import Strip, draw_day, legend
from opsim.report.material import Material
from opsim.report.palette import WORDS as STATE_WORDS
from opsim.report.section import Picture, Section, Words
from opsim.report.words import quantity

LONGEST_S = 24 * 3600.0
MOST = 40
"""Workers shown, in natural order."""
CELL_S = (10.0, 30.0, 60.0, 120.0, 300.0)
MOST_CELLS = 320
BOTTOM_FIRST = (
    *("work", "setup", "walk", "held", "team", "tool", "behind", "wait", "rest", "meeting", "break", "off", "absent"),
)
MOSTLY = 0.6
"""Share of the work of some time that makes a station the place where somebody mostly was."""


def section(material: Material) -> Section | None:
    """People through the day; None where there are no workers or no rows."""
    if material.log is None or not material.plan.workers:
        return None
    return section_of(day_of(material.log, material.plan, material.summary["start"]))


def section_of(day: Mapping[str, Any]) -> Section:
    """The words and the picture. day : as ``day_of`` makes it"""
    cut = ", its first 24 hours after the warm-up" if day["cut"] else ""
    shifts = " A dark line marks his shift: what stands beside it is overtime." if day["shifts"] else ""
    text = (
        f"The first replication{cut}. Each stretch of {day['stretch']} is filled from below by what somebody did in "
        f"it, so that the height of a colour is its share; below it the station at which he mostly worked.{shifts}"
    )
    picture = Picture(day["picture"], day["alt"], caption=left_out(day["more"]), legend=day["legend"])
    return Section("days", "People through the day", [Words(text), picture], "Day")


def left_out(n: int) -> str:
    """How many workers a picture has no room for, in words."""
    return f"{n} more {'worker is' if n == 1 else 'workers are'} not shown." if n else ""


def day_of(log: EventLog, plan: Plan, start: str) -> dict[str, Any]:
    """What is shown of a log (24 hours of its window at most): ``picture`` (SVG bytes), ``legend``, and words."""
    from_s, high = plan.window_s
    to_s = min(high, from_s + LONGEST_S)
    strips = strips_of(log, plan, from_s, to_s)
    return {
        "picture": draw_day(strips[:MOST], start, from_s, to_s),
        "legend": legend(strips[:MOST]),
        "stretch": _stretch(cell_s(to_s - from_s)),
        "alt": _alt(strips),
        "cut": to_s < high,
        "shifts": any(strip.shifts for strip in strips),
        "more": max(0, len(strips) - MOST),
    }


def _stretch(seconds: float) -> str:
    return f"{seconds:g} s" if seconds < 60 else f"{seconds / 60:g} min"


def _alt(strips: Sequence[Strip]) -> str:
    """The picture in words: what share of the time shown each worker did what."""
    return "; ".join(
        f"{strip.worker}: "
        + ", ".join(f"{STATE_WORDS.get(s, s)} {quantity(float(of.mean()), 'share')}" for s, of in strip.shares.items())
        for strip in strips[:MOST]
    )


def cell_s(length_s: float) -> float:
    """How long the stretches are into which a time is cut."""
    return next((cell for cell in CELL_S if length_s / cell <= MOST_CELLS), CELL_S[-1])


def strips_of(log: EventLog, plan: Plan, from_s: float, to_s: float) -> list[Strip]:
    """A strip of each worker, in natural order."""
    rows, states = states_of_rows(log)
    n_cells = max(1, round((to_s - from_s) / cell_s(to_s - from_s)))
    edges_s = np.linspace(from_s, to_s, n_cells + 1)
    return [
        Strip(
            worker.name,
            _shares(log, rows, states, rank, edges_s),
            list(_posts(log, plan, rank, edges_s)),
            [
                _part(duty.start_s, duty.end_s, from_s, to_s)
                for duty in worker.duties or ()
                if duty.start_s < to_s and duty.end_s > from_s
            ],
        )
        for rank, worker in enumerate(plan.workers)
    ]


def _part(start_s: float, end_s: float, from_s: float, to_s: float) -> tuple[float, float]:
    begin, end = np.clip([start_s, end_s], from_s, to_s)
    return float((begin - from_s) / (to_s - from_s)), float((end - from_s) / (to_s - from_s))


def _shares(
    log: EventLog, rows: np.ndarray, states: np.ndarray, rank: int, edges_s: np.ndarray
) -> dict[str, np.ndarray]:
    own = log["worker"][rows] == rank
    found = {}
    for state in BOTTOM_FIRST:
        mine = rows[own & (states == STATES.index(state))]
        if mine.size:
            found[state] = in_cells(log["start_s"][mine], log["end_s"][mine], edges_s) / np.diff(edges_s)
    return found


def in_cells(start_s: np.ndarray, end_s: np.ndarray, edges_s: np.ndarray) -> np.ndarray:
    """(C,) seconds of some stretches that do not overlap, in each of C cells."""
    order = np.argsort(start_s, kind="stable")
    times_s = np.column_stack([start_s[order], end_s[order]]).ravel()
    spent_s = np.cumsum(np.column_stack([np.zeros(order.size), (end_s - start_s)[order]]).ravel())
    return np.diff(np.interp(edges_s, times_s, spent_s, left=0.0))


def _posts(log: EventLog, plan: Plan, rank: int, edges_s: np.ndarray) -> Iterator[tuple[float, float, str]]:
    """Stretches in which most of his work was at one station, with its name."""
    rows = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] == rank) & (log["station"] >= 0))
    if not rows.size:
        return
    stations = np.unique(log["station"][rows])
    spent_s = np.array([_at(log, rows[log["station"][rows] == station], edges_s) for station in stations])
    window = max(1, (edges_s.size - 1) // 48)
    smooth = np.array([np.convolve(one, np.ones(2 * window + 1), "same") for one in spent_s])
    total_s = smooth.sum(axis=0)
    best = np.where((smooth.max(axis=0) >= MOSTLY * total_s) & (total_s > 0), stations[smooth.argmax(axis=0)], -1)
    best[spent_s.sum(axis=0) == 0] = np.where(total_s > 0, best, -1)[spent_s.sum(axis=0) == 0]
    n = best.size
    begins = np.flatnonzero(np.r_[True, best[1:] != best[:-1]])
    for begin, end in zip(begins, [*begins[1:], n]):
        if best[begin] >= 0:
            yield begin / n, end / n, plan.stations[best[begin]].name


def _at(log: EventLog, rows: np.ndarray, edges_s: np.ndarray) -> np.ndarray:
    return in_cells(log["start_s"][rows], log["end_s"][rows], edges_s)
