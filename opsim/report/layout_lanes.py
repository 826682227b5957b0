"""Ways along the axes drawn so that they can be told apart: beside each other in aisles, around what stands between.

Every way is as long as the rectilinear distance, but for one that has to go around something in its own row.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import inf

Point = tuple[float, float]
Box = tuple[float, float, float, float]
"""(left, top, right, bottom)"""
PORTS, LANES = (0.0, -6.0, 6.0), (0.0, -7.0, 7.0, -14.0, 14.0, -21.0, 21.0)
"""How far from the middle of a mark a line may leave it, and from the middle of an aisle it may run, in pixels."""
PER_BEND, THROUGH, BESIDE = 9.0, 400.0, 2.0
"""What a bend costs, and running through a mark, in pixels of overlap; what has to be free beside a line."""


@dataclass
class Lanes:
    """Lines drawn one after the other, the thickest first, each where it hides least.

    marks  : what stands on the floor; aisle_px : from a row, or column, of marks to the middle of the aisle beside it
    """

    marks: Sequence[Box]
    aisle_px: tuple[float, float]
    drawn: list[tuple[Point, Point, float]] = field(default_factory=list)

    def way(self, start: Point, end: Point, width: float) -> list[Point]:
        """The corners of the way that hides least; it is drawn from now on."""
        offers = [_plain(offer) for offer in _offers(start, end, self.aisle_px)]
        others = [mark for mark in self.marks if not _inside(start, mark) and not _inside(end, mark)]
        costs = [PER_BEND * (len(corners) - 2) + 0.05 * _length(corners) for corners in offers]
        best, least = offers[0], inf
        for n in sorted(range(len(offers)), key=lambda n: (round(costs[n], 3), n)):
            if costs[n] >= least:  # NOTE: what is drawn already only adds to it
                break
            cost = costs[n] + self._hidden(offers[n], others, width, least - costs[n])
            if cost < least - 1e-6:
                best, least = offers[n], cost
        self.drawn += [(a, b, width) for a, b in pairwise(best)]
        return best

    def _hidden(self, corners: list[Point], others: Sequence[Box], width: float, most: float) -> float:
        """What a way hides, or is hidden by; more than ``most`` need not be added up."""
        hidden = 0.0
        for a, b in pairwise(corners):
            hidden += THROUGH * sum(_hits(a, b, width, mark) for mark in others)
            if hidden >= most:
                break
            hidden += sum(_shared(a, b, c, d, (width + other) / 2 + BESIDE) for c, d, other in self.drawn)
        return hidden


def _offers(start: Point, end: Point, aisle: tuple[float, float]) -> Iterator[list[Point]]:
    """Ways with one corner or none, then those along an aisle, each in several lanes."""
    (x, y), (u, v) = start, end
    for port in PORTS:
        if abs(y - v) < 1:
            yield [(x, y + port), (u, y + port)]
        elif abs(x - u) < 1:
            yield [(x + port, y), (x + port, v)]
    for first in PORTS:
        for second in PORTS:
            yield [(x, y + first), (u + second, y + first), (u + second, v)]
            yield [(x + first, y), (x + first, v + second), (u, v + second)]
    for lane in LANES:
        for across in _aisles(x, u, aisle[0]):
            for up in _aisles(y, v, aisle[1]):
                yield [(x, y), (across + lane, y), (across + lane, up + lane), (u, up + lane), (u, v)]
                yield [(x, y), (x, up + lane), (across + lane, up + lane), (across + lane, v), (u, v)]
        for between in _aisles(y, v, aisle[1]):
            for first in PORTS:
                yield [(x + first, y), (x + first, between + lane), (u - first, between + lane), (u - first, v)]
        for between in _aisles(x, u, aisle[0]):
            for first in PORTS:
                yield [(x, y + first), (between + lane, y + first), (between + lane, v - first), (u, v - first)]


def _aisles(a: float, b: float, aisle: float) -> list[float]:
    """The middles of aisles beside each end, towards the other one; on both sides where both are in one row."""
    if abs(a - b) < 1:
        return [a - aisle, a + aisle]
    way = 1.0 if b > a else -1.0
    return [a + way * aisle, b - way * aisle] if abs(b - a) > aisle else []


def _plain(corners: list[Point]) -> list[Point]:
    """Without corners at which nothing turns."""
    kept = [corners[0]]
    for corner in corners[1:]:
        if corner != kept[-1]:
            kept.append(corner)
    return kept if len(kept) > 1 else [*kept, kept[0]]


def _length(corners: Sequence[Point]) -> float:
    return sum(abs(x - u) + abs(y - v) for (x, y), (u, v) in pairwise(corners))


def _inside(point: Point, box: Box) -> bool:
    return box[0] <= point[0] <= box[2] and box[1] <= point[1] <= box[3]


def _hits(a: Point, b: Point, width: float, box: Box) -> bool:
    half = width / 2
    left, right, top, bottom = min(a[0], b[0]), max(a[0], b[0]), min(a[1], b[1]), max(a[1], b[1])
    return left - half < box[2] and right + half > box[0] and top - half < box[3] and bottom + half > box[1]


def _shared(a: Point, b: Point, c: Point, d: Point, near: float) -> float:
    """How long two pieces run so near each other that one hides the other, in pixels; a crossing hides little."""
    for along, across in ((0, 1), (1, 0)):
        if abs(a[across] - b[across]) < 0.1 and abs(c[across] - d[across]) < 0.1:
            apart = abs(a[across] - c[across])
            both = min(max(a[along], b[along]), max(c[along], d[along])) - max(
                min(a[along], b[along]), min(c[along], d[along])
            )
            return max(0.0, both) * (1 - apart / near) if apart < near else 0.0
    return 0.0
