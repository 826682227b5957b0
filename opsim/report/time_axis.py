"""Axes that are a clock: what a run's seconds are to plotly, which knows dates, and how its ticks read."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.report.figures import FONT
from opsim.report.palette import MUTED

MONDAY_MS = 4 * 86_400_000
"""Milliseconds from 1970-01-01, a Thursday, to the Monday 00:00 that every run's Monday is drawn as."""
SHADE = "#f3f1ec"
"""Behind a warm-up, which no figure counts."""


def at_ms(start_s: float, at_s: Any) -> np.ndarray:
    """Whole milliseconds as plotly counts them, for seconds of the run. start_s : when it began, after Monday 00:00"""
    return np.rint(MONDAY_MS + 1000.0 * (start_s + np.asarray(at_s, dtype=float))).astype(np.int64)


def clock_axis(start_s: float, low_s: float, high_s: float, *, zoomed: bool = False) -> dict[str, Any]:
    """What an x-axis gets to read as a clock from ``low_s`` to ``high_s`` of the run, the day below the first time of
    each. zoomed : whether whoever looks may go nearer and along it"""
    low, high = at_ms(start_s, [low_s, high_s]).tolist()
    return {
        "type": "date",
        "range": [low, high],
        **({"minallowed": low, "maxallowed": high} if zoomed else {}),
        "tickformat": "%H:%M\n%a",
        "tickformatstops": [
            {"dtickrange": [None, 59_999], "value": "%H:%M:%S\n%a"},
            {"dtickrange": [60_000, 86_399_999], "value": "%H:%M\n%a"},
            {"dtickrange": [86_400_000, None], "value": "%a"},
        ],
        "nticks": 7,
        "fixedrange": not zoomed,
        "tickangle": 0,
        "tickfont": {**FONT, "size": 12, "color": MUTED},
    }


def shaded(start_s: float, low_s: float, high_s: float) -> dict[str, Any]:
    """A rectangle behind everything from ``low_s`` to ``high_s``: the warm-up."""
    x0, x1 = at_ms(start_s, [low_s, high_s]).tolist()
    place = {"xref": "x", "yref": "paper", "x0": x0, "x1": x1, "y0": 0, "y1": 1}
    return {"type": "rect", **place, "fillcolor": SHADE, "line": {"width": 0}, "layer": "below"}
