"""Pictures of a choice: the race of running means, means with intervals beside a limit, what a search tried.

The table of a choice: who is best, by how much, who was out when and why.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from opsim.kpi.catalogue import MORE
from opsim.report.numbers import digits, half_digits, is_wide, scale_of
from opsim.report.plot.plotly import ACCENT, GRID, INK, MUTED
from opsim.report.plot.svg_chart import shortened, ticks
from opsim.report.sections.pareto import axis_name
from opsim.study.compare import paired
from opsim.study.intervals import CONFIDENCE, t_interval

WIDE, LEFT, TOP, FOOT = 560, 62, 16, 56
RACE_TALL, RACE_RIGHT, RACE_LETTERS = 380, 190, 22
ROW, NAMES, MEANS_RIGHT = 30, 228, 26
NAMED, NAME_STEP = 10, 17.0
OUT = "#b0410b"
Scale = Callable[[float], float]


@dataclass(frozen=True, slots=True)
class Runner:
    """The running mean of one variant after ``n[i]`` replications.

    kind : best, left (nobody threw it out), beaten or limit (thrown out), other (its procedure throws nobody out)
    """

    name: str
    kind: str
    n: Sequence[int]
    means: Sequence[float]


@dataclass(frozen=True, slots=True)
class Bar:
    """A mean with its interval (nan where it has none); kind as a Runner's."""

    name: str
    kind: str
    low: float
    mean: float
    high: float


def race_svg(runners: Sequence[Runner], unit: str, figure: str) -> str:
    """Running means over replications, in a unit for people; a line ends where its variant was thrown out. The first
    of them are named, so the best come first.
    """
    low, high = _span([mean for one in runners for mean in one.means])
    first, last = (
        min(one.n[0] for one in runners),
        max(max(one.n[-1] for one in runners), min(one.n[0] for one in runners) + 1),
    )
    right, foot = WIDE - RACE_RIGHT, RACE_TALL - FOOT

    def x(n: float) -> float:
        return LEFT + (n - first) / (last - first) * (right - LEFT)

    def y(value: float) -> float:
        return foot - (value - low) / (high - low) * (foot - TOP)

    drawn = [*_levels(low, high, y, right), *_counts(first, last, x, foot)]
    order = sorted(runners, key=lambda one: ("beaten", "limit", "other", "left", "best").index(one.kind))
    drawn += [_course(one, x, y) for one in order]
    drawn += _names(runners[:NAMED], x, y, right, foot)
    drawn.append(_text("replications of each", (LEFT + right) / 2, RACE_TALL - 8, MUTED, "middle"))
    drawn.append(_text(f"{figure}, {unit}" if unit else figure, 4, 11, MUTED, "start"))
    said = "; ".join(f"{one.name}: {_ending(one)}" for one in runners)
    return _svg(drawn, RACE_TALL, said)


def means_svg(bars: Sequence[Bar], unit: str, limit: tuple[float, str] | None = None) -> str:
    """A row each: a dot at the mean, a line over its interval. limit : (value, words) of a line across all rows"""
    values = [value for bar in bars for value in (bar.low, bar.mean, bar.high) if math.isfinite(value)]
    low, high = _span([*values, *([limit[0]] if limit else [])])
    top = TOP + 14 if limit else TOP
    foot, right = top + ROW * len(bars), WIDE - MEANS_RIGHT

    def x(value: float) -> float:
        return NAMES + (value - low) / (high - low) * (right - NAMES)

    drawn = [
        f'<path d="M{x(at):.1f} {top}V{foot}" stroke="{GRID}"/>' + _text(words, x(at), foot + 18, MUTED, "middle")
        for at, words in _ticks(low, high)
    ]
    if limit:
        at = x(limit[0])
        drawn.append(f'<path d="M{at:.1f} {top - 6}V{foot}" stroke="{OUT}" stroke-width="1.5" stroke-dasharray="5 4"/>')
        drawn.append(_text(limit[1], min(max(at, 80), WIDE - 80), top - 12, OUT, "middle"))
    drawn += [_bar(bar, x, top + ROW * (place + 0.5)) for place, bar in enumerate(bars)]
    drawn.append(_text(unit, right, foot + 38, MUTED, "end"))
    said = "; ".join(f"{bar.name}: {digits(bar.mean)}" for bar in bars)
    return _svg(drawn, foot + 46, said)


