"""Which factor matters, alone and with others, as bars with intervals: SVG that stands in a page."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

from opsim.report.interval_picture import ticks
from opsim.report.palette import ACCENT, GRID, INK, MUTED
from opsim.report.sweep_labels import fitting, tick_words
from opsim.report.words import digits, is_number

WIDE, LEFT, RIGHT, ROW, TOP, FOOT, BAR = 480, 14, 24, 58, 6, 44, 13
ALONE, TOTAL = "#56B4E9", ACCENT
SOBOL_LEGEND = ((TOTAL, TOTAL, "alone and with others"), (ALONE, ALONE, "alone"))
MORRIS_LEGEND = ((TOTAL, TOTAL, "mean size of the change"), (ALONE, ALONE, "mean change with its sign"))


def sensitivity_svg(factors: Sequence[Any], of: Sequence[Any], factor: float, axis: str) -> str:
    """Two bars a factor, the largest total on top. of : a Sensitivity each; factor : from SI to ``axis``'s unit"""
    pairs = sorted(zip(factors, of), key=lambda pair: -pair[1].total)
    if not pairs:
        return ""
    bars = [
        (
            fitting(f.path, 60),
            [
                (one.total * factor, _half(one.total_half) * factor, TOTAL),
                (one.alone * factor, _half(one.alone_half) * factor, ALONE),
            ],
        )
        for f, one in pairs
    ]
    ends = [0.0, *(value + side * half for _, two in bars for value, half, _ in two for side in (-1, 1))]
    low, high = min(ends), max(ends)
    margin = 0.03 * (high - low) or 1.0
    low, high = low - margin, high + margin

    def x(value: float) -> float:
        return LEFT + (value - low) / (high - low) * (WIDE - LEFT - RIGHT)

    foot = TOP + ROW * len(bars)
    steps = ticks(low, high)
    drawn = [_tick(x(at), tick_words(at), foot, at == 0) for at in steps]
    for place, (name, two) in enumerate(bars):
        top = TOP + ROW * place
        drawn.append(_text(name, LEFT + 4, top + 15, INK, "start"))
        drawn += [_bar(*one, top + 21 + k * (BAR + 2), x) for k, one in enumerate(two)]
    drawn.append(_text(axis, (WIDE - RIGHT + LEFT) / 2, foot + 38, MUTED, "middle"))
    said = escape("; ".join(f"{name}: {digits(two[0][0])}" for name, two in bars))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} {foot + FOOT}" role="img" font-size="14" '
        f'style="width:100%;max-width:{WIDE + 120}px" aria-label="{said}">{"".join(drawn)}</svg>'
    )


def _half(half: float) -> float:
    return half if is_number(half) else 0.0


def _bar(value: float, half: float, fill: str, top: float, x: Any) -> str:
    ends = sorted((x(0.0), x(value)))
    middle = top + BAR / 2
    wide = max(0.5, ends[1] - ends[0])
    drawn = f'<rect x="{ends[0]:.1f}" y="{top:.1f}" width="{wide:.1f}" height="{BAR}" fill="{fill}"/>'
    if half:
        drawn += f'<path d="M{x(value - half):.1f} {middle}H{x(value + half):.1f}" stroke="{INK}" stroke-width="1.4"/>'
    return drawn


def _tick(x: float, words: str, foot: float, zero: bool) -> str:
    line = f'<path d="M{x:.1f} {TOP}V{foot}" stroke="{INK if zero else GRID}" stroke-width="{1.5 if zero else 1}"/>'
    return line + _text(words, x, foot + 18, MUTED, "middle")


def _text(words: str, x: float, y: float, colour: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}">{escape(words)}</text>'
