"""Shapes and axes of the pictures of a labour study, as SVG text; names are escaped here."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from html import escape

import numpy as np

from opsim.report.interval_picture import ticks
from opsim.report.palette import GRID, INK, MUTED
from opsim.report.words import is_number

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
