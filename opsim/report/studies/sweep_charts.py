"""Paths and values as the pictures of a sweep have room for.

Which factor matters, alone and with others, as bars with intervals: SVG that stands in a page.

A tornado as SVG: how far each factor moves a figure to both sides of a reference, the largest swing on top.

A figure over each factor as SVG: what was simulated, with intervals, and the fitted response through it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from opsim.report.numbers import digits, is_number, scale_of
from opsim.report.plot.plotly import ACCENT, GRID, INK, MUTED
from opsim.report.plot.svg_chart import ticks
from opsim.report.sections.pareto import Axis

if TYPE_CHECKING:
    from opsim.study.sweep.effects import Found


def shortened(words: str, most: int) -> str:
    """The beginning, of values."""
    return words if len(words) <= most else words[: most - 1] + "…"


def fitting(path: str, most: int = 40) -> str:
    """The end, which says more of a path than its beginning."""
    return path if len(path) <= most else "…" + path[-(most - 1) :]


def tick_words(at: float) -> str:
    """A round number on an axis."""
    return f"{at:,.10g}".replace("-", "\N{MINUS SIGN}")


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


TORNADO_WIDE, SIDE, TORNADO_ROW, TORNADO_TOP, TORNADO_FOOT, TORNADO_BAR = 480, 108, 52, 8, 44, 18
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
        return SIDE + (value - low) / (high - low) * (TORNADO_WIDE - 2 * SIDE)

    foot = TORNADO_TOP + TORNADO_ROW * len(shown)
    steps = ticks(low, high)
    drawn = [_tornado_tick(x(at), tick_words(at), foot, at == 0) for at in steps]
    drawn += [_row(one, TORNADO_TOP + TORNADO_ROW * place, x, factor) for place, one in enumerate(shown)]
    axis = f"change against {reference}" + (f", {word}" if word else "")
    drawn.append(_tornado_text(axis, TORNADO_WIDE / 2, foot + 38, MUTED, "middle"))
    said = "; ".join(f"{one.name}: {digits(one.rise.mean * factor)} {word}".strip() for one in shown)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {TORNADO_WIDE} {foot + TORNADO_FOOT}" role="img" '
        f'font-size="14" style="width:100%;max-width:{TORNADO_WIDE + 120}px" aria-label="{escape(said)}">'
        f"{''.join(drawn)}</svg>"
    )


def _row(one: Any, top: float, x: Any, factor: float) -> str:
    middle = top + 33
    weight = ' font-weight="600"' if one.clear else ""
    drawn = _tornado_text(fitting(one.name, 60), 4, top + 17, INK if one.clear else MUTED, "start", weight)
    if one.nothing:
        return drawn + _tornado_text("no effect", x(0.0) + 6, middle + 5, MUTED, "start")
    two = [one.levels[one.least], one.levels[one.most]]
    for level, fill in zip(two, (DOWN, UP)):
        drawn += _tornado_bar(level, fill, middle, x, factor, 1.0 if one.clear else 0.35)
    ends = [x(at) for at in (0.0, *_ends(two, factor))]
    drawn += _tornado_text(shortened(two[0].name, LONGEST_LEVEL), min(ends) - 6, middle + 5, INK, "end")
    return drawn + _tornado_text(shortened(two[1].name, LONGEST_LEVEL), max(ends) + 6, middle + 5, INK, "start")


def _tornado_bar(level: Any, fill: str, middle: float, x: Any, factor: float, opacity: float) -> str:
    change, half = level.change.mean * factor, _level_half(level) * factor
    ends = sorted((x(0.0), x(change)))
    drawn = (
        f'<rect x="{ends[0]:.1f}" y="{middle - TORNADO_BAR / 2:.1f}" width="{max(ends[1] - ends[0], 0.5):.1f}" '
        f'height="{TORNADO_BAR}" fill="{fill}" fill-opacity="{opacity:g}"/>'
    )
    if half:
        low, high = x(change - half), x(change + half)
        line = f"M{low:.1f} {middle}H{high:.1f}M{low:.1f} {middle - 4}v8M{high:.1f} {middle - 4}v8"
        drawn += f'<path d="{line}" fill="none" stroke="{INK}" stroke-width="1.4"/>'
    return drawn


def _level_half(level: Any) -> float:
    return level.change.half_width if is_number(level.change.half_width) else 0.0


def _ends(levels: Sequence[Any], factor: float) -> list[float]:
    """Where the intervals of some levels' changes end."""
    return [(level.change.mean + side * _level_half(level)) * factor for level in levels for side in (-1, 1)]


