"""Pictures of a labour study: what buys the loss back, and how days come out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from opsim.report.frontier import axis_name
from opsim.report.interval_picture import ticks
from opsim.report.labels import shortened
from opsim.report.labour_shapes import GAIN, LOSS, SIDE, WIDE, Scale, across, box, padded, svg, text_at, tick_words
from opsim.report.palette import ACCENT, GRID, INK, MUTED
from opsim.report.words import is_number

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
