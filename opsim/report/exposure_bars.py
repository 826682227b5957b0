"""Bars of minutes at high scores: what is sure, and what may be; with the interval over replications."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from opsim.report.exposure_rows import Bar
from opsim.report.figures import FONT, label, layout_of
from opsim.report.palette import INK
from opsim.report.words import digits

SEVEN, FIVE, PERHAPS = ("#8F2D06", "RULA 7"), ("#EBA02A", "RULA 5 or 6"), ("#F7DFAE", "perhaps 5 or more")
"""Colours that differ in lightness too, and their words."""


def level_bars(bars: Sequence[Bar], *, upright: bool = False) -> dict[str, Any]:
    """One stacked bar a subject. upright : bars stand on an axis of time, else they lie below each other"""
    parts = {
        SEVEN: [bar.seven for bar in bars],
        FIVE: [max(bar.five - bar.seven, 0.0) for bar in bars],
        PERHAPS: [bar.most - bar.five for bar in bars],
    }
    data = [_stack(bars, values, *look, upright) for look, values in parts.items() if max(values, default=0.0) > 1e-9]
    if not data:
        data = [_stack(bars, [0.0] * len(bars), *FIVE, upright)]
    return {"data": [*data, *_intervals(bars, upright)], "layout": _layout(bars, upright)}


def legend(bars: Sequence[Bar]) -> list[tuple[str, str]]:
    """(colour, words) of what the bars show."""
    there = {
        SEVEN: any(bar.seven > 0 for bar in bars),
        FIVE: any(bar.five > bar.seven for bar in bars),
        PERHAPS: any(bar.is_open for bar in bars),
    }
    return [look for look, is_there in there.items() if is_there]


def said(bars: Sequence[Bar]) -> str:
    """The figure in words."""
    return "; ".join(
        f"{bar.subject}: {digits(bar.seven)} minutes of an hour at RULA 7, {digits(bar.five)} at 5 or more"
        + (f", at most {digits(bar.most)}" if bar.is_open else "")
        for bar in bars
    )


def _stack(bars: Sequence[Bar], values: Sequence[float], colour: str, words: str, upright: bool) -> dict[str, Any]:
    places = list(range(len(bars)))
    along, across = ("y", "x") if upright else ("x", "y")
    return {
        "type": "bar",
        "orientation": "v" if upright else "h",
        "name": words,
        along: list(values),
        across: places,
        "width": 0.66,
        "marker": {"color": colour, "line": {"color": "#ffffff", "width": 1}},
        "customdata": [[label(bar.subject), digits(value)] for bar, value in zip(bars, values)],
        "hovertemplate": f"%{{customdata[0]}}: {words} %{{customdata[1]}} min/h<extra></extra>",
    }


def _intervals(bars: Sequence[Bar], upright: bool) -> list[dict[str, Any]]:
    """The interval over replications, at the end of what is sure."""
    places = [place for place, bar in enumerate(bars) if math.isfinite(bar.low) and math.isfinite(bar.high)]
    if not places:
        return []
    along, across = ("y", "x") if upright else ("x", "y")
    error = {
        "type": "data",
        "symmetric": False,
        "array": [bars[place].high - bars[place].five for place in places],
        "arrayminus": [bars[place].five - bars[place].low for place in places],
        "color": INK,
        "thickness": 1.6,
        "width": 5,
    }
    return [
        {
            "type": "scatter",
            "mode": "markers",
            along: [bars[place].five for place in places],
            across: places,
            "marker": {"size": 1, "color": INK},
            f"error_{along}": error,
            "hoverinfo": "skip",
        }
    ]


def _layout(bars: Sequence[Bar], upright: bool) -> dict[str, Any]:
    places, words = list(range(len(bars))), [label(bar.subject) for bar in bars]
    layout = layout_of(280 if upright else 74 + 36 * len(bars)) | {"barmode": "stack"}
    names, minutes = ("xaxis", "yaxis") if upright else ("yaxis", "xaxis")
    top = max((max(bar.most, bar.high if math.isfinite(bar.high) else 0.0) for bar in bars), default=0.0)
    title = {"text": "minutes of an hour", "standoff": 6, "font": {**FONT, "size": 12}}
    layout[minutes] |= {"range": [0, 1.06 * top or 1.0], "title": title, "nticks": 7}
    layout[names] |= {"tickvals": places, "ticktext": words, "showgrid": False}
    layout[names]["range"] = [-0.6, len(bars) - 0.4] if upright else [len(bars) - 0.4, -0.6]
    return layout