def _span(shown: Sequence[Any], factor: float) -> tuple[float, float]:
    ends = [0.0, *(end for one in shown for end in _ends((one.levels[one.least], one.levels[one.most]), factor))]
    low, high = min(ends), max(ends)
    margin = 0.03 * (high - low) or 1.0
    return low - margin, high + margin


def _tornado_tick(x: float, words: str, foot: float, zero: bool) -> str:
    colour, width = (INK, 1.5) if zero else (GRID, 1)
    line = f'<path d="M{x:.1f} {TORNADO_TOP}V{foot}" stroke="{colour}" stroke-width="{width}"/>'
    return line + _tornado_text(words, x, foot + 18, MUTED, "middle")


def _tornado_text(words: str, x: float, y: float, colour: str, anchor: str, more: str = "") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}"{more}>{escape(words)}</text>'


CURVE_WIDE, TALL, CURVE_LEFT, CURVE_RIGHT, CURVE_TOP, CURVE_FOOT = 360, 250, 56, 14, 26, 46
STEPS = 41
POINT, FIT = "#7d8894", ACCENT
MOST_PANELS, MOST_POINTS = 12, 400


@dataclass(frozen=True, slots=True)
class Dot:
    """At ``x`` (the factor's number) the mean and its interval, in SI."""

    x: float
    mean: float
    half: float


def curves_html(found: Found, points: Any, largest: float | None) -> str:
    """A picture a factor, side by side where there is room. found : a Found; points : the Points"""
    numbers = points.numbers()
    dots = [list(_dots(found, points, numbers, column)) for column in range(len(points.factors))]
    fits = [_fit(found, numbers, column) for column in range(len(points.factors))]
    if not any(dots):
        return ""
    factor, word = scale_of(found.key[3], largest)
    y = _y_axis([dot for of in dots for dot in of], fits, factor, word)
    panels = [_panel(of, dots[column], fits[column], y) for column, of in enumerate(points.factors) if dots[column]][
        :MOST_PANELS
    ]
    return f'<div class="panels">{"".join(f"<div>{panel}</div>" for panel in panels)}</div>'


def _dots(found: Found, points: Any, numbers: np.ndarray, column: int) -> Iterator[Dot]:
    """Of a grid the means of each level over all others, else the points themselves."""
    factor = points.factors[column]
    if found.how == "mean":
        of = next((one for one in found.swings if one.name == factor.path), None)
        if of is None:  # it has one value: it was not varied
            return
        for value, level in zip(factor.grid_values(), of.levels):
            if is_number(level.mean.mean):
                yield Dot(factor.number(value), level.mean.mean, _interval_half(level.mean))
        return
    for x, mean in list(zip(numbers[:, column], found.means))[:MOST_POINTS]:
        if is_number(float(x)) and is_number(mean.mean):
            yield Dot(float(x), mean.mean, _interval_half(mean))


def _interval_half(interval: Any) -> float:
    return interval.half_width if is_number(interval.half_width) else 0.0


def _fit(found: Found, numbers: np.ndarray, column: int) -> list[tuple[float, float]]:
    """(factor's number, figure in SI) of the fitted response, averaged over the other factors of the points."""
    response = found.response
    if response is None:
        return []
    n = response.room.categories[column]
    low, high = float(response.room.low[column]), float(response.room.high[column])
    places = np.arange(n) if n else np.linspace(low, high, STEPS if high > low else 0)
    rows = numbers[~np.isnan(numbers).any(axis=1)].copy()
    line = []
    for x in places:
        rows[:, column] = x
        line.append((float(x), float(response.means(rows).mean())))
    return line


