"""People through the day: a strip a worker, on which each stretch of time is filled by what he did in it.

What people did through the first replication, as strips over the clock.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from opsim.kpi.states import STATES, states_of_rows
from opsim.log import SETUP, WORK, EventLog
from opsim.plan import Plan
from opsim.report.material import Material
from opsim.report.numbers import clock, quantity
from opsim.report.page import Picture, Section, Words
from opsim.report.plot.plotly import GRID, INK, MUTED, OTHER, STATE_COLOURS, WORDS
from opsim.report.plot.plotly import WORDS as STATE_WORDS

WIDE, LEFT, RIGHT, STRIP, ROW, TOP = 1180, 128, 14, 22, 40, 34
"""Of the picture, in its own units: all of it, its margins, a strip, a strip with the words below it, and above all."""
GONE = ("off",)
"""A line instead of a strip: who is not there leaves the place white, so that those who are stand out."""
PAUSE, PAUSED = "#b9a7d6", "in a break, a meeting or at rest (hatched)"
HATCH = (
    '<defs><pattern id="pause" width="6" height="6" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
    f'<rect width="6" height="6" fill="#f1edf8"/><rect width="2" height="6" fill="{PAUSE}"/></pattern></defs>'
)
LETTER = 6.0
LONGEST_NAME = 18
FONT = "system-ui,-apple-system,'Segoe UI',Roboto,'DejaVu Sans',sans-serif"


@dataclass(frozen=True, eq=False)
class Strip:
    """One worker. shares : by state, (C,) of each of C even stretches of the time shown; bottom first

    posts : (from, to, words) of stretches in which he was mostly in one place, as shares of the time shown
    shifts : (from, to) of his shifts, as such shares; pauses : of his breaks, meetings and rests, where these are
        shown as no state
    """

    worker: str
    shares: dict[str, np.ndarray]
    posts: Sequence[tuple[float, float, str]] = ()
    shifts: Sequence[tuple[float, float]] = ()
    pauses: Sequence[tuple[float, float]] = ()


def draw_day(strips: Sequence[Strip], start: str, from_s: float, to_s: float) -> bytes:
    """The strips one below the other over a clock, as SVG; the same bytes for the same strips.

    start : when the run began, as the scenario says it; from_s, to_s : the time shown, in seconds from there
    """
    tall = TOP + ROW * len(strips) + 10
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} {tall}" width="{WIDE}" height="{tall}" '
        f'font-family="{FONT}">',
        f'<rect width="{WIDE}" height="{tall}" fill="#ffffff"/>',
        *([HATCH] if any(strip.pauses for strip in strips) else []),
        *_clock(start, from_s, to_s, tall),
    ]
    for row, strip in enumerate(strips):
        parts += _strip(strip, TOP + ROW * row + 4)
    return "\n".join([*parts, "</svg>"]).encode()


def _x(share: float) -> float:
    return LEFT + share * (WIDE - LEFT - RIGHT)


def _clock(start: str, from_s: float, to_s: float, tall: int) -> Iterator[str]:
    """A line an hour, and its words where there is room."""
    length_s = to_s - from_s
    every_s = next((s for s in (600, 1800, 3600, 7200, 14400, 21600, 43200, 86400) if length_s / s <= 17), 86400)
    at_s = from_s + (-_seconds_of_day(start, from_s)) % every_s
    while at_s <= to_s:
        x = _x((at_s - from_s) / length_s)
        yield f'<path d="M{x:.1f} {TOP - 6}V{tall - 8}" stroke="{GRID}"/>'
        last = x > WIDE - 3 * RIGHT
        words = _hour(start, at_s, first=at_s - from_s < every_s, last=last)
        yield _text(words, x, TOP - 12, MUTED, "end" if last else "middle", 12)
        at_s += every_s


def _hour(start: str, at_s: float, *, first: bool, last: bool) -> str:
    """``07:00``, with the day at first and where one begins; hours since a start that says no time of the day."""
    day, _, time = clock(start, at_s).partition(" ")
    if time.count(":") != 1 or len(time) != 5:
        return f"{at_s / 3600:g} h"
    return f"{day} {time}" if (first or time == "00:00") and not last else time


def _seconds_of_day(start: str, at_s: float) -> float:
    """Seconds since the last full hour that everybody knows: midnight, where the start says a time of the day."""
    words = clock(start, 0).split()
    hours, _, minutes = words[-1].partition(":")
    known = len(words) == 2 and hours.isdigit() and minutes.isdigit()
    return (int(hours) * 3600 + int(minutes) * 60 if known else 0) + at_s


def _strip(strip: Strip, top: float) -> Iterator[str]:
    short = strip.worker if len(strip.worker) <= LONGEST_NAME else strip.worker[: LONGEST_NAME - 1] + "…"
    yield _text(short, LEFT - 10, top + STRIP - 6, INK, "end", 13)
    for begin, end in strip.pauses:
        wide = max(_x(end) - _x(begin), 1.0)
        yield f'<rect x="{_x(begin):.1f}" y="{top}" width="{wide:.1f}" height="{STRIP}" fill="url(#pause)"/>'
    below: np.ndarray | float = 0.0
    for state, shares in strip.shares.items():
        above = below + shares
        gone = state in GONE
        low, high = (0.5 - 0.12 * shares, 0.5 + 0.12 * shares) if gone else (below, above)
        yield f'<path d="{_area(low, high, top)}" fill="{STATE_COLOURS.get(state, OTHER)[0]}"/>'
        below = below if gone else above
    for begin, end in strip.shifts:
        yield f'<path d="M{_x(begin):.1f} {top + STRIP + 2}H{_x(end):.1f}" stroke="{INK}" stroke-width="1.5"/>'
    for begin, end, words in strip.posts:
        room = int((_x(end) - _x(begin)) / LETTER)
        if len(words) <= room:
            yield _text(words, (_x(begin) + _x(end)) / 2, top + STRIP + 13, MUTED, "middle", 11)


def _area(below: np.ndarray | float, above: np.ndarray, top: float) -> str:
    """The steps between two courses of shares: a rectangle for each run of stretches that are alike."""
    low, high = np.broadcast_to(below, above.shape), above
    n = above.size
    edges = np.flatnonzero(np.r_[True, (np.abs(np.diff(low)) > 1e-3) | (np.abs(np.diff(high)) > 1e-3)])
    path = []
    for begin, end in zip(edges, [*edges[1:], n]):
        if high[begin] - low[begin] > 1e-3:
            y, height = top + STRIP * (1 - high[begin]), STRIP * (high[begin] - low[begin])
            path.append(f"M{_x(begin / n):.1f} {y:.1f}H{_x(end / n):.1f}v{height:.1f}H{_x(begin / n):.1f}z")
    return "".join(path)


def _text(words: str, x: float, y: float, colour: str, anchor: str, size: int) -> str:
    said = escape(words, quote=False)
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}" font-size="{size}">{said}</text>'


def legend(strips: Sequence[Strip]) -> list[tuple[str, str]]:
    """(colour, words) of the states that the strips show, bottom first."""
    seen = {state for strip in strips for state, shares in strip.shares.items() if shares.any()}
    order = dict.fromkeys(state for strip in strips for state in strip.shares)
    paused = [(PAUSE, PAUSED)] if any(strip.pauses for strip in strips) else []
    return [(STATE_COLOURS.get(state, OTHER)[0], WORDS.get(state, state)) for state in order if state in seen] + paused


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


def worker_timeline_section(material: Material) -> Section | None:
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
