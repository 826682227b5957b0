"""The floor as SVG: its ground, paths and belts, signs with names or numbers, and a bar of metres.

What a picture shows on it (ways, heat, circles) lies between the ground and the signs.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from math import floor, log10

from opsim.report.floor_map import HALF_MARK, NUMBERED, SIZE, WIDE, FloorMap, Point, Stretch, around
from opsim.report.floor_spots import OTHER, STATION, STORE, Spot
from opsim.report.labels import shortened
from opsim.report.palette import INK, MUTED

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
