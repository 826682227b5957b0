"""Intervals of differences about a line at zero, as SVG that stands in a page.

A small chart as SVG, as wide as a telephone, so that several stand side by side on a desk and below on a hand.

Where names stand in a picture, so that they hide as little as can be of what is drawn and of each other.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from html import escape

from opsim.report.numbers import digits
from opsim.report.plot.plotly import ACCENT, GRID, INK, MUTED

WIDTH, LEFT, RIGHT, ROW, FOOT = 720, 180, 24, 30, 34
LONGEST_LABEL = 24
Bar = tuple[str, float, float, float, str]
"""(name, low, mean, high, verdict); low and high may be nan"""


def intervals_svg(bars: Sequence[Bar], unit: str) -> str:
    """One row a bar, a dot at the mean, a line over the interval; what is not told apart from zero is grey."""
    low, high = _span(bars)
    steps = ticks(low, high)

    def x(value: float) -> float:
        return LEFT + (value - low) / (high - low) * (WIDTH - LEFT - RIGHT)

    height = ROW * len(bars) + FOOT
    foot = ROW * len(bars)
    lines = [_tick(x(at), digits(at, steps[1] - steps[0]), foot, at == 0) for at in steps]
    rows = [_row(bar, x, ROW * (place + 0.5)) for place, bar in enumerate(bars)]
    said = "; ".join(f"{name}: {verdict}" for name, *_, verdict in bars)
    name = (
        f'<text x="{WIDTH - RIGHT}" y="{height - 2}" text-anchor="end" fill="{MUTED}">difference, {escape(unit)}</text>'
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img" font-size="13" '
        f'style="width:100%;max-width:{WIDTH}px" aria-label="{escape(said)}">{"".join(lines + rows)}{name}</svg>'
    )


def _row(bar: Bar, x, y: float) -> str:
    name, low, mean, high, verdict = bar
    short = name if len(name) <= LONGEST_LABEL else name[: LONGEST_LABEL - 1] + "…"
    colour = ACCENT if verdict in ("higher", "lower") else MUTED
    drawn = f'<text x="{LEFT - 12}" y="{y + 4:.1f}" text-anchor="end" fill="{INK}">{escape(short)}</text>'
    if math.isfinite(low) and math.isfinite(high):
        drawn += (
            f'<line x1="{x(low):.1f}" x2="{x(high):.1f}" y1="{y:.1f}" y2="{y:.1f}" stroke="{colour}" stroke-width="3"/>'
        )
    if math.isfinite(mean):
        drawn += f'<circle cx="{x(mean):.1f}" cy="{y:.1f}" r="5" fill="{colour}"/>'
    return drawn


def _tick(x: float, text: str, foot: float, zero: bool) -> str:
    colour, width = (INK, 1.5) if zero else (GRID, 1)
    return (
        f'<line x1="{x:.1f}" x2="{x:.1f}" y1="0" y2="{foot}" stroke="{colour}" stroke-width="{width}"/>'
        f'<text x="{x:.1f}" y="{foot + 15}" text-anchor="middle" fill="{MUTED}">{text}</text>'
    )


def _span(bars: Sequence[Bar]) -> tuple[float, float]:
    values = [value for _, *numbers, _ in bars for value in numbers if math.isfinite(value)]
    low, high = min([0.0, *values]), max([0.0, *values])
    margin = 0.06 * (high - low) or 1.0
    return low - margin, high + margin


def ticks(low: float, high: float) -> list[float]:
    """Round numbers, zero among them, about five over the span."""
    size = 10 ** math.floor(math.log10((high - low) / 4))
    step = next(size * nice for nice in (1, 2, 5, 10) if (high - low) / (size * nice) <= 6)
    return [step * k for k in range(math.ceil(low / step), math.floor(high / step) + 1)]


SMALL_WIDTH, HEIGHT, SMALL_LEFT, SMALL_RIGHT, TOP, SMALL_FOOT = 340, 200, 46, 16, 26, 34


@dataclass
class SmallChart:
    """A frame with two axes; what is drawn lies in order. x, y : (low, high) shown; names may be anything: escaped."""

    title: str
    x: tuple[float, float]
    y: tuple[float, float]
    x_name: str
    said: str
    drawn: list[str] = field(default_factory=list)

    def at_x(self, value: float) -> float:
        """Pixels from the left."""
        return SMALL_LEFT + (value - self.x[0]) / _length(self.x) * (SMALL_WIDTH - SMALL_LEFT - SMALL_RIGHT)

    def at_y(self, value: float) -> float:
        """Pixels from the top; what lies beyond the frame stands on its edge."""
        share = min(1.0, max(0.0, (value - self.y[0]) / _length(self.y)))
        return HEIGHT - SMALL_FOOT - share * (HEIGHT - SMALL_FOOT - TOP)

    def line(self, x: Iterable[float], y: Iterable[float], colour: str, width: float = 1.5) -> None:
        """A line through some points."""
        points = " ".join(f"{self.at_x(a):.1f},{self.at_y(b):.1f}" for a, b in zip(x, y))
        self.drawn.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}"/>')

    def band(
        self, x: Sequence[float], low: Sequence[float], high: Sequence[float], colour: str, opacity: float
    ) -> None:
        """The area between two lines."""
        ends = [*zip(x, low), *zip(reversed(x), reversed(high))]
        points = " ".join(f"{self.at_x(a):.1f},{self.at_y(b):.1f}" for a, b in ends)
        self.drawn.append(f'<polygon points="{points}" fill="{colour}" opacity="{opacity:g}"/>')

    def dots(self, x: Sequence[float], y: Sequence[float], colour: str) -> None:
        """A dot a point."""
        self.drawn += [
            f'<circle cx="{self.at_x(a):.1f}" cy="{self.at_y(b):.1f}" r="2.6" fill="{colour}"/>' for a, b in zip(x, y)
        ]

    def bars(self, x: Sequence[float], y: Sequence[float], colour: str) -> None:
        """A bar a point, from 0."""
        zero = self.at_y(0.0)
        self.drawn += [
            f'<line x1="{self.at_x(a):.1f}" x2="{self.at_x(a):.1f}" y1="{zero:.1f}" y2="{self.at_y(b):.1f}" '
            f'stroke="{colour}" stroke-width="4"/>'
            for a, b in zip(x, y)
        ]

    def box(self, x: tuple[float, float], y: tuple[float, float], colour: str, opacity: float) -> None:
        """A filled rectangle."""
        left, right = self.at_x(x[0]), self.at_x(x[1])
        top, foot = self.at_y(y[1]), self.at_y(y[0])
        self.drawn.append(
            f'<rect x="{left:.1f}" y="{top:.1f}" width="{max(0.0, right - left):.1f}" '
            f'height="{max(1.0, foot - top):.1f}" fill="{colour}" opacity="{opacity:g}"/>'
        )

    def level(self, y: float, colour: str, dashed: bool = False) -> None:
        """A line across."""
        dash = ' stroke-dasharray="4 3"' if dashed else ""
        self.drawn.append(
            f'<line x1="{SMALL_LEFT}" x2="{SMALL_WIDTH - SMALL_RIGHT}" y1="{self.at_y(y):.1f}" y2="{self.at_y(y):.1f}" '
            f'stroke="{colour}" stroke-width="1.2"{dash}/>'
        )

    def svg(self) -> str:
        """The chart."""
        foot = HEIGHT - SMALL_FOOT
        axes = [_across(self.at_y(at), text) for at, text in _marks(self.y)]
        axes += [_below(self.at_x(at), text, foot) for at, text in _marks(self.x)]
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SMALL_WIDTH} {HEIGHT}" role="img" font-size="12" '
            f'style="width:100%;max-width:{SMALL_WIDTH * 1.4:.0f}px" aria-label="{escape(self.said)}">'
            f'<text x="0" y="13" font-size="13" font-weight="600" fill="{INK}">{escape(self.title)}</text>'
            f"{''.join(axes + self.drawn)}"
            f'<text x="{SMALL_WIDTH - SMALL_RIGHT}" y="{HEIGHT - 3}" text-anchor="end" fill="{MUTED}">'
            f"{escape(self.x_name)}</text>"
            "</svg>"
        )


def panels(charts: Iterable[SmallChart]) -> str:
    """Charts beside each other where there is room."""
    return f'<div class="panels">{"".join(f"<div>{chart.svg()}</div>" for chart in charts)}</div>'


def around(values: Sequence[float], with_zero: bool = False) -> tuple[float, float]:
    """A span that shows all values, with a margin; one about a constant too."""
    low, high = min(values), max(values)
    low, high = (min(low, 0.0), max(high, 0.0)) if with_zero else (low, high)
    margin = 0.06 * (high - low) or 0.05 * abs(high) or 1.0
    return (low if with_zero and low == 0 else low - margin), high + margin


def _marks(span: tuple[float, float]) -> list[tuple[float, str]]:
    at = ticks(*span)
    places = max(0, -math.floor(math.log10(at[1] - at[0]))) if len(at) > 1 else 0
    return [(value, f"{value:,.{places}f}".replace("-", "\N{MINUS SIGN}")) for value in at]


def _across(y: float, text: str) -> str:
    return (
        f'<line x1="{SMALL_LEFT}" x2="{SMALL_WIDTH - SMALL_RIGHT}" y1="{y:.1f}" y2="{y:.1f}" stroke="{GRID}"/>'
        f'<text x="{SMALL_LEFT - 6}" y="{y + 4:.1f}" text-anchor="end" fill="{MUTED}">{text}</text>'
    )


def _below(x: float, text: str, foot: float) -> str:
    return f'<text x="{x:.1f}" y="{foot + 15}" text-anchor="middle" fill="{MUTED}">{text}</text>'


def _length(of: tuple[float, float]) -> float:
    return of[1] - of[0] or 1.0


LETTER, ABOVE, BELOW, LONGEST = 8.0, 12.0, 3.5, 28
"""Width of a letter, how far letters reach above and below their line, in units of the picture; letters of a name."""
OUTSIDE = 150.0
"""How much worse a unit beyond the picture's edge is than a unit of what is hidden."""
Box = tuple[float, float, float, float]
"""(left, top, right, bottom)"""
Place = tuple[float, float, str]
"""(x, y, anchor) of a text"""


