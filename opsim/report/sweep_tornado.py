"""A tornado as SVG: how far each factor moves a figure to both sides of a reference, the largest swing on top."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

from opsim.report.interval_picture import ticks
from opsim.report.palette import ACCENT, GRID, INK, MUTED
from opsim.report.sweep_labels import fitting, shortened, tick_words
from opsim.report.words import digits, is_number, scale_of

WIDE, SIDE, ROW, TOP, FOOT, BAR = 480, 108, 52, 8, 44, 18
LONGEST_LEVEL = 14
UP, DOWN = ACCENT, "#E69F00"
MOST_ROWS = 20
LEGEND = ((UP, UP, "where the figure is highest"), (DOWN, DOWN, "where it is lowest; lines are 95 % intervals"))


def tornado_svg(swings: Sequence[Any], unit: str, largest: float | None, reference: str) -> str:
    """swings : the largest first; reference : what changes are against, in words; largest : chooses the unit."""
    shown = [one for one in swings if is_number(one.rise.mean)][:MOST_ROWS]
    if not shown:
        return ""
    factor, word = scale_of(unit, largest)
    low, high = _span(shown, factor)

    def x(value: float) -> float:
        return SIDE + (value - low) / (high - low) * (WIDE - 2 * SIDE)

    foot = TOP + ROW * len(shown)
    steps = ticks(low, high)
    drawn = [_tick(x(at), tick_words(at), foot, at == 0) for at in steps]
    drawn += [_row(one, TOP + ROW * place, x, factor) for place, one in enumerate(shown)]
    axis = f"change against {reference}" + (f", {word}" if word else "")
    drawn.append(_text(axis, WIDE / 2, foot + 38, MUTED, "middle"))
    said = "; ".join(f"{one.name}: {digits(one.rise.mean * factor)} {word}".strip() for one in shown)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} {foot + FOOT}" role="img" font-size="14" '
        f'style="width:100%;max-width:{WIDE + 120}px" aria-label="{escape(said)}">{"".join(drawn)}</svg>'
    )


def _row(one: Any, top: float, x: Any, factor: float) -> str:
    middle = top + 33
    weight = ' font-weight="600"' if one.clear else ""
    drawn = _text(fitting(one.name, 60), 4, top + 17, INK if one.clear else MUTED, "start", weight)
    if one.nothing:
        return drawn + _text("no effect", x(0.0) + 6, middle + 5, MUTED, "start")
    two = [one.levels[one.least], one.levels[one.most]]
    for level, fill in zip(two, (DOWN, UP)):
        drawn += _bar(level, fill, middle, x, factor, 1.0 if one.clear else 0.35)
    ends = [x(at) for at in (0.0, *_ends(two, factor))]
    drawn += _text(shortened(two[0].name, LONGEST_LEVEL), min(ends) - 6, middle + 5, INK, "end")
    return drawn + _text(shortened(two[1].name, LONGEST_LEVEL), max(ends) + 6, middle + 5, INK, "start")


def _bar(level: Any, fill: str, middle: float, x: Any, factor: float, opacity: float) -> str:
    change, half = level.change.mean * factor, _half(level) * factor
    ends = sorted((x(0.0), x(change)))
    drawn = (
        f'<rect x="{ends[0]:.1f}" y="{middle - BAR / 2:.1f}" width="{max(ends[1] - ends[0], 0.5):.1f}" '
        f'height="{BAR}" fill="{fill}" fill-opacity="{opacity:g}"/>'
    )
    if half:
        low, high = x(change - half), x(change + half)
        line = f"M{low:.1f} {middle}H{high:.1f}M{low:.1f} {middle - 4}v8M{high:.1f} {middle - 4}v8"
        drawn += f'<path d="{line}" fill="none" stroke="{INK}" stroke-width="1.4"/>'
    return drawn


def _half(level: Any) -> float:
    return level.change.half_width if is_number(level.change.half_width) else 0.0


def _ends(levels: Sequence[Any], factor: float) -> list[float]:
    """Where the intervals of some levels' changes end."""
    return [(level.change.mean + side * _half(level)) * factor for level in levels for side in (-1, 1)]


def _span(shown: Sequence[Any], factor: float) -> tuple[float, float]:
    ends = [0.0, *(end for one in shown for end in _ends((one.levels[one.least], one.levels[one.most]), factor))]
    low, high = min(ends), max(ends)
    margin = 0.03 * (high - low) or 1.0
    return low - margin, high + margin


def _tick(x: float, words: str, foot: float, zero: bool) -> str:
    colour, width = (INK, 1.5) if zero else (GRID, 1)
    line = f'<path d="M{x:.1f} {TOP}V{foot}" stroke="{colour}" stroke-width="{width}"/>'
    return line + _text(words, x, foot + 18, MUTED, "middle")


def _text(words: str, x: float, y: float, colour: str, anchor: str, more: str = "") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}"{more}>{escape(words)}</text>'
