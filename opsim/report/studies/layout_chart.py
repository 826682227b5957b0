"""Ways along the axes drawn so that they can be told apart: beside each other in aisles, around what stands between.

Every way is as long as the rectilinear distance, but for one that has to go around something in its own row.

Spaghetti diagrams: what stands where, to scale, and lines as thick as people go between; as SVG.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from itertools import combinations, pairwise
from math import floor, hypot, inf, log10

from opsim.report.plot.floor_plan_lines import rounded
from opsim.report.plot.plotly import ACCENT, INK, MUTED

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


WIDE, MARGIN, HEAD, FOOT, LETTER, SIZE = 560.0, 62.0, 34.0, 58.0, 7.9, 15
MOST_TALL, LEAST_TALL = 620.0, 90.0
THICKEST, THINNEST, HALF_MARK = 15.0, 1.2, 13.0
LABELLED = 5
"""Lines that carry their number: the thickest."""
DRIVEN = "#B34E00"
NARROW, WIDE_ONES = "iljtfrI|.,:;'() ", "mwMW@%"


@dataclass(frozen=True, slots=True)
class Line:
    """Trips an hour between two places, both ways together; by vehicles or by people."""

    start: str
    end: str
    trips_per_h: float
    driven: bool = False


@dataclass(frozen=True)
class Drawing:
    """A layout to draw.

    title    : above it; places : x, y in metres; names : what stands at a place, in words
    moved    : places whose stations are not where they were; others : places of what is no station
    distance : ``rectilinear``, ``euclidean`` or ``paths``; ways : with paths, the places passed between two
    """

    title: str
    places: Mapping[str, Point]
    names: Mapping[str, str]
    lines: Sequence[Line]
    distance: str = "rectilinear"
    moved: frozenset[str] = frozenset()
    others: Mapping[str, str] = field(default_factory=dict)
    ways: Mapping[tuple[str, str], Sequence[str]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class _Scale:
    """From metres to pixels, y upwards on the floor and downwards in the picture."""

    left_m: float
    top_m: float
    px_per_m: float
    tall: float

    def at(self, point: Point) -> Point:
        return MARGIN + (point[0] - self.left_m) * self.px_per_m, HEAD + 44 + (self.top_m - point[1]) * self.px_per_m


def layout_pictures(drawings: Sequence[Drawing]) -> str:
    """The drawings beside each other where there is room, all to one scale, with lines on one scale too."""
    corners = [point for one in drawings for point in one.places.values()]
    scale = _scale(corners)
    most = max((line.trips_per_h for one in drawings for line in _drawn_lines(one)), default=1.0)
    room = min(_room([scale.at(point) for point in one.places.values()]) for one in drawings)
    pictures = "".join(f"<div>{_svg(one, scale, most, room)}</div>" for one in drawings)
    return f'<div class="panels">{pictures}</div>'


def _scale(corners: Sequence[Point]) -> _Scale:
    xs, ys = [x for x, _ in corners], [y for _, y in corners]
    wide_m, tall_m = max(xs) - min(xs), max(ys) - min(ys)
    room = WIDE - 2 * MARGIN
    px = min(room / wide_m if wide_m else 1e9, (MOST_TALL - HEAD) / tall_m if tall_m else 1e9)
    px = 1.0 if px > 1e8 else px
    left_m = min(xs) - (room / px - wide_m) / 2
    return _Scale(left_m, max(ys), px, max(LEAST_TALL, tall_m * px + 80) + HEAD + FOOT)


def _svg(one: Drawing, scale: _Scale, most: float, room: float) -> str:
    """room : pixels that a name may be wide, the same in all drawings, so that names are shortened alike."""
    at = {place: scale.at(point) for place, point in one.places.items()}
    marks = {place: _mark_box(at[place], _short(_name(one, place), room)) for place in one.places}
    lines = _drawn_lines(one)
    ways = _ways(one, lines, at, list(marks.values()), most)
    drawn = [
        _text(one.title, 4, 20, INK, "start", ' font-weight="650" font-size="16"'),
        *_lines(lines, ways, most),
        *(part for place in one.places for part in _mark(one, place, at[place], marks[place], room)),
        *_numbers(lines, ways, list(marks.values())),
        *_foot(scale, most),
    ]
    said = "; ".join(f"{line.start} and {line.end}: {line.trips_per_h:.0f} trips an hour" for line in lines[:LABELLED])
    label = escape(f"{one.title}. The most: {said}", quote=True)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE:.0f} {scale.tall:.0f}" role="img" '
        f'font-size="{SIZE}" style="width:100%;max-width:640px;height:auto" aria-label="{label}">{"".join(drawn)}</svg>'
    )


def _drawn_lines(one: Drawing) -> list[Line]:
    """The thickest first; along paths, trips add up on every piece of a path."""
    if one.distance != "paths":
        return sorted(one.lines, key=lambda line: (-line.trips_per_h, line.start, line.end))
    total: dict[tuple[str, str, bool], float] = {}
    for line in one.lines:
        passed = one.ways.get((line.start, line.end), (line.start, line.end))
        for a, b in pairwise(passed):
            key = (min(a, b), max(a, b), line.driven)
            total[key] = total.get(key, 0.0) + line.trips_per_h
    found = [Line(a, b, trips, driven) for (a, b, driven), trips in total.items()]
    return sorted(found, key=lambda line: (-line.trips_per_h, line.start, line.end))


def _ways(
    one: Drawing, lines: Sequence[Line], at: Mapping[str, Point], marks: Sequence[Box], most: float
) -> list[list[Point]]:
    if one.distance != "rectilinear":
        return [[at[line.start], at[line.end]] for line in lines]
    lanes = Lanes(marks, _aisle_span(list(at.values())))
    return [lanes.way(at[line.start], at[line.end], _width(line.trips_per_h, most)) for line in lines]


def _lines(lines: Sequence[Line], ways: Sequence[list[Point]], most: float) -> Iterator[str]:
    for line, corners in zip(lines, ways):
        colour, dash = (DRIVEN, ' stroke-dasharray="9 6"') if line.driven else (ACCENT, "")
        wide = _width(line.trips_per_h, most)
        title = f"{line.start}, {line.end}: {line.trips_per_h:.1f} trips an hour"
        opacity = 0.8 if line.driven else 0.35 + 0.3 * min(1.0, wide / 6)
        yield (
            f'<path d="{rounded(corners, most=9.0)}" fill="none" stroke="{colour}" stroke-width="{wide:.1f}" '
            f'stroke-opacity="{opacity:.2f}" stroke-linejoin="round"{dash}><title>{escape(title)}</title></path>'
        )


def _numbers(lines: Sequence[Line], ways: Sequence[list[Point]], marks: Sequence[Box]) -> Iterator[str]:
    """The trips an hour of the thickest lines, where the longest piece of each is free."""
    taken: list[Box] = [*marks, *((left, bottom, right, bottom + 18) for left, _, right, bottom in marks)]
    for line, corners in list(zip(lines, ways))[:LABELLED]:
        words = f"{line.trips_per_h:.0f}"
        half = LETTER * len(words) / 2 + 3
        pieces = sorted(pairwise(corners), key=lambda ends: -hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]))
        spots = [
            (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t)
            for a, b in pieces
            for t in (0.5, 0.35, 0.65, 0.22, 0.78)
        ]
        boxes = [(x - half, y - 10, x + half, y + 10) for x, y in spots]
        best = min(range(len(spots)), key=lambda n: (sum(_overlap(boxes[n], other) for other in taken), n))
        taken.append(boxes[best])
        x, y = spots[best]
        yield _text(words, x, y + 5, INK, "middle", _HALO + ' font-weight="600" font-size="14"')


_HALO = ' paint-order="stroke" stroke="#ffffff" stroke-width="4" stroke-linejoin="round"'


def _mark(one: Drawing, place: str, at: Point, box: Box, room: float) -> Iterator[str]:
    """A station as a box with its name (filled where it was moved), what else is there and free places more quietly."""
    left, top, right, bottom = box
    short = _short(_name(one, place), room)
    station, moved = place in one.names, place in one.moved
    fill, ink, edge = (
        (INK, "#ffffff", INK) if moved else ("#ffffff", INK, INK) if station else ("#ffffff", MUTED, "#aab0b8")
    )
    dash = "" if station or place in one.others else ' stroke-dasharray="3 3"'
    weight = 1.6 if station else 1.0
    yield (
        f"<g><title>{escape(f'{place}: {_name(one, place)}' if station else place)}</title>"
        f'<rect x="{left:.1f}" y="{top:.1f}" width="{right - left:.1f}" height="{bottom - top:.1f}" rx="4" '
        f'fill="{fill}" stroke="{edge}" stroke-width="{weight}"{dash}/>'
        f"{_text(short, at[0], at[1] + 5, ink, 'middle')}</g>"
    )
    if station:
        yield _text(_short(place, room), at[0], bottom + 13, MUTED, "middle", f'{_HALO} font-size="12"')


def _foot(scale: _Scale, most: float) -> Iterator[str]:
    """A bar of so many metres, and how thick how many trips are."""
    metres = _round_below((WIDE - 2 * MARGIN) / 3 / scale.px_per_m)
    y, long = scale.tall - 22, metres * scale.px_per_m
    bar = f"M20 {y - 5}V{y + 5}M20 {y}H{20 + long:.1f}M{20 + long:.1f} {y - 5}V{y + 5}"
    yield f'<path d="{bar}" stroke="{INK}" fill="none"/>'
    yield _text(f"{metres:g} m", 20 + long / 2, y + 18, MUTED, "middle", ' font-size="13"')
    many = [_round_below(most), _round_below(most / 5)]
    x = WIDE - 170.0
    for trips in dict.fromkeys(many):
        wide = _width(trips, most)
        yield f'<path d="M{x:.0f} {y}h46" stroke="{ACCENT}" stroke-opacity="0.55" stroke-width="{wide:.1f}"/>'
        yield _text(f"{trips:g} an hour", x + 23, y + 18, MUTED, "middle", ' font-size="13"')
        x += 92


def _name(one: Drawing, place: str) -> str:
    return one.names.get(place) or one.others.get(place) or place


def _mark_box(at: Point, short: str) -> Box:
    half = max(18.0, _wide(short) / 2 + 8)
    return at[0] - half, at[1] - HALF_MARK, at[0] + half, at[1] + HALF_MARK


def _room(points: Sequence[Point]) -> float:
    """Pixels a name may be wide: as far as the nearest mark in about the same row."""
    apart = [abs(a[0] - b[0]) for a, b in combinations(points, 2) if abs(a[1] - b[1]) < 2 * HALF_MARK and a != b]
    return max(44.0, min([2 * MARGIN - 6, *(one - 8 for one in apart)]))


def _short(name: str, room: float) -> str:
    if _wide(name) <= room - 16:
        return name
    for most in range(len(name), 3, -1):
        tail = most // 3  # the ends of names often tell them apart: station 11, station 12
        short = f"{name[: most - 1 - tail]}…{name[len(name) - tail :]}"
        if _wide(short) <= room - 16:
            return short
    return f"{name[:1]}…{name[-1:]}"


def _wide(text: str) -> float:
    """Pixels that a text is wide at most, in the wider fonts that browsers take where a page names none."""
    return LETTER * sum(map(_letters, text))


def _letters(letter: str) -> float:
    """How wide a letter is, in ``LETTER``."""
    if letter in NARROW:
        return 0.7
    if letter in WIDE_ONES or ord(letter) > 0x2000:
        return 1.95
    return 1.45 if letter.isupper() else 1.25


def _aisle_span(points: Sequence[Point]) -> tuple[float, float]:
    """Half of the least distance between columns, and between rows."""

    def half(values: list[float]) -> float:
        apart = [b - a for a, b in pairwise(sorted(set(values))) if b - a > 2 * HALF_MARK]
        return min(apart, default=2 * 34.0) / 2

    return half([round(x) for x, _ in points]), half([round(y) for _, y in points])


def _width(trips: float, most: float) -> float:
    return max(THINNEST, THICKEST * trips / most)


def _round_below(value: float) -> float:
    """The largest of 1, 2, 5, 10, ... that is not above."""
    if value <= 0:
        return 1.0
    size = 10.0 ** floor(log10(value))
    return next(size * nice for nice in (5, 2, 1) if size * nice <= value * (1 + 1e-9))


def _overlap(a: Box, b: Box) -> float:
    across, down = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    return max(0.0, across) * max(0.0, down)


def _text(words: str, x: float, y: float, colour: str, anchor: str, more: str = "") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}"{more}>{escape(words)}</text>'
