"""A figure over each factor as SVG: what was simulated, with intervals, and the fitted response through it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from opsim.report.frontier import Axis
from opsim.report.palette import ACCENT, GRID, INK, MUTED
from opsim.report.sweep_labels import fitting, shortened
from opsim.report.words import is_number, scale_of

WIDE, TALL, LEFT, RIGHT, TOP, FOOT = 360, 250, 56, 14, 26, 46
STEPS = 41
POINT, FIT = "#7d8894", ACCENT
MOST_PANELS, MOST_POINTS = 12, 400


@dataclass(frozen=True, slots=True)
class Dot:
    """At ``x`` (the factor's number) the mean and its interval, in SI."""

    x: float
    mean: float
    half: float


def curves_html(found: Any, points: Any, largest: float | None) -> str:
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


def _dots(found: Any, points: Any, numbers: np.ndarray, column: int) -> Iterator[Dot]:
    """Of a grid the means of each level over all others, else the points themselves."""
    factor = points.factors[column]
    if found.how == "mean":
        of = next((one for one in found.swings if one.name == factor.path), None)
        if of is None:  # it has one value: it was not varied
            return
        for value, level in zip(factor.grid_values(), of.levels):
            if is_number(level.mean.mean):
                yield Dot(factor.number(value), level.mean.mean, _half(level.mean))
        return
    for x, mean in list(zip(numbers[:, column], found.means))[:MOST_POINTS]:
        if is_number(float(x)) and is_number(mean.mean):
            yield Dot(float(x), mean.mean, _half(mean))


def _half(interval: Any) -> float:
    return interval.half_width if is_number(interval.half_width) else 0.0


def _fit(found: Any, numbers: np.ndarray, column: int) -> list[tuple[float, float]]:
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
    return Axis(low - margin, high + margin, factor, word, TALL - FOOT, TOP)


def _panel(factor: Any, dots: Sequence[Dot], line: Sequence[tuple[float, float]], y: Axis) -> str:
    xs = [dot.x for dot in dots] + [x for x, _ in line]
    low, high = min(xs), max(xs)
    margin = 0.06 * (high - low) or 0.5
    x = Axis(low - margin, high + margin, 1.0, factor.unit, LEFT, WIDE - RIGHT)
    drawn = [*_grid(factor, x, y), *(_dot(dot, x, y) for dot in dots), _line(factor, line, x, y)]
    title = factor.path + (f", {factor.unit}" if factor.unit else "")
    drawn.append(_text(fitting(title), (LEFT + WIDE - RIGHT) / 2, TALL - 8, INK, "middle"))
    drawn.append(_text(y.word, 4, 15, MUTED, "start"))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} {TALL}" role="img" font-size="13" '
        f'style="width:100%;max-width:{WIDE + 60}px" aria-label="{escape(factor.path)}">{"".join(drawn)}</svg>'
    )


def _grid(factor: Any, x: Axis, y: Axis) -> Iterator[str]:
    for at, words in x_ticks(factor, x):
        yield f'<path d="M{at:.1f} {TOP}V{TALL - FOOT}" stroke="{GRID}"/>'
        yield _text(words, at, TALL - FOOT + 17, MUTED, "middle")
    for at, words in y.ticks:
        yield f'<path d="M{LEFT} {at:.1f}H{WIDE - RIGHT}" stroke="{GRID}"/>' + _text(
            words, LEFT - 6, at + 4, MUTED, "end"
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


def _text(words: str, x: float, y: float, colour: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}">{escape(words)}</text>'
