"""Exposure on the floor: at each station how long people are there at a high score, over all replications."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from opsim.report.exposure_bars import FIVE, PERHAPS, SEVEN
from opsim.report.exposure_circles import UNKNOWN, Circle, area_key, circles_of, drawn_circles, said_of
from opsim.report.exposure_rows import NOWHERE, Bar, bars_by
from opsim.report.floor_drawn import picture
from opsim.report.floor_map import floor_map
from opsim.report.material import Material
from opsim.report.section import Section, Svg, Words
from opsim.report.words import listing

KPI = "exposure_by_station"
MOST_SAID, AROUND_PX = 3, 52.0
"""Stations in the sentence; and floor around the outermost places: room for their circles and minutes."""


def section(material: Material) -> Section | None:
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
