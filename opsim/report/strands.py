"""Lines for the ways that people walked: how thick, round which corner, with which numbers; as SVG."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise
from math import hypot

from opsim.report.floor_drawn import round_below, text_at
from opsim.report.floor_lines import Laid, rounded
from opsim.report.floor_map import HALF_MARK, NUMBERED, FloorMap
from opsim.report.floor_ways import FloorWays
from opsim.report.labels import Box, shared
from opsim.report.palette import ACCENT, INK, MUTED
from opsim.report.walked_ways import Pair

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