def shortened(name: str) -> str:
    """A name as a picture has room for."""
    return name if len(name) <= LONGEST else name[: LONGEST - 1] + "…"


def places(at: Sequence[tuple[float, float]], names: Sequence[str], taken: Sequence[Box], wide: float) -> list[Place]:
    """Beside each point a place for its name, in their order; what stands there already is avoided where it can be.

    taken : boxes that names should not hide; wide : of the picture
    """
    boxes, found = list(taken), []
    for (x, y), name in zip(at, names):
        length = LETTER * len(name)
        offers = [(x + side, y + down, side > 0) for down in (-8, 17, 4.5, -24, 33) for side in (9, -9)]
        covers = [_box(*offer, length) for offer in offers]
        best = min(range(len(offers)), key=lambda i: (_hidden(covers[i], boxes, wide), i))
        boxes.append(covers[best])
        found.append((*offers[best][:2], "start" if offers[best][2] else "end"))
    return found


def _box(x: float, y: float, rightward: bool, length: float) -> Box:
    left = x if rightward else x - length
    return left, y - ABOVE, left + length, y + BELOW


def _hidden(box: Box, taken: Sequence[Box], wide: float) -> float:
    """How much of others a box covers, and how far it stands out of the picture."""
    left, top, right, _ = box
    out = max(0.0, -left) + max(0.0, right - wide) + max(0.0, -top)
    return OUTSIDE * out + sum(shared(box, other) for other in taken)


def shared(a: Box, b: Box) -> float:
    """The area that two boxes have in common."""
    across, down = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    return max(0.0, across) * max(0.0, down)
