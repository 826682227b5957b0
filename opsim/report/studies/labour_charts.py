"""Shapes and axes of the pictures of a labour study, as SVG text; names are escaped here.

Pictures of a labour study: what buys the loss back, and how days come out.

Numbers of a labour study as people read them.

Pictures of a labour study: whose share of the variance is how large, and the budget as a waterfall.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from html import escape
from typing import Any

import numpy as np

from opsim.report.numbers import ABSENT, digits, half_digits, is_number, scale_of
from opsim.report.plot.plotly import ACCENT, GRID, INK, MUTED
from opsim.report.plot.svg_chart import shortened, ticks
from opsim.report.sections.pareto import axis_name

WIDE, SIDE = 460, 14
GAIN, LOSS = "#009E73", "#D55E00"
Scale = Callable[[float], float]
"""Where a value stands in the picture."""


def across(ends: np.ndarray, foot: float, name: str) -> tuple[Scale, list[str]]:
    """(where a value stands, the axis); ends : all that has to be seen; foot : where the axis is."""
    low, high = padded(float(ends.min()), float(ends.max()))

    def x(value: float) -> float:
        return SIDE + (value - low) / (high - low) * (WIDE - 2 * SIDE)

    steps = ticks(low, high)
    drawn = [f'<path d="M{x(at):.1f} 0V{foot}" stroke="{GRID}"/>' for at in steps]
    drawn += [text_at(tick_words(at, steps), x(at), foot + 15, MUTED, "middle", 12) for at in steps]
    drawn.append(text_at(name, WIDE - SIDE, foot + 33, MUTED, "end", 12))
    return x, drawn


def padded(low: float, high: float) -> tuple[float, float]:
    """With a margin on both sides."""
    margin = 0.07 * (high - low) or 0.05 * abs(high) or 1.0
    return low - margin, high + margin


def tick_words(at: float, steps: Sequence[float]) -> str:
    """A round number of an axis with these steps."""
    apart = steps[1] - steps[0] if len(steps) > 1 else 1.0
    places = max(0, -math.floor(math.log10(apart) + 1e-9))
    return f"{at:,.{places}f}".replace("-", "\N{MINUS SIGN}")


def whisker(x: Scale, low: float, high: float, y: float) -> str:
    """An interval as a line; nothing where it is not known."""
    if not (is_number(low) and is_number(high)) or high <= low:
        return ""
    return f'<path d="M{x(low):.1f} {y}H{x(high):.1f}" stroke="{INK}" stroke-width="1.6"/>'


def box(x: float, y: float, wide: float, tall: float, fill: str) -> str:
    """A filled rectangle."""
    return f'<rect x="{x:.1f}" y="{y:.1f}" width="{max(wide, 0):.1f}" height="{max(tall, 0):.1f}" fill="{fill}"/>'


def text_at(
    text: str, x: float, y: float, fill: str = INK, anchor: str = "start", size: int = 13, weight: str = ""
) -> str:
    """A text; what is in it is no markup."""
    bold = f' font-weight="{weight}"' if weight else ""
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" fill="{fill}" text-anchor="{anchor}" font-size="{size}"{bold}>'
        f"{escape(text)}</text>"
    )


def svg(drawn: Iterable[str], tall: float, said: str) -> str:
    """The whole picture; ``said`` is what it shows, for who does not see it."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} {tall:.0f}" role="img" font-size="13" '
        f'style="width:100%;max-width:{WIDE + 160}px" aria-label="{escape(said)}">{"".join(drawn)}</svg>'
    )


LINES = (ACCENT, "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7E6BA8", "#5c6570")
LEFT, TOP, TALL, FLOOR, FOOT = 46, 18, 250, 170, 40
PALE, LOSS_PALE = "#9DB7CC", "#f3e2d6"


