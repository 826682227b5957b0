"""A small chart as SVG, as wide as a telephone, so that several stand side by side on a desk and below on a hand."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from html import escape

from opsim.report.interval_picture import ticks
from opsim.report.palette import GRID, INK, MUTED

WIDTH, HEIGHT, LEFT, RIGHT, TOP, FOOT = 340, 200, 46, 16, 26, 34


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
        return LEFT + (value - self.x[0]) / _span(self.x) * (WIDTH - LEFT - RIGHT)

    def at_y(self, value: float) -> float:
        """Pixels from the top; what lies beyond the frame stands on its edge."""
        share = min(1.0, max(0.0, (value - self.y[0]) / _span(self.y)))
        return HEIGHT - FOOT - share * (HEIGHT - FOOT - TOP)

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
            f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{self.at_y(y):.1f}" y2="{self.at_y(y):.1f}" '
            f'stroke="{colour}" stroke-width="1.2"{dash}/>'
        )

    def svg(self) -> str:
        """The chart."""
        foot = HEIGHT - FOOT
        axes = [_across(self.at_y(at), text) for at, text in _marks(self.y)]
        axes += [_below(self.at_x(at), text, foot) for at, text in _marks(self.x)]
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" font-size="12" '
            f'style="width:100%;max-width:{WIDTH * 1.4:.0f}px" aria-label="{escape(self.said)}">'
            f'<text x="0" y="13" font-size="13" font-weight="600" fill="{INK}">{escape(self.title)}</text>'
            f"{''.join(axes + self.drawn)}"
            f'<text x="{WIDTH - RIGHT}" y="{HEIGHT - 3}" text-anchor="end" fill="{MUTED}">{escape(self.x_name)}</text>'
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
        f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y:.1f}" y2="{y:.1f}" stroke="{GRID}"/>'
        f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end" fill="{MUTED}">{text}</text>'
    )


def _below(x: float, text: str, foot: float) -> str:
    return f'<text x="{x:.1f}" y="{foot + 15}" text-anchor="middle" fill="{MUTED}">{text}</text>'


def _span(of: tuple[float, float]) -> float:
    return of[1] - of[0] or 1.0
