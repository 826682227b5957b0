"""A floor to scale: where in a picture each place is, and where its name stands; drawn by ``floor_drawn``.

The floor as SVG: its ground, paths and belts, signs with names or numbers, and a bar of metres.

What a picture shows on it (ways, heat, circles) lies between the ground and the signs.

Ways over the floor as lines: which points one passes between two places of a layout.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from html import escape
from itertools import combinations
from math import floor, log10
from typing import TYPE_CHECKING, Any

from opsim.layout import Ways, ways
from opsim.report.plot.floor_plan_lines import OTHER, STATION, STORE, Spot, belts_of, roads_of, spots_of
from opsim.report.plot.plotly import INK, MUTED
from opsim.report.plot.svg_chart import Box, places, shared, shortened

if TYPE_CHECKING:
    from opsim.plan import Plan

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


def names_of(of: FloorMap, plan: Plan, layout: Any) -> list[str]:
    """What each place of a plan is called in words: by what stands there, as in the picture."""
    named = {spot.at: spot.name for spot in of.spots}
    return [shortened(named[tuple(layout.places[place])] or place) for place in plan.places]


def floor_map(plan: Plan, layout: Any, room: float = WIDE) -> FloorMap | None:
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


FLOOR, EDGE, PATH = "#f7f8fa", "#d9dde3", "#d3d8df"
HALO = ' paint-order="stroke" stroke="#ffffff" stroke-width="3.5" stroke-linejoin="round"'
LOOKS = {STATION: (INK, "#ffffff", "#ffffff"), STORE: ("#ffffff", INK, INK), OTHER: ("#ffffff", MUTED, MUTED)}
"""Fill, edge, and ink of a number, by what stands at a place."""


def picture(of: FloorMap, drawn: Iterable[str], said: str, foot: Iterable[str] = ()) -> str:
    """The whole picture. drawn : what is shown on the floor; foot : beside the bar of metres"""
    body = "".join([*_ground(of), *drawn, *_signs(of), *_bar(of), *foot])
    least = f"min-width:{0.8 * of.wide:.0f}px;" if of.room >= WIDE else ""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {of.wide:.0f} {of.tall:.0f}" '
        f'role="img" font-size="{SIZE}" style="width:100%;{least}max-width:{1.3 * of.wide:.0f}px;height:auto" '
        f'aria-label="{escape(said, quote=True)}">{body}</svg>'
    )


def text_at(
    words: str, x: float, y: float, colour: str, anchor: str, size: float = SIZE, halo: bool = False, bold: bool = False
) -> str:
    """A text; what is in it is no markup."""
    more = (HALO if halo else "") + (' font-weight="600"' if bold else "")
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}" font-size="{size:g}"{more}>'
        f"{escape(words)}</text>"
    )


def round_below(value: float) -> float:
    """The largest of 1, 2, 5, 10, ... (or 0.5, 0.2, ...) that is not above."""
    if value <= 0:
        return 1.0
    size = 10.0 ** floor(log10(value))
    return float(f"{next(size * nice for nice in (5, 2, 1) if size * nice <= value * (1 + 1e-9)):.3g}")


def _ground(of: FloorMap) -> Iterator[str]:
    left, bottom, right, top = of.corners
    (x, y), (u, v) = of.at((left, top)), of.at((right, bottom))
    yield (
        f'<rect x="{x:.1f}" y="{y:.1f}" width="{u - x:.1f}" height="{v - y:.1f}" rx="4" fill="{FLOOR}" '
        f'stroke="{EDGE}"/>'
    )
    yield from _lines(of, of.roads, f'stroke="{PATH}" stroke-width="7" stroke-linecap="round"')
    yield from _lines(of, of.belts, f'stroke="{PATH}" stroke-width="9"')
    yield from _lines(of, of.belts, 'stroke="#ffffff" stroke-width="5" stroke-dasharray="3 4"')


def _lines(of: FloorMap, stretches: Sequence[Stretch], style: str) -> Iterator[str]:
    if stretches:
        path = "".join("M{:.1f} {:.1f}L{:.1f} {:.1f}".format(*of.at(a), *of.at(b)) for a, b in stretches)
        yield f'<path d="{path}" fill="none" {style}/>'


def _signs(of: FloorMap) -> Iterator[str]:
    """A mark each spot, and its name or number: on white, so that they are read on whatever is drawn below."""
    for spot in of.spots:
        if spot not in of.signed and not of.bare:
            x, y = of.at(spot.at)
            yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{3 if spot.name else 1.8}" fill="{MUTED}" stroke="#ffffff"/>'
    for number, (spot, (x, y, anchor)) in enumerate(zip(of.signed, of.label_places), 1):
        yield _mark(spot, of.at(spot.at), str(number) if of.numbered else "")
        if not of.numbered:
            yield text_at(shortened(spot.name), x, y, MUTED if spot.kind == OTHER else INK, anchor, halo=True)


def _mark(spot: Spot, at: Point, number: str) -> str:
    """A square for a station, a round for a store, a quiet one for a place."""
    left, top, right, bottom = around(at, NUMBERED if number else HALF_MARK)
    fill, edge, ink = LOOKS[spot.kind]
    shape = (
        f'<rect x="{left:.1f}" y="{top:.1f}" width="{right - left:.1f}" height="{bottom - top:.1f}" '
        f'rx="{1.5 if spot.kind == STATION else (right - left) / 2:.1f}" fill="{fill}" stroke="{edge}" '
        f'stroke-width="1.3"/>'
    )
    words = text_at(number, at[0], at[1] + 4, ink, "middle", 11, bold=True) if number else ""
    return f"<g><title>{escape(spot.name)}</title>{shape}{words}</g>"


def _bar(of: FloorMap) -> Iterator[str]:
    """So many metres."""
    metres = round_below((of.wide - 2 * of.side) / 4 / of.px_per_m)
    y, end = of.tall - 24, 14 + metres * of.px_per_m
    bar = f"M14 {y - 5:.1f}V{y + 5:.1f}M14 {y:.1f}H{end:.1f}M{end:.1f} {y - 5:.1f}V{y + 5:.1f}"
    yield f'<path d="{bar}" stroke="{INK}" fill="none"/>'
    yield text_at(f"{metres:g} m", (14 + end) / 2, y + 18, MUTED, "middle", 12)


Line = tuple[Point, ...]


class FloorWays:
    """Of a layout. distance : how a way is measured; places : points in metres by name"""

    def __init__(self, layout: Any) -> None:
        self.distance: str = layout.distance
        self.places: dict[str, Point] = {name: tuple(at) for name, at in layout.places.items()}
        self._layout = layout

    @cached_property
    def _ways(self) -> Ways:
        return ways(self._layout)

    def passed(self, start: str, end: str) -> tuple[str, ...]:
        """The places on the way, both ends included."""
        if self.distance != "paths" or start == end:
            return (start, end)
        return self._ways.way(start, end)

    def line(self, start: str, end: str) -> Line:
        """The points of the way in metres; along the axes first along x, as the replay walks it."""
        if self.distance != "rectilinear":
            return tuple(self.places[name] for name in self.passed(start, end))
        (x, y), (u, v) = self.places[start], self.places[end]
        return ((x, y), (u, v)) if x == u or y == v else ((x, y), (u, y), (u, v))
