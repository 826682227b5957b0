"""A figure over two factors as SVG: the cells of a grid with their means, or the fitted response with its points.

The terms of a fitted response as a table: coefficients in the factors' own units.

Which factor matters, alone and with others: a section of a sweep's page.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from typing import Any

import numpy as np

from opsim.report.numbers import difference_unit, digits, half_digits, is_number, largest_of, scale_of
from opsim.report.page import StudySection, Table
from opsim.report.plot.plotly import INK, MUTED
from opsim.report.sections.pareto import Axis, axis_name
from opsim.report.studies.sweep_charts import (
    MORRIS_LEGEND,
    MOST_POINTS,
    SOBOL_LEGEND,
    fitting,
    sensitivity_svg,
    shortened,
    x_ticks,
)

WIDE, TALL, LEFT, RIGHT, TOP, FOOT = 560, 440, 92, 16, 50, 58
CELLS, MOST_CELLS, LARGEST_TEXT = 24, 15, 12
LOW, HIGH = (247, 251, 255), (0, 92, 148)
"""Colours of the least and the largest value."""


def map_svg(found: Any, points: Any, largest: float | None) -> str:
    """Of two factors; nothing where there is neither a grid nor a fit. found : a Found; points : the Points"""
    if len(points.factors) != 2:
        return ""
    factor, word = scale_of(found.key[3], largest)
    if is_grid(points):
        return _grid_map(found, points, factor, word)
    if found.response is None or any(of.categories for of in points.factors):
        return ""
    return _fit_map(found, points, factor, word)


def is_grid(points: Any) -> bool:
    """Whether there is a cell for each point that has room for its mean."""
    return points.design == "grid" and max(_counts(points)) <= MOST_CELLS


def _counts(points: Any) -> list[int]:
    return [int(points.array[:, column].max()) + 1 for column in (0, 1)]


def _grid_map(found: Any, points: Any, factor: float, word: str) -> str:
    counts = _counts(points)
    means = np.array([one.mean for one in found.means]) * factor
    wide, tall = (WIDE - LEFT - RIGHT) / counts[0], (TALL - TOP - FOOT) / counts[1]
    low, high = float(np.nanmin(means)), float(np.nanmax(means))
    drawn = []
    for row, (i, j) in enumerate(points.array.tolist()):
        left, top = LEFT + i * wide, TALL - FOOT - (j + 1) * tall
        fill, ink = colour(means[row], low, high)
        drawn.append(
            f'<rect x="{left:.1f}" y="{top:.1f}" width="{wide:.1f}" height="{tall:.1f}" fill="{fill}" stroke="#fff"/>'
        )
        half = found.means[row].half_width
        said = digits(float(means[row]), half * factor if is_number(half) else None)
        drawn.append(_text(said, left + wide / 2, top + tall / 2 + 5, ink, "middle"))
    for column, of in enumerate(points.factors):
        words = [of.words(value) for value in of.grid_values()]
        drawn += _labels(words, column, wide, tall)
    return _whole(drawn, points, word, low, high)


def _labels(words: Sequence[str], column: int, wide: float, tall: float) -> Iterator[str]:
    for k, said in enumerate(words):
        most = LARGEST_TEXT if column else max(4, int(wide / 7.5))
        short = shortened(said, most)
        if column == 0:
            yield _text(short, LEFT + (k + 0.5) * wide, TALL - FOOT + 18, MUTED, "middle")
        else:
            yield _text(short, LEFT - 8, TALL - FOOT - (k + 0.5) * tall + 5, MUTED, "end")


def _fit_map(found: Any, points: Any, factor: float, word: str) -> str:
    room = found.response.room
    if not (room.high > room.low).all():
        return ""
    shares = (np.arange(CELLS) + 0.5) / CELLS
    at = [room.low[k] + shares * (room.high[k] - room.low[k]) for k in (0, 1)]
    means = found.response.means(np.array([[a, b] for a in at[0] for b in at[1]])).reshape(CELLS, CELLS) * factor
    wide, tall = (WIDE - LEFT - RIGHT) / CELLS, (TALL - TOP - FOOT) / CELLS
    low, high = float(means.min()), float(means.max())
    drawn = [
        f'<rect x="{LEFT + i * wide:.2f}" y="{TALL - FOOT - (j + 1) * tall:.2f}" width="{wide + 0.4:.2f}" '
        f'height="{tall + 0.4:.2f}" fill="{colour(means[i, j], low, high)[0]}"/>'
        for i in range(CELLS)
        for j in range(CELLS)
    ]
    x = Axis(float(room.low[0]), float(room.high[0]), 1.0, "", LEFT, WIDE - RIGHT)
    y = Axis(float(room.low[1]), float(room.high[1]), 1.0, "", TALL - FOOT, TOP)
    numbers = points.numbers()
    drawn += [
        f'<circle cx="{x.of_people(a):.1f}" cy="{y.of_people(b):.1f}" r="3.4" fill="#fff" stroke="{INK}"/>'
        for a, b in numbers[~np.isnan(numbers).any(axis=1)][:MOST_POINTS]
    ]
    drawn += [_text(said, spot, TALL - FOOT + 18, MUTED, "middle") for spot, said in x_ticks(points.factors[0], x)]
    drawn += [_text(said, LEFT - 8, spot + 5, MUTED, "end") for spot, said in x_ticks(points.factors[1], y)]
    return _whole(drawn, points, word, low, high)


def colour(value: float, low: float, high: float) -> tuple[str, str]:
    """(fill, ink) of a value between two others; grey where it is not known."""
    if not is_number(float(value)):
        return "#e3e6ea", INK
    share = 0.5 if high <= low else (value - low) / (high - low)
    fill = "#" + "".join(f"{round(a + share * (b - a)):02x}" for a, b in zip(LOW, HIGH))
    return fill, "#ffffff" if share > 0.55 else INK


def _whole(drawn: Sequence[str], points: Any, word: str, low: float, high: float) -> str:
    titles = [fitting(f.path + (f", {f.unit}" if f.unit and f.is_number else "")) for f in points.factors]
    across = _text(titles[0], (LEFT + WIDE - RIGHT) / 2, TALL - 12, INK, "middle")
    beside = _text(titles[1], 0, 0, INK, "middle")
    up = f'<g transform="translate(14 {(TALL + TOP - FOOT) / 2:.0f}) rotate(-90)">{beside}</g>'
    said = escape(f"{titles[0]} against {titles[1]}: from {digits(low)} to {digits(high)} {word}")
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} {TALL}" role="img" font-size="14" '
        f'style="width:100%;max-width:{WIDE + 100}px" aria-label="{said}">'
        f"{''.join(_scale(low, high, word))}{''.join(drawn)}{across}{up}</svg>"
    )


def _scale(low: float, high: float, word: str) -> Iterator[str]:
    """A bar of colours with the values at its ends."""
    left, wide, n = WIDE - RIGHT - 260, 120, 24
    for k in range(n):
        fill = colour(low + (k + 0.5) / n * (high - low), low, high)[0] if high > low else colour(low, low, high)[0]
        yield f'<rect x="{left + k * wide / n:.1f}" y="12" width="{wide / n + 0.4:.1f}" height="14" fill="{fill}"/>'
    yield _text(digits(low), left - 6, 24, MUTED, "end")
    yield _text(f"{digits(high)} {word}".strip(), left + wide + 6, 24, MUTED, "start")


def _text(words: str, x: float, y: float, ink: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{ink}" text-anchor="{anchor}">{escape(words)}</text>'


def terms_table(found: Any) -> Table:
    """A row a term: the figure in the middle of all factors, then what a unit of each factor adds, and its square."""
    response = found.response
    factor, word = scale_of(found.key[3], largest_of(found))
    rows = []
    for place, term in enumerate(response.terms):
        per = 1.0
        for column, what in term:
            per *= response.room.half[column] ** what if what > 0 else 1.0
        value, half = (of[place] * factor / per for of in (response.coefficients, response.half_widths))
        rows.append((_name(term, found, response), _about(float(value), float(half)), _unit(term, found, word)))
    return Table(("term", "coefficient", "unit"), rows)


def _name(term: Any, found: Any, response: Any) -> str:
    if not term:
        return "in the middle of all factors"
    parts = []
    for column, what in term:
        factor = found.factors[column]
        if what < 0:
            parts.append(f"({factor.path} is {factor.words(factor.values[-what])})")
            continue
        middle = f"{response.room.centre[column]:.6g} {factor.unit}".strip()
        parts.append(f"({factor.path} − {middle}){'²' if what == 2 else ''}")
    return " × ".join(parts)


def _unit(term: Any, found: Any, word: str) -> str:
    per = [f"{found.factors[column].unit or 'unit'}{'²' if what == 2 else ''}" for column, what in term if what > 0]
    return word + (f" for each {' and '.join(per)}" if per else "")


def _about(value: float, half: float) -> str:
    """With four digits, as a slope may be small."""
    if not is_number(half) or not half:
        return _plain(value)
    if abs(value) < 0.01 or half < 0.001:
        return f"{value:.3g} ± {half:.2g}".replace("-", "\N{MINUS SIGN}")
    return f"{digits(value, half)} ± {half_digits(value, half)}"


def _plain(value: float) -> str:
    return digits(value) if abs(value) >= 0.01 else f"{value:.3g}"


def sensitivity_section(found: Any, design: str, on_screen: bool) -> StudySection:
    """found : a Found of a design for Sobol indices or of Morris."""
    title = f"{axis_name(found.key)}: which factor matters"
    pairs = sorted(zip(found.factors, found.sensitivity), key=lambda pair: -pair[1].total)
    if design == "morris":
        return _morris(title, found, pairs, on_screen)
    rows = [
        (f.path, _index_about(100 * s.alone, 100 * s.alone_half), _index_about(100 * s.total, 100 * s.total_half))
        for f, s in pairs
    ]
    said = (
        "Share of the figure's variance over the ranges. 'Alone' adds up to 100 % where no two factors act together; "
        "where 'alone and with others' is near 0 the factor may be left as it is."
    )
    picture = sensitivity_svg(found.factors, found.sensitivity, 100.0, "share of the variance, %")
    table = Table(("factor", "alone, %", "alone and with others, %"), rows)
    return StudySection(title, [said], table, picture, SOBOL_LEGEND, on_screen)


def _morris(title: str, found: Any, pairs: Sequence[tuple[Any, Any]], on_screen: bool) -> StudySection:
    factor, word = scale_of(found.key[3], largest_of(found))
    unit = difference_unit(word)
    rows = [
        (
            f.path,
            _index_about(s.total * factor, s.total_half * factor),
            _index_about(s.alone * factor, s.alone_half * factor),
            digits(s.spread * factor),
        )
        for f, s in pairs
    ]
    said = (
        "Change of the figure when one factor goes over its whole range (of values without order: from one to "
        "another). A size above the change with its sign, or a large spread, says that the effect is "
        "bent or depends on other factors."
    )
    picture = sensitivity_svg(found.factors, found.sensitivity, factor, f"change over the whole range, {unit}")
    table = Table(("factor", f"size of the change, {unit}", f"with its sign, {unit}", "spread"), rows)
    return StudySection(title, [said], table, picture, MORRIS_LEGEND, on_screen)


def _index_about(value: float, half: float) -> str:
    return f"{digits(value, half)} ± {half_digits(value, half)}" if is_number(half) and half else digits(value)