def bought_svg(bought: Any) -> str:
    """What is gained by one step more and the next, and the loss that is to be bought back, with intervals."""
    steps = [step for curve in bought.curves for step in curve.steps]
    most = max(step.count for step in steps)
    ends = [0.0, bought.loss.low, bought.loss.high, *(at for s in steps for at in (s.gained.low, s.gained.high))]
    low, high = padded(min(filter(is_number, ends)), max(filter(is_number, ends)))

    def y(value: float) -> float:
        return TOP + (high - value) / (high - low) * (TALL - TOP)

    def x(count: float) -> float:
        return LEFT + count / most * (WIDE - LEFT - SIDE - 6)

    drawn = [*_grid(ticks(low, high), most, x, y), *_loss(bought.loss, y)]
    middle, foot = (len(bought.curves) - 1) / 2, TALL + 34
    for number, curve in enumerate(bought.curves):
        colour = LINES[number % len(LINES)]
        drawn += _curve(curve, x, y, colour, 3.0 * (number - middle))
        drawn.append(box(SIDE, foot + 18 * number, 11, 11, colour))
        drawn.append(text_at(shortened(curve.name), SIDE + 17, foot + 18 * number + 10, MUTED))
    said = "; ".join(f"{c.name} +{s.count}: {s.gained.mean:+.2f} an hour" for c in bought.curves for s in c.steps)
    return svg(drawn, foot + 18 * len(bought.curves) + 4, f"gained an hour: {said}")


def _grid(steps: Sequence[float], most: int, x: Scale, y: Scale) -> Iterator[str]:
    for at in steps:
        yield f'<path d="M{LEFT} {y(at):.1f}H{WIDE - SIDE}" stroke="{GRID}"/>'
        yield text_at(tick_words(at, steps), LEFT - 6, y(at) + 4, MUTED, "end", 12)
    for count in range(1, most + 1):
        yield text_at(f"+{count}", x(count), TALL + 18, MUTED, "middle", 12)
    yield text_at("gained an hour", LEFT, TOP - 4, MUTED, "start", 12)


def _loss(loss: Any, y: Scale) -> Iterator[str]:
    yield box(LEFT, y(loss.high), WIDE - SIDE - LEFT, y(loss.low) - y(loss.high), LOSS_PALE)
    yield f'<path d="M{LEFT} {y(loss.mean):.1f}H{WIDE - SIDE}" stroke="{LOSS}" stroke-dasharray="6 4"/>'
    yield text_at("the loss", LEFT + 6, y(loss.mean) - 5, LOSS, "start", 12)


def _curve(curve: Any, x: Scale, y: Scale, colour: str, aside: float) -> Iterator[str]:
    at = [(x(step.count) + aside, y(step.gained.mean), step.gained) for step in curve.steps]
    path = f"M{x(0):.1f} {y(0.0):.1f}" + "".join(f"L{px:.1f} {py:.1f}" for px, py, _ in at)
    yield f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="1.8"/>'
    for px, py, gained in at:
        if is_number(gained.half_width):
            ends = f"{y(gained.low):.1f}V{y(gained.high):.1f}"
            yield f'<path d="M{px:.1f} {ends}" stroke="{colour}" stroke-width="1.5"/>'
        yield f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3.5" fill="{colour}"/>'


def day_svg(day: Any) -> str:
    """A histogram over people and days, with P5, P50, P95 and the target; nothing where all days are alike."""
    values = np.sort(day.values, axis=None)
    low, high = float(values[0]), float(values[-1])
    if high <= low:
        return ""
    target = day.asked.target
    bound = target.bound if target is not None and _near(target.bound, low, high) else None
    count, edges = np.histogram(values, bins=_edges(low, high, values.size, bound))
    name = "good units of a day" if day.asked.a_day else axis_name(day.key)
    x, drawn = across(np.array([low, high, *([] if bound is None else [bound])]), FLOOR, name)
    for n, left, right in zip(count, edges[:-1], edges[1:]):
        up = (FLOOR - 36) * n / count.max()
        drawn.append(box(x(left) + 0.5, FLOOR - up, max(x(right) - x(left) - 1, 1.0), up, _fill(target, left, right)))
    for one in day.quantiles:
        drawn.append(f'<path d="M{x(one.estimate):.1f} 22V{FLOOR}" stroke="{INK}" stroke-dasharray="2 3"/>')
        drawn.append(text_at(f"P{100 * one.q:.0f}", x(one.estimate), 17, INK, "middle", 12))
    if bound is not None:
        drawn.append(f'<path d="M{x(bound):.1f} 22V{FLOOR}" stroke="{LOSS}" stroke-width="2"/>')
        drawn.append(text_at("target", x(bound) + 4, 34, LOSS, "start", 12))
    said = ", ".join(f"P{100 * one.q:.0f} {one.estimate:.4g}" for one in day.quantiles)
    return svg(drawn, FLOOR + FOOT, f"{name}: {said}")


