"""Lines for the ways that people walked: how thick, round which corner, with which numbers; as SVG.

Spaghetti: the ways that people walked, drawn on the floor as thick as they were walked often; all, and of each.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from opsim.report.material import Material
from opsim.report.page import Block, Grid, Panels, Section, Svg, Words
from opsim.report.plot.floor_plan import (
    HALF_MARK,
    NUMBERED,
    SMALL,
    WIDE,
    FloorMap,
    FloorWays,
    floor_map,
    names_of,
    picture,
    round_below,
    text_at,
)
from opsim.report.plot.floor_plan_lines import Laid, rounded
from opsim.report.plot.plotly import ACCENT, INK, MUTED
from opsim.report.plot.svg_chart import Box, shared
from opsim.report.sections.common import Pair, WalkedWays, walked_ways, with_closed
from opsim.report.sections.walking import walk_sentences

if TYPE_CHECKING:
    from opsim.plan import Plan

Point = tuple[float, float]
THICKEST, THINNEST, FEW = 13.0, 1.2, 6.0
"""Pixels of a line; more lines as thick as the thickest than so many are drawn thinner, to be told apart."""
HIDDEN = 40.0
"""Square pixels of names and signs that a number may hide."""


@dataclass(frozen=True)
class WalkedFloor:
    """places : in the order of the plan; names : what each is called in words; ways : between them"""

    places: Sequence[str]
    names: Mapping[str, str]
    ways: FloorWays


@dataclass(frozen=True, slots=True)
class Thickness:
    """Of lines of which the one walked most has ``most`` trips an hour, and is ``thickest`` pixels wide."""

    most: float
    thickest: float

    def px(self, trips_per_h: float) -> float:
        """Of a line with so many trips an hour."""
        return max(THINNEST, self.thickest * trips_per_h / self.most)


def thickness_of(trips_per_h: Sequence[float]) -> Thickness:
    """So that lines with these trips can be told apart."""
    most = max(trips_per_h)
    return Thickness(most, THICKEST * min(1.0, (FEW * most / sum(trips_per_h)) ** 0.5))


@dataclass(frozen=True, slots=True)
class Strand:
    """A line in the picture, from place ``a`` to place ``b``; words : what it says"""

    a: str
    b: str
    words: str
    trips_per_h: float
    corners: Sequence[Point]


def trips_of(pairs: Sequence[Pair], floor: WalkedFloor, most: int) -> list[tuple[float, str, str]]:
    """(trips an hour, place, place), at most so many, the most walked first; along paths for each stretch of a path."""
    trips: dict[tuple[str, str], float] = {}
    for a, b, often, _ in pairs:
        for one, other in pairwise(floor.ways.passed(floor.places[a], floor.places[b])):
            key = (other, one) if (other, one) in trips else (one, other)
            trips[key] = trips.get(key, 0.0) + often
    shown = [(often, *key) for key, often in trips.items() if often > 0]
    return sorted(shown, key=lambda one: (-one[0], one[1:]))[:most]


def strands_of(
    trips: Sequence[tuple[float, str, str]], floor: WalkedFloor, on: FloorMap, thickness: Thickness
) -> list[Strand]:
    """A line each, in their order."""
    half = NUMBERED if on.numbered else HALF_MARK + 1
    along_axes = floor.ways.distance == "rectilinear"
    laid = Laid([on.at(spot.at) for spot in on.spots if spot.name], half) if along_axes else None
    found = []
    for often, one, other in trips:
        start, end = on.at(floor.ways.places[one]), on.at(floor.ways.places[other])
        corners = [start, end] if laid is None else laid.line(start, end, thickness.px(often))
        words = f"{floor.names[one]} – {floor.names[other]}: {count(often)} trips an hour"
        found.append(Strand(one, other, words, often, corners))
    return found


def count(trips: float) -> str:
    """Trips as people say them: whole ones where there are many."""
    return f"{trips:,.0f}" if trips >= 9.95 else f"{trips:.1f}" if trips >= 0.095 else f"{trips:.2g}"


def drawn_lines(strands: Sequence[Strand], thickness: Thickness) -> Iterator[str]:
    """The thinnest first: what is walked most lies above."""
    for one in reversed(strands):
        wide = thickness.px(one.trips_per_h)
        opacity = 0.4 + 0.35 * min(1.0, one.trips_per_h / (0.4 * thickness.most))
        yield (
            f'<path d="{rounded(one.corners)}" fill="none" stroke="{ACCENT}" stroke-width="{wide:.1f}" '
            f'stroke-opacity="{opacity:.2f}" stroke-linejoin="round"><title>{escape(one.words)}</title></path>'
        )


def drawn_numbers(strands: Sequence[Strand], taken: Sequence[Box]) -> Iterator[str]:
    """The trips an hour of some lines, where they hide no name and no other number."""
    there = list(taken)
    for one in strands:
        words = count(one.trips_per_h)
        half = 4.2 * len(words) + 3
        spots = list(_along(one.corners))
        boxes = [(x - half, y - 9, x + half, y + 9) for x, y in spots]
        costs = [sum(shared(box, other) for other in there) for box in boxes]
        best = min(range(len(spots)), key=lambda n: (costs[n], n))
        if costs[best] <= HIDDEN:
            there.append(boxes[best])
            yield text_at(words, spots[best][0], spots[best][1] + 4.5, INK, "middle", 13, halo=True, bold=True)


def _along(corners: Sequence[Point]) -> Iterator[Point]:
    """Points on a line and beside it, those in the middle of its longest piece first."""
    pieces = sorted(pairwise(corners), key=lambda ends: -hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]))
    for beside in (0.0, 15.0, -15.0):
        for a, b in pieces:
            level = abs(b[0] - a[0]) >= abs(b[1] - a[1])
            for part in (0.5, 0.36, 0.64, 0.22, 0.78):
                x, y = a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part
                yield (x, y + beside) if level else (x + beside, y)


def thickness_key(thickness: Thickness, on: FloorMap) -> Iterator[str]:
    """How thick how many trips are, below the floor."""
    y, x = on.tall - 24, on.wide - 172
    for trips in dict.fromkeys([round_below(thickness.most), round_below(thickness.most / 5)]):
        wide = thickness.px(trips)
        yield f'<path d="M{x:.0f} {y:.1f}h40" stroke="{ACCENT}" stroke-opacity="0.65" stroke-width="{wide:.1f}"/>'
        yield text_at(f"{trips:g} an hour", x + 20, y + 18, MUTED, "middle", 12)
        x += 86


SMALLER = 0.55
"""How much thinner lines are in small pictures."""
MOST_LINES, OWN_LINES, LABELLED = 40, 16, 6
"""Lines drawn, and of one worker; lines with their number."""
MOST_WORKERS, MOST_ROWS, MOST_NAMED = 6, 12, 7
"""Workers with a picture of their own, rows of the table, names in a small picture."""
HOW = {
    "rectilinear": "Ways go along the axes, nobody said round which corner; lines lie a little beside each other.",
    "euclidean": "Ways are straight.",
    "paths": "Trips add up on each stretch of a path.",
}


def spaghetti_section(material: Material) -> Section | None:
    """None where no rows are kept, nobody goes anywhere, or all places are one."""
    if material.log is None or not material.plan.workers:
        return None
    layout, plan = material.loaded.scenario.layout, material.plan
    large, small = (floor_map(plan, layout, wide) for wide in (WIDE, SMALL))
    walked = walked_ways(material.log, plan)
    if large is None or small is None or not any(trips > 0 for *_, trips, _ in walked.by_pair()):
        return None
    names = names_of(large, plan, layout)
    floor = WalkedFloor(plan.places, dict(zip(plan.places, names)), FloorWays(layout))
    blocks: list[Block] = [*map(Words, walk_sentences(walked, plan, names, material.rows("walked_m")))]
    blocks.append(together(walked, floor, large, with_closed(plan)))
    if len(walked.by_pair()) > 1:
        blocks += own_pictures(walked, [worker.name for worker in plan.workers], floor, small)
    return Section("ways", "Ways that people walk", [*blocks, _table(walked, plan, names)], "Ways")


def together(walked: WalkedWays, floor: WalkedFloor, on: FloorMap, hours: str = "") -> Svg:
    """The picture of everybody's ways. hours : which ones are meant by 'an hour', in words"""
    trips = trips_of(walked.by_pair(), floor, MOST_LINES)
    thickness = thickness_of([often for often, *_ in trips])
    strands = strands_of(trips, floor, on, thickness)
    drawn = [*drawn_lines(strands, thickness), *drawn_numbers(strands[:LABELLED], on.taken)]
    said = f"The ways walked most: {'; '.join(one.words for one in strands[:LABELLED])}"
    caption = _caption(len(strands), on, floor.ways.distance, hours)
    return Svg(picture(on, drawn, said, thickness_key(thickness, on)), said, caption=caption, wide=True)