def trials_svg(means: Sequence[float], within: Sequence[bool], finalists: Sequence[int], unit: str, figure: str) -> str:
    """What a search saw, trial by trial: filled where it went on, grey where a limit is broken."""
    known = [mean for mean in means if math.isfinite(mean)]
    low, high = _span(known)
    foot, right, last = 280 - FOOT, WIDE - MEANS_RIGHT, max(len(means), 2)

    def x(trial: float) -> float:
        return LEFT + (trial - 1) / (last - 1) * (right - LEFT)

    def y(value: float) -> float:
        return foot - (value - low) / (high - low) * (foot - TOP)

    drawn = [*_levels(low, high, y, right), *_counts(1, last, x, foot)]
    for place, mean in enumerate(means):
        if math.isfinite(mean):
            edge = ACCENT if within[place] else MUTED
            fill = ACCENT if place in finalists else "#ffffff"
            at = f'cx="{x(place + 1):.1f}" cy="{y(mean):.1f}"'
            drawn.append(f'<circle {at} r="4" fill="{fill}" stroke="{edge}" stroke-width="1.5"/>')
    drawn.append(_text("trial", (LEFT + right) / 2, 280 - 8, MUTED, "middle"))
    drawn.append(_text(f"{figure}, {unit}" if unit else figure, 4, 11, MUTED, "start"))
    return _svg(drawn, 280, f"{len(means)} trials of {figure}")


def _svg(drawn: Sequence[str], tall: float, said: str) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} {tall:.0f}" role="img" font-size="14" '
        f'style="width:100%;max-width:{WIDE + 100}px" aria-label="{escape(said)}">{"".join(drawn)}</svg>'
    )


def _course(one: Runner, x: Scale, y: Scale) -> str:
    colour = _colour(one.kind)
    points = [f"{x(n):.1f} {y(mean):.1f}" for n, mean in zip(one.n, one.means)]
    width = 2.5 if one.kind == "best" else 1.5
    line = f'<path d="M{"L".join(points)}" fill="none" stroke="{colour}" stroke-width="{width}"/>'
    end_x, end_y = x(one.n[-1]), y(one.means[-1])
    if one.kind in ("best", "left", "other"):
        return line + f'<circle cx="{end_x:.1f}" cy="{end_y:.1f}" r="4.5" fill="{colour}"/>'
    cross = f"M{end_x - 4:.1f} {end_y - 4:.1f}l8 8m0 -8l-8 8"
    return line + f'<path d="{cross}" stroke="{colour}" stroke-width="2" fill="none"/>'


def _names(shown: Sequence[Runner], x: Scale, y: Scale, right: float, foot: float) -> Iterator[str]:
    """Beside the picture, at the height of each line's end or as near as there is room, with a thin line to it."""
    ordered = sorted(shown, key=lambda one: y(one.means[-1]))
    heights = _apart([y(one.means[-1]) for one in ordered], NAME_STEP, TOP + 4, foot)
    for one, height in zip(ordered, heights):
        end_x, end_y = x(one.n[-1]), y(one.means[-1])
        if abs(height - end_y) > 3 or right - end_x > 12:
            yield f'<path d="M{end_x + 6:.1f} {end_y:.1f}L{right + 8:.1f} {height:.1f}" stroke="{GRID}" fill="none"/>'
        name = one.name if len(one.name) <= RACE_LETTERS else one.name[: RACE_LETTERS - 1] + "…"
        yield _text(name, right + 12, height + 4.5, _colour(one.kind) if one.kind != "beaten" else INK, "start")