def _edges(low: float, high: float, n: int, bound: float | None) -> np.ndarray:
    """Of the columns of n values; the target, where there is one, lies between two of them."""
    wide = (high - low) / int(np.clip(round(2 * n**0.5), 6, 18))
    first = low if bound is None else bound - wide * np.ceil((bound - low) / wide)
    return first + wide * np.arange(int(np.floor((high - first) / wide)) + 2)


def _fill(target: Any, left: float, right: float) -> str:
    """Green where the target is met."""
    if target is None:
        return ACCENT
    return GAIN if ((left + right) / 2 >= target.bound) == target.at_least else PALE


def _near(value: float, low: float, high: float) -> bool:
    return low - 0.5 * (high - low) <= value <= high + 0.5 * (high - low)


MINUS, PLUS_MINUS = "\N{MINUS SIGN}", "\N{PLUS-MINUS SIGN}"
FROM_0_TO_1 = ", from 0 (fresh) to 1"
LEAST = 0.005
"""Per cent that are told as 0."""
_COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve")


def figure_name(key: Sequence[str], unit: str) -> str:
    """A figure in words beside numbers in ``unit``: one in per cent does not say that it goes from 0 to 1."""
    name = axis_name(key)
    return name.replace(FROM_0_TO_1, "") if unit == "%" else name


def budget_cell(one: Any, interval: Any) -> str:
    """``+3.2 ± 0.4``; a dash where it is not known."""
    factor, _ = scale_of(one.key[3], one.full.mean)
    if not is_number(interval.mean):
        return ABSENT
    return signed(interval.mean * factor, interval.half_width * factor)


def signed(mean: float, half: float) -> str:
    if mean == 0 and half == 0:
        return "0"
    text = digits(mean, half)
    sign = "" if text.startswith(MINUS) or float(text.replace(",", "")) == 0 else "+"
    return f"{sign}{text} {PLUS_MINUS} {half_digits(mean, half)}"


def plus_minus(interval: Any, absolute: bool = False) -> str:
    if absolute:
        return (
            f"{digits(abs(interval.mean), interval.half_width)} {PLUS_MINUS} "
            f"{half_digits(interval.mean, interval.half_width)}"
        )
    return signed(interval.mean, interval.half_width)


def of_mean(sd: float, mean: float, sign: bool = True) -> str:
    share = 100 * sd / abs(mean) if mean else math.nan
    if not is_number(share):
        return ABSENT
    share = 0.0 if share < LEAST else share
    return f"{PLUS_MINUS + ' ' if sign else ''}{share:.2g} %" if share < 99.5 else f"{share:.0f} %"


def per_cent(share: float) -> str:
    return f"{share:.0f} %".replace("-", MINUS) if is_number(share) else ABSENT


def span(low: float, high: float) -> str:
    step = max(high - low, 1e-12) / 2
    return f"{digits(low, step)} to {digits(high, step)}"


def ends(low: float, high: float, step: float) -> str:
    if not is_number(low) and not is_number(high):
        return "too few runs"
    if not is_number(low):
        return f"at most {digits(high, step)}"
    return f"at least {digits(low, step)}" if not is_number(high) else f"{digits(low, step)} to {digits(high, step)}"


def share_words(share: float, unit: str = " %") -> str:
    return f"{100 * share:.0f}{unit}"


def count_words(n: int) -> str:
    return _COUNTS[n] if n < len(_COUNTS) else str(n)


def capital(text: str) -> str:
    return text[:1].upper() + text[1:]


PARTS = {
    "staffing": "who is hired",
    "day": "luck of the day, for all alike",
    "interaction": "luck of the day, for some more than others",
    "run": "luck of the day",
}