def own_pictures(walked: WalkedWays, workers: Sequence[str], floor: WalkedFloor, small: FloorMap) -> list[Block]:
    """A small picture of each worker, those who walk most; none where only one walks. small : the floor for them"""
    metres = walked.by_worker(len(workers))
    first = sorted(range(len(workers)), key=lambda rank: (-metres[rank], rank))[:MOST_WORKERS]
    own = {rank: walked.where(walked.worker == rank).by_pair() for rank in sorted(first)}
    trips = {rank: found for rank, pairs in own.items() if (found := trips_of(pairs, floor, OWN_LINES))}
    if len(trips) < 2:
        return []
    thickness = Thickness(max(found[0][0] for found in trips.values()), SMALLER * THICKEST)
    of = "who walk most" if np.count_nonzero(metres) > len(trips) else "who walk"
    note = f"Those {of}; all to one scale, with the names of the places where each goes most."
    shown = [
        _own(
            f"{workers[rank]}, {metres[rank]:,.0f} m an hour",
            strands_of(found, floor, small, thickness),
            thickness,
            floor,
            small,
        )
        for rank, found in trips.items()
    ]
    return [Panels(shown), Words(note)]


def _own(title: str, strands: Sequence[Strand], thickness: Thickness, floor: WalkedFloor, on: FloorMap) -> Svg:
    said = f"{title}; {'; '.join(one.words for one in strands[:3])}"
    names = dict.fromkeys(place for one in strands for place in (one.a, one.b))
    named = on.naming(floor.ways.places[place] for place in list(names)[:MOST_NAMED])
    return Svg(picture(named, drawn_lines(strands, thickness), said, thickness_key(thickness, on)), said, title)


