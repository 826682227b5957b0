"""Curves over the clock of a run, told apart by colour and by dashes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise
from typing import Any

import numpy as np

from opsim.report.figures import FONT, label, layout_of
from opsim.report.words import clock

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#B5578F", "#B07C00", "#2A9BD6", "#333333", "#7E6BA8")
"""Okabe and Ito's, darkened so that a thin line stands out."""
DASHES = ("solid", "dash", "dot", "dashdot")
MOST_POINTS = 700
STEPS_S = (600.0, 900.0, 1800.0, 3600.0, 7200.0, 14400.0, 21600.0, 43200.0, 86400.0, 172800.0, 604800.0)
MOST_TICKS = 6


@dataclass(frozen=True, eq=False)
class Curve:
    """``value`` (T,), a share, at ``at_s`` (T,) of the run."""

    name: str
    at_s: np.ndarray
    value: np.ndarray


def thinned(at_s: np.ndarray, value: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """At most MOST_POINTS of some points in the order of time: the lowest and the highest of each stretch."""
    if at_s.size <= MOST_POINTS:
        return at_s, value
    edges = np.linspace(0, at_s.size, MOST_POINTS // 2 + 1).astype(int)
    stretches = [slice(first, last) for first, last in pairwise(edges.tolist())]
    ends = {0, at_s.size - 1}
    for stretch in stretches[1:-1]:
        ends |= {stretch.start + int(value[stretch].argmin()), stretch.start + int(value[stretch].argmax())}
    kept = sorted(ends)
    return at_s[kept], value[kept]


def curves_figure(curves: Sequence[Curve], start: str, unit: str) -> dict[str, Any]:
    """A line a curve, in per cent. start : when the run began; unit : what the axis says"""
    data = [
        {
            "type": "scatter",
            "mode": "lines",
            "name": escape(curve.name, quote=False),
            "x": [round(float(at_s), 1) for at_s in curve.at_s],
            "y": [round(100 * float(value), 3) for value in curve.value],
            "line": {"color": colour, "width": 1.8, "dash": dash},
            "hovertemplate": f"{label(curve.name)}: %{{y:.1f}} %<extra></extra>",
        }
        for curve, (colour, dash) in zip(curves, _looks(len(curves)))
    ]
    layout = layout_of(300)
    ends_s = [end for curve in curves for end in (curve.at_s[0], curve.at_s[-1])]
    at_s = ticks_s(start, float(min(ends_s, default=0.0)), float(max(ends_s, default=1.0)))
    layout["xaxis"] |= {"tickvals": at_s, "ticktext": [_tick(start, one, at_s) for one in at_s]}
    layout["yaxis"] |= {"rangemode": "tozero", "title": {"text": unit, "standoff": 8, "font": {**FONT, "size": 12}}}
    return {"data": data, "layout": layout}


def curves_legend(curves: Sequence[Curve]) -> list[tuple[str, str, str]]:
    """(colour, CSS border style, name) of each."""
    css = {"solid": "solid", "dash": "dashed", "dot": "dotted", "dashdot": "dashed"}
    return [(colour, css[dash], curve.name) for curve, (colour, dash) in zip(curves, _looks(len(curves)))]


def _looks(n: int) -> list[tuple[str, str]]:
    """Neighbours differ in both, so that nobody has to tell colours apart."""
    return [(COLOURS[i % len(COLOURS)], DASHES[i % len(DASHES)]) for i in range(n)]


def ticks_s(start: str, low_s: float, high_s: float) -> list[float]:
    """Round times of the clock within some seconds of the run; few enough to be read."""
    step_s = next((step for step in STEPS_S if (high_s - low_s) / step <= MOST_TICKS), STEPS_S[-1])
    words = clock(start, 0).split()
    hours, _, minutes = words[-1].partition(":")
    begin_s = int(hours) * 3600 + int(minutes) * 60 if hours.isdigit() and minutes.isdigit() else 0
    first = int(np.ceil((begin_s + low_s) / step_s - 1e-9))
    last = int(np.floor((begin_s + high_s) / step_s + 1e-9))
    return [step_s * n - begin_s for n in range(first, last + 1)]


def _tick(start: str, at_s: float, all_s: Sequence[float]) -> str:
    """``07:30``; with the day where they are a day apart, and at the first."""
    day, _, time = clock(start, at_s).partition(" ")
    if len(time) != 5:
        return f"{at_s / 3600:g} h"
    apart_s = all_s[1] - all_s[0] if len(all_s) > 1 else 0.0
    return (
        day
        if apart_s >= 86400 and time == "00:00"
        else f"{day} {time}"
        if at_s == all_s[0] or time == "00:00"
        else time
    )