ROW, PICTURE_FOOT, OTHER = 40, 40, "#8d99a6"
ON = {"staffing": "#ffffff", "day": "#111111", "run": "#111111", "interaction": "#111111"}
COLOURS = {"staffing": ACCENT, "day": "#E69F00", "run": "#E69F00", "interaction": "#CC79A7"}


def parts_svg(parts: Mapping[Any, Any]) -> str:
    """A bar for each figure: whose share of its variance is how large."""
    drawn, seen = [], list(dict.fromkeys(part.name for one in parts.values() for part in one.parts))
    for row, (key, one) in enumerate(parts.items()):
        y = ROW * row
        drawn.append(text_at(axis_name(key), SIDE, y + 13))
        x = float(SIDE)
        for part in one.parts:
            wide = (WIDE - 2 * SIDE) * (one.share(part.name) if one.total > 0 else 0.0)
            drawn.append(box(x, y + 18, wide, 16, COLOURS[part.name]))
            if wide > 36:
                share = f"{100 * one.share(part.name):.0f} %"
                drawn.append(text_at(share, x + wide / 2, y + 30.5, ON[part.name], "middle", 12))
            x += wide
    foot = ROW * len(parts) + 6
    for line, name in enumerate(seen):
        drawn.append(box(SIDE, foot + 18 * line, 11, 11, COLOURS[name]))
        drawn.append(text_at(PARTS[name], SIDE + 17, foot + 18 * line + 10, MUTED))
    said = "; ".join(
        f"{axis_name(key)}: " + ", ".join(f"{PARTS[p.name]} {100 * one.share(p.name):.0f} %" for p in one.parts)
        for key, one in parts.items()
        if one.total > 0
    )
    return svg(drawn, foot + 18 * len(seen) + 4, said)


def budget_svg(one: Any) -> str:
    """A waterfall: from the figure as it is, source by source, to that with all of them off; lines are intervals."""
    factor, unit = scale_of(one.key[3], one.full.mean)
    steps = [*one.parts.items(), ("what they do to each other", one.interaction)]
    if not all(is_number(of.mean) for of in (one.full, one.all_off, *(of for _, of in steps))):
        return ""
    at = one.full.mean + np.concatenate([[0.0], np.cumsum([of.mean for _, of in steps])])
    ends = [*at, *(end for of in (one.full, one.all_off) for end in (of.low, of.high))]
    ends += [*(a + of.mean + s * of.half_width for a, (_, of) in zip(at, steps) for s in (-1, 1))]
    x, axis = across(np.array(ends) * factor, ROW * (len(steps) + 2), f"{figure_name(one.key, unit)}, {unit}")
    drawn = [*axis, *_level("as it is", one.full, 0, x, factor)]
    for row, (start, (name, of)) in enumerate(zip(at, steps), 1):
        y, end = ROW * row, start + of.mean
        left, right = sorted((x(start * factor), x(end * factor)))
        sure = of.low > 0 or of.high < 0
        colour = OTHER if not sure else GAIN if of.mean > 0 else LOSS
        drawn += [
            text_at(name, SIDE, y + 14),
            text_at(budget_cell(one, of), WIDE - SIDE, y + 14, MUTED, "end"),
            box(left, y + 20, max(right - left, 1.5), 12, colour),
            whisker(x, (end - of.half_width) * factor, (end + of.half_width) * factor, y + 26),
        ]
    drawn += _level("all of them off", one.all_off, len(steps) + 1, x, factor)
    said = "; ".join(f"{name}: {budget_cell(one, of)}" for name, of in steps)
    return svg(drawn, ROW * (len(steps) + 2) + PICTURE_FOOT, said)


def _level(name: str, of: Any, row: int, x: Any, factor: float) -> list[str]:
    y = ROW * row
    half = of.half_width * factor
    return [
        text_at(name, SIDE, y + 14, weight="bold"),
        text_at(digits(of.mean * factor, half), WIDE - SIDE, y + 14, INK, "end", weight="bold"),
        box(x(of.mean * factor) - 2.5, y + 17, 5, 18, INK),
        whisker(x, (of.mean - of.half_width) * factor, (of.mean + of.half_width) * factor, y + 26),
    ]
