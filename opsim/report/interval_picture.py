"""Intervals of differences about a line at zero, as SVG that stands in a page."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape

from opsim.report.palette import ACCENT, GRID, INK, MUTED
from opsim.report.words import digits

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