def _y_axis(dots: Sequence[Dot], fits: Sequence[Sequence[tuple[float, float]]], factor: float, word: str) -> Axis:
    ends = [end * factor for dot in dots for end in (dot.mean - dot.half, dot.mean + dot.half)]
    ends += [at * factor for line in fits for _, at in line]
    low, high = min(ends), max(ends)
    margin = 0.06 * (high - low) or 0.05 * abs(high) or 1.0
    return Axis(low - margin, high + margin, factor, word, TALL - CURVE_FOOT, CURVE_TOP)


def _panel(factor: Any, dots: Sequence[Dot], line: Sequence[tuple[float, float]], y: Axis) -> str:
    xs = [dot.x for dot in dots] + [x for x, _ in line]
    low, high = min(xs), max(xs)
    margin = 0.06 * (high - low) or 0.5
    x = Axis(low - margin, high + margin, 1.0, factor.unit, CURVE_LEFT, CURVE_WIDE - CURVE_RIGHT)
    drawn = [*_grid(factor, x, y), *(_dot(dot, x, y) for dot in dots), _line(factor, line, x, y)]
    title = factor.path + (f", {factor.unit}" if factor.unit else "")
    drawn.append(_curve_text(fitting(title), (CURVE_LEFT + CURVE_WIDE - CURVE_RIGHT) / 2, TALL - 8, INK, "middle"))
    drawn.append(_curve_text(y.word, 4, 15, MUTED, "start"))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {CURVE_WIDE} {TALL}" role="img" font-size="13" '
        f'style="width:100%;max-width:{CURVE_WIDE + 60}px" aria-label="{escape(factor.path)}">{"".join(drawn)}</svg>'
    )


def _grid(factor: Any, x: Axis, y: Axis) -> Iterator[str]:
    for at, words in x_ticks(factor, x):
        yield f'<path d="M{at:.1f} {CURVE_TOP}V{TALL - CURVE_FOOT}" stroke="{GRID}"/>'
        yield _curve_text(words, at, TALL - CURVE_FOOT + 17, MUTED, "middle")
    for at, words in y.ticks:
        yield f'<path d="M{CURVE_LEFT} {at:.1f}H{CURVE_WIDE - CURVE_RIGHT}" stroke="{GRID}"/>' + _curve_text(
            words, CURVE_LEFT - 6, at + 4, MUTED, "end"
        )


def x_ticks(factor: Any, x: Axis) -> list[tuple[float, str]]:
    """Round numbers, or the values where they have no order, or are few."""
    if factor.categories:
        room = max(4, int(48 / factor.categories))
        words = [factor.words(value) for value in factor.values]
        return [(x.of_people(k), shortened(w, room)) for k, w in enumerate(words)]
    if not factor.is_number:
        return [(x.of_people(k), shortened(factor.words(value), 24)) for k, value in enumerate(factor.values)]
    if not factor.is_range and len(factor.values) <= 5:
        return [(x.of_people(n), f"{n:g}") for n in sorted(factor.number(value) for value in factor.values)]
    return x.ticks


def _dot(dot: Dot, x: Axis, y: Axis) -> str:
    at, mean = x.of_people(dot.x), y.at(dot.mean)
    bar = f'<path d="M{at:.1f} {y.at(dot.mean - dot.half):.1f}V{y.at(dot.mean + dot.half):.1f}" stroke="{POINT}"/>'
    return bar + f'<circle cx="{at:.1f}" cy="{mean:.1f}" r="3.2" fill="{POINT}"/>'


def _line(factor: Any, line: Sequence[tuple[float, float]], x: Axis, y: Axis) -> str:
    if not line:
        return ""
    at = [(x.of_people(number), y.at(mean)) for number, mean in line]
    if factor.categories:
        return "".join(f'<path d="M{a - 9:.1f} {b:.1f}h18" stroke="{FIT}" stroke-width="2.4"/>' for a, b in at)
    path = "L".join(f"{a:.1f} {b:.1f}" for a, b in at)
    return f'<path d="M{path}" fill="none" stroke="{FIT}" stroke-width="2.2"/>'


def _curve_text(words: str, x: float, y: float, colour: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}">{escape(words)}</text>'
