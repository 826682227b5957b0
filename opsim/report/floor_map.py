"""A floor to scale: where in a picture each place is, and where its name stands; drawn by ``floor_drawn``."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from typing import Any

from opsim.report.floor_spots import Spot, belts_of, roads_of, spots_of
from opsim.report.labels import Box, places, shared, shortened

Point = tuple[float, float]
Stretch = tuple[Point, Point]
WIDE, SMALL, LEAST_WIDE, MOST_TALL = 760.0, 340.0, 420.0, 520.0
"""Pixels: of a picture, of one of several beside each other, the least of one; and how deep a floor may be."""
HEAD, FOOT, SIZE, HALF_MARK, NUMBERED = 22.0, 46.0, 12.5, 5.0, 8.5
"""Room above and below the floor, letters, half of a sign, and half of one with a number."""
CROWDED = 60.0
"""Square pixels that two names may share before places are numbered instead."""
AROUND_M, AROUND_PX, MOST_PX_PER_M = 0.75, 26.0, 150.0
"""Floor shown around the outermost places, at least: room for who stands there; and how large a metre becomes."""


@dataclass(frozen=True)
class FloorMap:
    """A floor in a picture. roads, belts : stretches in metres; room : pixels that the picture may be wide

    named : spots with their names, None for all; bare : no signs at the others
    around_px : floor shown around the outermost places, at least
    """

    spots: tuple[Spot, ...]
    roads: tuple[Stretch, ...] = ()
    belts: tuple[Stretch, ...] = ()
    room: float = WIDE
    named: frozenset[Point] | None = None
    bare: bool = False
    around_px: float = AROUND_PX

    @cached_property
    def _span(self) -> tuple[float, float, float, float]:
        """Metres: left, bottom, right, top of all points."""
        xs, ys = zip(*(spot.at for spot in self.spots))
        return min(xs), min(ys), max(xs), max(ys)

    @cached_property
    def corners(self) -> tuple[float, float, float, float]:
        """Metres: left, bottom, right, top of the floor."""
        left, bottom, right, top = self._span
        more = max(AROUND_M, self.around_px / self.px_per_m)
        return left - more, bottom - more, right + more, top + more

    @cached_property
    def px_per_m(self) -> float:
        left, bottom, right, top = self._span
        rooms = (self.room - 2 * self.side, right - left), (MOST_TALL * self.room / WIDE, top - bottom)
        scales = [room / (long + 2 * AROUND_M) for room, long in rooms]
        scales += [(room - 2 * self.around_px) / long for room, long in rooms if long > 0]
        return min(MOST_PX_PER_M, *scales)

    @property
    def side(self) -> float:
        """The margin beside the floor."""
        return 0.03 * self.room

    @cached_property
    def wide(self) -> float:
        """Pixels of the picture: no more than a floor that is small, or deep, needs, but for what stands below it."""
        left, _, right, _ = self.corners
        return min(self.room, max(LEAST_WIDE, (right - left) * self.px_per_m + 2 * self.side))

    @cached_property
    def tall(self) -> float:
        """Pixels of the picture."""
        _, bottom, _, top = self.corners
        return (top - bottom) * self.px_per_m + 2 * HEAD + FOOT

    def at(self, point: Point) -> Point:
        """Pixels of a point in metres; y upwards on the floor and downwards in the picture."""
        left, bottom, right, top = self.corners
        middle = (self.tall - FOOT) / 2
        return (
            self.wide / 2 + (point[0] - (left + right) / 2) * self.px_per_m,
            middle - (point[1] - (bottom + top) / 2) * self.px_per_m,
        )

    def naming(self, points: Iterable[Point]) -> FloorMap:
        """The same floor with the names of these points alone."""
        return replace(self, named=frozenset(points))

    @property
    def key(self) -> str:
        """What the numbers stand for, in words; nothing where names stand in the picture."""
        names = [spot.name for spot in self.signed] if self.numbered else []
        return "; ".join(f"{number} {name}" for number, name in enumerate(names, 1))

    @cached_property
    def signed(self) -> list[Spot]:
        """The spots with a name in the picture."""
        return [spot for spot in self.spots if spot.name and (self.named is None or spot.at in self.named)]

    @property
    def numbered(self) -> bool:
        """Whether places have numbers, as their names would hide each other."""
        return self._placed[1]

    @property
    def marks(self) -> list[Box]:
        """What the signs of named spots cover."""
        half = NUMBERED if self.numbered else HALF_MARK + 1
        return [around(self.at(spot.at), half) for spot in self.signed]

    @property
    def taken(self) -> list[Box]:
        """What a number in the picture should not hide: signs and names."""
        return self.marks if self.numbered else [*self.marks, *self._names]

    @property
    def label_places(self) -> list[tuple[float, float, str]]:
        """Where the name of each signed spot stands."""
        return self._placed[0]

    @cached_property
    def _placed(self) -> tuple[list[tuple[float, float, str]], bool]:
        """Where the names stand, and whether they hide each other."""
        points = [self.at(spot.at) for spot in self.signed]
        marks = [around(point, HALF_MARK + 1) for point in points]
        found = places(points, [shortened(spot.name) for spot in self.signed], marks, self.wide)
        boxes = [_box(*place, len(shortened(spot.name))) for place, spot in zip(found, self.signed)]
        return found, any(shared(a, b) > CROWDED for a, b in combinations(boxes, 2))

    @property
    def _names(self) -> list[Box]:
        return [_box(*place, len(shortened(spot.name))) for place, spot in zip(self.label_places, self.signed)]


def names_of(of: FloorMap, plan: Any, layout: Any) -> list[str]:
    """What each place of a plan is called in words: by what stands there, as in the picture."""
    named = {spot.at: spot.name for spot in of.spots}
    return [shortened(named[tuple(layout.places[place])] or place) for place in plan.places]


def floor_map(plan: Any, layout: Any, room: float = WIDE) -> FloorMap | None:
    """The floor of a plan; None where all of it is one point, so that there is nothing to draw."""
    if len({tuple(at) for at in layout.places.values()}) < 2:
        return None
    return FloorMap(spots_of(plan, layout), roads_of(layout), belts_of(plan, layout), room)


def around(at: Point, half: float) -> Box:
    """A square about a point."""
    return at[0] - half, at[1] - half, at[0] + half, at[1] + half


def _box(x: float, y: float, anchor: str, letters: int) -> Box:
    """About what a name covers."""
    long = 0.56 * SIZE * letters
    left = x if anchor == "start" else x - long
    return left, y - 0.8 * SIZE, left + long, y + 0.2 * SIZE