def _apart(wanted: Sequence[float], step: float, top: float, foot: float) -> list[float]:
    """Heights at least a step apart, as near to those wanted as pushing down and up again leaves them."""
    heights = list(wanted)
    for i in range(len(heights)):
        heights[i] = max(heights[i], heights[i - 1] + step if i else top)
    for i in reversed(range(len(heights))):
        heights[i] = min(heights[i], heights[i + 1] - step if i + 1 < len(heights) else foot)
    return heights


def _bar(bar: Bar, x: Scale, y: float) -> str:
    colour = _colour(bar.kind)
    short = shortened(bar.name)
    drawn = _text(short, NAMES - 12, y + 4.5, INK, "end")
    if math.isfinite(bar.low) and math.isfinite(bar.high):
        drawn += f'<path d="M{x(bar.low):.1f} {y:.1f}H{x(bar.high):.1f}" stroke="{colour}" stroke-width="3"/>'
    if math.isfinite(bar.mean):
        drawn += f'<circle cx="{x(bar.mean):.1f}" cy="{y:.1f}" r="5" fill="{colour}"/>'
    return drawn


def _colour(kind: str) -> str:
    return {"best": ACCENT, "left": ACCENT, "limit": OUT}.get(kind, MUTED)


def _ending(one: Runner) -> str:
    if one.kind in ("best", "left", "other"):
        return f"{one.kind} at {digits(one.means[-1])}"
    return f"out after {one.n[-1]} replications at {digits(one.means[-1])}"


def _span(values: Sequence[float]) -> tuple[float, float]:
    low, high = min(values, default=0.0), max(values, default=1.0)
    margin = 0.07 * (high - low) or 0.05 * abs(high) or 1.0
    return low - margin, high + margin


def _ticks(low: float, high: float) -> list[tuple[float, str]]:
    steps = ticks(low, high)
    apart = steps[1] - steps[0] if len(steps) > 1 else 1.0
    places = max(0, -math.floor(math.log10(apart) + 1e-9))
    return [(step, f"{step:,.{places}f}".replace("-", "\N{MINUS SIGN}")) for step in steps]


def _levels(low: float, high: float, y: Scale, right: float) -> Iterator[str]:
    for at, words in _ticks(low, high):
        yield f'<path d="M{LEFT} {y(at):.1f}H{right}" stroke="{GRID}"/>' + _text(
            words, LEFT - 8, y(at) + 4.5, MUTED, "end"
        )


def _counts(first: int, last: int, x: Scale, foot: float) -> Iterator[str]:
    whole = [round(at) for at in ticks(first, last) if first <= at <= last and abs(at - round(at)) < 1e-9]
    for at in dict.fromkeys([first, *(n for n in whole if n - first > (last - first) / 10)]):
        yield f'<path d="M{x(at):.1f} {foot}v5" stroke="{MUTED}"/>' + _text(
            f"{at:,}", x(at), foot + 20, MUTED, "middle"
        )


