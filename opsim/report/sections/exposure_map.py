"""A circle at each station as large as people are there at a high score, with its name and minutes; as SVG.

Exposure on the floor: at each station how long people are there at a high score, over all replications.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from html import escape
from itertools import combinations
from math import hypot, isfinite, sqrt
from typing import TYPE_CHECKING, Any

from opsim.report.material import Material
from opsim.report.numbers import digits, half_digits, listing
from opsim.report.page import Section, Svg, Words
from opsim.report.plot.floor_plan import FOOT, FloorMap, around, floor_map, picture, round_below, text_at
from opsim.report.plot.plotly import INK, MUTED
from opsim.report.plot.svg_chart import Box, shared, shortened
from opsim.report.sections.exposure_summary import FIVE, NOWHERE, PERHAPS, SEVEN, Bar, bars_by
from opsim.subjects.tasks.warnings import has_body

if TYPE_CHECKING:
    from opsim.plan import Plan

LEAST_PX, MOST_PX, UNKNOWN_PX, FOOT_PX = 12.0, 34.0, 9.0, 20.0
"""Radius of the largest circle, by how near stations are to each other; of a sign for what is not known; of the largest
in the key."""
LETTER, LINE = 7.2, 15.0
UNKNOWN = ("#ffffff", "nothing known of the postures there")


@dataclass(frozen=True, slots=True)
class Circle:
    """A station in the picture. bar : minutes, None where nothing is known; open_tasks : at which nothing is known"""

    name: str
    at: tuple[float, float]
    radius: float
    bar: Bar | None
    open_tasks: tuple[str, ...] = ()


def circles_of(bars: dict[str, Bar], plan: Plan, layout: Any, on: FloorMap) -> list[Circle]:
    """One for each station at which people work; those at one place stand beside each other."""
    most = max(bar.most for name, bar in bars.items() if name != NOWHERE)
    largest = _largest(on)
    by_place: dict[tuple[float, float], list[Circle]] = {}
    for station in plan.stations:
        tasks = [plan.tasks[rank] for rank in station.tasks if not plan.tasks[rank].automatic]
        if tasks:
            unseen = tuple(task.name for task in tasks if not has_body(task))
            bar = bars.get(station.name) if len(unseen) < len(tasks) else None
            radius = UNKNOWN_PX if bar is None else largest * sqrt(bar.most / most)
            at = tuple(layout.places[plan.places[station.place]])
            by_place.setdefault(at, []).append(Circle(station.name, (0.0, 0.0), radius, bar, unseen))
    return [circle for at, here in by_place.items() for circle in _beside(here, on.at(at), on.wide)]


def _beside(circles: Sequence[Circle], at: tuple[float, float], most_x: float) -> Iterator[Circle]:
    """In a row about a point, within the picture."""
    room = [2 * max(circle.radius, 3.0) + 4 for circle in circles]
    x = max(4.0, min(at[0] - sum(room) / 2, most_x - 4 - sum(room)))
    for circle, wide in zip(circles, room):
        yield replace(circle, at=(x + wide / 2, at[1]))
        x += wide


def _largest(on: FloorMap) -> float:
    """Radius of the largest circle: so that neighbours can be told apart."""
    points = [on.at(spot.at) for spot in on.spots if spot.kind == "station"]
    nearest = min((hypot(a[0] - b[0], a[1] - b[1]) for a, b in combinations(points, 2)), default=2 * MOST_PX)
    return min(MOST_PX, max(LEAST_PX, 0.55 * nearest))


def drawn_circles(circles: Sequence[Circle], on: FloorMap) -> Iterator[str]:
    for circle in sorted(circles, key=lambda one: (-one.radius, one.name)):
        yield f"<g><title>{escape(said_of(circle))}</title>{''.join(_rings(circle))}</g>"
    yield from _labels(circles, on)


def _rings(circle: Circle) -> Iterator[str]:
    """The most there may be, and within it what is sure."""
    bar = circle.bar
    if bar is None:
        yield _ring(circle, circle.radius, UNKNOWN[0], f' stroke="{MUTED}" stroke-width="1.5" stroke-dasharray="3 3"')
        yield text_at("?", circle.at[0], circle.at[1] + 4.5, MUTED, "middle", 13, bold=True)
    elif bar.most <= 0:
        yield _ring(circle, 3.0, "#ffffff", f' stroke="{INK}" stroke-width="1.3"')
    else:
        if bar.is_open:
            yield _ring(circle, circle.radius, PERHAPS[0], f' stroke="{MUTED}" stroke-dasharray="3 2"')
        for minutes, (colour, _) in ((bar.five, FIVE), (bar.seven, SEVEN)):
            if minutes > 0:
                yield _ring(circle, circle.radius * sqrt(minutes / bar.most), colour, ' stroke="#ffffff"')


def _ring(circle: Circle, radius: float, fill: str, more: str) -> str:
    return f'<circle cx="{circle.at[0]:.1f}" cy="{circle.at[1]:.1f}" r="{radius:.1f}" fill="{fill}"{more}/>'


def _labels(circles: Sequence[Circle], on: FloorMap) -> Iterator[str]:
    """Name and minutes of each, where they hide least; those with most first."""
    rings: list[Box] = [around(one.at, max(one.radius, 4.0)) for one in circles]
    taken = list(rings)
    for circle in sorted(circles, key=lambda one: (-(one.bar.most if one.bar else 0.0), one.name)):
        words = [shortened(circle.name), _minutes(circle)]
        half = LETTER * max(map(len, words)) / 2
        (x, y), r = circle.at, max(circle.radius, 4.0)
        offers = [
            *((x, y + r + 13, "middle"), (x, y - r - LINE - 5, "middle")),
            *((x + r + 5, y - 3, "start"), (x - r - 5, y - 3, "end")),
        ]
        boxes = [_words_box(*offer, half) for offer in offers]
        costs = [sum(shared(box, other) for other in taken) + 50 * _out(box, on) for box in boxes]
        best = min(range(len(offers)), key=lambda n: (costs[n], n))
        taken.append(boxes[best])
        at_x, at_y, anchor = offers[best]
        yield text_at(words[0], at_x, at_y, INK, anchor, 12.5, halo=True, bold=True)
        yield text_at(words[1], at_x, at_y + LINE - 1, INK, anchor, 12, halo=True)


def _words_box(x: float, y: float, anchor: str, half: float) -> Box:
    left = x - half if anchor == "middle" else x if anchor == "start" else x - 2 * half
    return left, y - 11, left + 2 * half, y + LINE + 3


def _out(box: Box, on: FloorMap) -> float:
    below = max(0.0, box[3] - (on.tall - FOOT))
    return max(0.0, -box[0]) + max(0.0, box[2] - on.wide) + max(0.0, -box[1]) + below


def _minutes(circle: Circle) -> str:
    """``13.3 ± 1.6``, or with what there may be: ``13.3 to 15.1``."""
    bar = circle.bar
    if bar is None:
        return "not known"
    half = (bar.high - bar.low) / 2 if isfinite(bar.low) and isfinite(bar.high) else None
    mean = digits(bar.five, half)
    spread = f" ± {half_digits(bar.five, half)}" if half else ""
    return mean + spread + (" +?" if circle.open_tasks else "")


def said_of(circle: Circle) -> str:
    """All that is known of a station, in words."""
    bar = circle.bar
    if bar is None:
        return f"{circle.name}: nothing known of the postures"
    ends = f" ({digits(bar.low)} to {digits(bar.high)})" if isfinite(bar.low) and isfinite(bar.high) else ""
    most = f", at most {digits(bar.most)}" if bar.is_open else ""
    open_words = f"; nothing known of {listing(list(circle.open_tasks))}" if circle.open_tasks else ""
    seven = f", {digits(bar.seven)} of them at 7" if bar.seven > 0 else ""
    return f"{circle.name}: {digits(bar.five)}{ends} minutes an hour at RULA 5 or more{seven}{most}{open_words}"


def area_key(circles: Sequence[Circle], on: FloorMap) -> Iterator[str]:
    """How large so many minutes are."""
    largest_px, most = max((one.radius, one.bar.most) for one in circles if one.bar is not None)
    shown = most * min(1.0, (FOOT_PX / largest_px) ** 2)
    x, y = on.wide - 8, on.tall - FOOT_PX - 4
    for minutes in (round_below(shown), round_below(shown / 4)):
        radius, words = largest_px * sqrt(minutes / most), f"{minutes:g} min"
        x -= LETTER * len(words)
        yield text_at(words, x, y + 4, MUTED, "start", 12)
        x -= radius + 5
        yield _ring(Circle("", (x, y), radius, None), radius, "none", f' stroke="{MUTED}"')
        x -= radius + 18


KPI = "exposure_by_station"
MOST_SAID, AROUND_PX = 3, 52.0
"""Stations in the sentence; and floor around the outermost places: room for their circles and minutes."""


def exposure_map_section(material: Material) -> Section | None:
    """None where no exposure was asked for, nobody is exposed at a station, or all places are one."""
    if material.log is None:
        return None
    bars = {bar.subject: bar for bar in bars_by(material.rows(KPI), KPI)}
    on = floor_map(material.plan, material.loaded.scenario.layout)
    if on is None or max((bar.most for name, bar in bars.items() if name != NOWHERE), default=0.0) <= 0:
        return None
    on = replace(on, around_px=AROUND_PX)
    circles = circles_of(bars, material.plan, material.loaded.scenario.layout, on)
    said = "; ".join(said_of(circle) for circle in circles)
    quiet = on.naming(spot.at for spot in on.spots if spot.kind != "station")
    drawn = picture(replace(quiet, bare=True), drawn_circles(circles, on), said, area_key(circles, on))
    svg = Svg(drawn, said, caption=_caption(material), legend=_legend(circles), wide=True)
    return Section(
        "exposure-map", "Exposure on the floor", [*map(Words, _sentences(circles, bars)), svg], "Exposed where"
    )


def _sentences(circles: Sequence[Circle], bars: dict[str, Bar]) -> Iterator[str]:
    total = sum(bar.five for bar in bars.values())
    shares = {one.name: one.bar.five / total for one in circles if one.bar is not None and total > 0}
    first = sorted((name for name in shares if shares[name] >= 0.1), key=lambda name: -shares[name])[:MOST_SAID]
    if first:
        said = [f"{100 * shares[name]:.0f} % at {name}" for name in first]
        yield f"Of all minutes at RULA 5 or more are {listing(said)}."
    if unknown := [one.name for one in circles if one.bar is None]:
        yield f"Nothing is known of the postures at {listing(unknown)}: what people go through there is in no figure."


def _legend(circles: Sequence[Circle]) -> list[tuple[str, str, str]]:
    known = [one.bar for one in circles if one.bar is not None]
    there = {
        SEVEN: any(bar.seven > 0 for bar in known),
        FIVE: any(bar.five > bar.seven for bar in known),
        PERHAPS: any(bar.is_open for bar in known),
        UNKNOWN: len(known) < len(circles),
    }
    words = {SEVEN: "of them at RULA 7 (inner circle)", FIVE: "at RULA 5 or more", PERHAPS: "perhaps (outer ring)"}
    return [(look[0], "dot", words.get(look, look[1])) for look, is_there in there.items() if is_there]


def _caption(material: Material) -> str:
    confidence = round(100 * material.summary["confidence"])
    return (
        "The area of a circle is minutes at RULA 5 or more in an hour of all workers' time, means over the "
        f"replications; ± is the {confidence} % interval."
    )