def _caption(lines: int, on: FloorMap, distance: str, hours: str) -> str:
    few = f" The {MOST_LINES} walked most are drawn." if lines == MOST_LINES else ""
    key = f" Places: {on.key}." if on.numbered else ""
    return (
        "In the first replication, both ways together: a line is as thick as it is walked often, and the numbers are "
        f"trips an hour{hours}. {HOW[distance]}{few}{key}"
    )


def _table(walked: WalkedWays, plan: Plan, names: Sequence[str]) -> Grid:
    pairs = walked.by_pair()
    rows = [
        (
            f"{names[a]} – {names[b]}",
            _by_whom(walked, a, b, plan),
            count(trips),
            f"{plan.distance_m[a][b]:.1f}",
            f"{metres:,.0f}",
        )
        for a, b, trips, metres in pairs[:MOST_ROWS]
    ]
    left = len(pairs) - len(rows)
    title = "The ways walked most" + (f"; {left} more are walked less" if left else "")
    return Grid(("Between", "Mostly by", "trips an hour", "m each", "m an hour"), rows, title, words=2, folded=True)


def _by_whom(walked: WalkedWays, a: int, b: int, plan: Plan) -> str:
    """The one who goes most there, and how much of it is his."""
    rank, share = next(walked.shares(a, b))
    return plan.workers[rank].name + ("" if share > 0.995 else f" ({100 * share:.0f} %)")