def _text(words: str, x: float, y: float, colour: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{escape(words)}</text>'


def columns_of(found: Any) -> tuple[str, ...]:
    """Heads of the table, with units for people."""
    head = ("variant", *(("which is",) if found.called else ()), "what became of it")
    units = [scale_in(found, column)[1] for column in range(1 + len(found.keys))]
    heads = ["mean", *(axis_name(key) for key in found.keys)]
    means = [", ".join(filter(None, pair)) for pair in zip(heads, units)]
    return (*head, means[0], "behind the best", *means[1:], "replications")


def order_of(found: Any) -> list[int]:
    """Candidates: the chosen one, then who was left, then who was out last; by their means where all else is even."""
    selection = found.selection
    out = {one.system: one.n for one in selection.out}
    sign = 1 if found.better == MORE else -1
    last = max(selection.n) + 1

    def rank(i: int) -> tuple[bool, int, float, int]:
        name = selection.systems[i]
        return name != found.winner, -out.get(name, last), -sign * selection.means[i], i

    return sorted(range(len(selection.systems)), key=rank)


def rows_of(found: Any) -> list[tuple[str, ...]]:
    """A row each, the best first."""
    selection = found.selection
    rows = []
    for i in order_of(found):
        name, of = selection.systems[i], selection.values[i][: selection.n[i]]
        halves = [t_interval(column).half_width for column in of.T]
        means = [_plus_minus(scale_in(found, c)[0], mean, halves[c]) for c, mean in enumerate(_means(found, i))]
        called = (found.called[name],) if found.called else ()
        row = (name, *called, _became(found, i), means[0], _behind(found, i), *means[1:], f"{selection.n[i]:,}")
        rows.append(row)
    return rows


def _means(found: Any, i: int) -> list[float]:
    return [found.selection.means[i], *found.selection.limited[i]]


def _plus_minus(factor: float, mean: float, half_width: float) -> str:
    half = half_width * factor if is_wide(mean, half_width) else None
    shown = digits(mean * factor, half)
    return shown if half is None else f"{shown} ± {half_digits(mean * factor, half)}"


def _behind(found: Any, i: int) -> str:
    """How far a candidate is behind the chosen one, with its interval: of pairs, or of independent means."""
    selection = found.selection
    if not found.winner or selection.systems[i] == found.winner:
        return ""
    best, factor = selection.systems.index(found.winner), scale_in(found, 0)[0]
    sign = 1 if found.better == MORE else -1
    if found.apart:
        half = welch_half_width(*(selection.values[of][: selection.n[of], 0] for of in (best, i)))
        return _plus_minus(factor, sign * (selection.means[best] - selection.means[i]), half)
    n = min(selection.n[best], selection.n[i])
    by, _, _ = paired(selection.values[best][:n, 0], selection.values[i][:n, 0])
    return "0" if by.sd == 0 and by.mean == 0 else _plus_minus(factor, sign * by.mean, by.half_width)


def welch_half_width(a: np.ndarray, b: np.ndarray, confidence: float = CONFIDENCE) -> float:
    """Of the difference of two independent means, whatever their spreads. a, b : values, two or more of each

    Source: Welch 1938, Biometrika 29:350-362; Law, Simulation Modeling and Analysis, 5th ed., section 10.2.2.
    """
    from scipy.special import stdtrit  # scipy.stats costs three times this import

    squares = np.array([of.var(ddof=1) / of.size for of in (a, b)])
    if not squares.any():
        return 0.0
    freedom = squares.sum() ** 2 / (squares[0] ** 2 / (a.size - 1) + squares[1] ** 2 / (b.size - 1))
    return float(stdtrit(freedom, (1 + confidence) / 2) * np.sqrt(squares.sum()))


def _became(found: Any, i: int) -> str:
    selection, name = found.selection, found.selection.systems[i]
    out = next((one for one in selection.out if one.system == name), None)
    if out is not None:
        by = "" if out.by == found.winner else f": behind {out.by}"
        limit = f": beyond the limit{f' on {out.limit}' if len(found.limits) > 1 else ''}"
        return f"out after {out.n}{limit if out.limit else by}"
    if name == found.winner:
        return "the best" if selection.ended != "spent" else "the best so far"
    if name in selection.tied:
        return "the same"
    if selection.needed and not found.winner:
        return f"needs {selection.needed[i]:,}"
    return "" if found.apart else "still in"


def scale_in(found: Any, column: int) -> tuple[float, str]:
    """(factor, unit for people) of the figure, or of that of a limit, the same wherever it stands."""
    selection = found.selection
    key = (found.key, *found.keys)[column]
    if selection is None:
        return scale_of(key[3], found.fresh.chosen[column].mean if found.fresh else None)
    means = selection.means if column == 0 else [of[column - 1] for of in selection.limited]
    return scale_of(key[3], max(abs(one) for one in means))
