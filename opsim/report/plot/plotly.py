"""The colours of states: Okabe and Ito's, told apart with any colour vision, with the word beside them everywhere.

Figures as plain dicts that plotly.js draws. Every name is escaped, as plotly reads its labels as half HTML.

Axes that are a clock: what a run's seconds are to plotly, which knows dates, and how its ticks read.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

import numpy as np

from opsim.report.numbers import is_number

STATE_COLOURS = {
    "work": ("#0072B2", "#ffffff"),
    "walk": ("#56B4E9", "#111111"),
    "setup": ("#009E73", "#ffffff"),
    "transport": ("#7BC8A4", "#111111"),
    "held": ("#CC79A7", "#111111"),
    "team": ("#B58BB0", "#111111"),
    "behind": ("#D9A9C4", "#111111"),
    "parts": ("#C9B037", "#111111"),
    "tool": ("#A8894A", "#111111"),
    "place": ("#E58A5A", "#111111"),
    "pickup": ("#9CCBB3", "#111111"),
    "away": ("#C6B3D9", "#111111"),
    "takt": ("#B9D3C2", "#111111"),
    "line_stop": ("#C2185B", "#ffffff"),
    "pause": ("#A3AED0", "#111111"),
    "blocked": ("#D55E00", "#ffffff"),
    "waiting": ("#E69F00", "#111111"),
    "queue": ("#F0E442", "#111111"),
    "down": ("#7a1f1f", "#ffffff"),
    "repair": ("#a05a5a", "#ffffff"),
    "wait": ("#dde1e6", "#111111"),
    "rest": ("#D9B8CC", "#111111"),
    "meeting": ("#7E6BA8", "#ffffff"),
    "break": ("#b9a7d6", "#111111"),
    "absent": ("#8d8d8d", "#ffffff"),
    "off": ("#bcbcbc", "#111111"),
    "starved": ("#eceff2", "#111111"),
    "closed": ("#c9c4bb", "#111111"),
    "loaded": ("#1F7FB8", "#ffffff"),
    "handling": ("#2BAA7E", "#ffffff"),
    "empty": ("#8AC9EC", "#111111"),
    "free": ("#E4E8EC", "#111111"),
    "below_20": ("#8CC5E3", "#111111"),
    "from_20_to_60": ("#F0A830", "#111111"),
    "beyond_60": ("#B0410B", "#ffffff"),
    "walking_below_20": ("#A6DCC3", "#111111"),
    "walking_from_20": ("#CDA53B", "#111111"),
    "unmeasured": ("#9AA1A9", "#111111"),
    "walking_unmeasured": ("#BFC5CC", "#111111"),
    "rula_from_5": ("#EBA02A", "#111111"),
    "perhaps_from_5": ("#F7DFAE", "#111111"),
    "rula_below_5": ("#9CC7E0", "#111111"),
    "waits": ("#f1f3f5", "#111111"),
    "not_at_work": ("#edf0f3", "#111111"),
}
OTHER = ("#999999", "#111111")

WORDS = {
    "wait": "idle",
    "waiting": "job there, no worker",
    "starved": "no job",
    "blocked": "blocked by the next buffer",
    "held": "held by a blocked job",
    "setup": "set-up",
    "team": "waiting for the rest of the team",
    "behind": "waiting for who is ahead",
    "parts": "waiting for parts",
    "tool": "waiting for a tool",
    "place": "waiting for a place kept downstream",
    "pickup": "waiting for a transporter",
    "away": "waiting for who began it",
    "takt": "done, waiting for the line to move",
    "line_stop": "done, and the line stands",
    "pause": "the line pauses: nobody is there",
    "closed": "closed by its calendar",
    "break": "in a break",
    "rest": "at rest, being too tired",
    "meeting": "in a meeting",
    "absent": "absent",
    "off": "off shift",
    "down": "down, nobody repairs yet",
    "repair": "being repaired or maintained",
    "loaded": "driving with jobs",
    "handling": "loading or unloading",
    "empty": "driving empty",
    "free": "standing free",
    "below_20": "trunk flexed less than 20°",
    "from_20_to_60": "20° to 60°",
    "beyond_60": "60° or more",
    "unmeasured": "at work, posture not known",
    "walking_below_20": "walking, trunk flexed less than 20°",
    "walking_from_20": "walking, 20° or more",
    "walking_unmeasured": "walking, posture not known",
    "rula_from_5": "RULA 5 or more",
    "perhaps_from_5": "perhaps 5 or more",
    "rula_below_5": "below 5",
    "waits": "waiting, not measured",
    "not_at_work": "walking or waiting, not measured",
}

ACCENT, INK, MUTED, GRID = "#0072B2", "#22262b", "#5c6570", "#e3e6ea"


def in_order(parts) -> list[str]:
    """States in the order of the palette, unknown ones last."""
    order = list(STATE_COLOURS)
    return sorted(set(parts), key=lambda part: (order.index(part) if part in order else len(order), part))


FONT = {"family": "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif", "size": 13, "color": INK}
LONGEST_LABEL = 22
QUARTERS = ["0 %", "25 %", "50 %", "75 %", "100 %"]
Row = Mapping[str, Any]


def label(name: str) -> str:
    """A name as an axis shows it: short, and with nothing that plotly could read as markup."""
    short = name if len(name) <= LONGEST_LABEL else name[: LONGEST_LABEL - 1] + "…"
    return escape(short, quote=False)


def states(rows: Sequence[Row]) -> dict[str, Any]:
    """Stacked bars, one a subject, of shares that sum to 1. rows: KPI rows of one kind of state, mean in shares."""
    subjects = list(dict.fromkeys(row["subject"] for row in rows))
    share = {(row["subject"], row["part"]): row["mean"] or 0.0 for row in rows if is_number(row["mean"])}
    data = [_state_bar(part, [share.get((s, part), 0.0) for s in subjects], subjects) for part in state_parts(rows)]
    layout = layout_of(34 + 38 * len(subjects)) | {"barmode": "stack", "bargap": 0.3}
    layout["margin"] |= {"t": 6}
    layout["xaxis"] |= {"range": [0, 1.0005], "tickvals": [0, 0.25, 0.5, 0.75, 1], "ticktext": QUARTERS}
    places = list(range(len(subjects)))
    layout["yaxis"] |= {"tickvals": places, "ticktext": [label(s) for s in subjects], "showgrid": False}
    layout["yaxis"]["range"] = [len(subjects) - 0.5, -0.5]
    return {"data": data, "layout": layout}


def state_parts(rows: Sequence[Row]) -> list[str]:
    """The states that take any time at all, in the palette's order."""
    return in_order(row["part"] for row in rows if is_number(row["mean"]) and row["mean"] > 0)


def legend(rows: Sequence[Row]) -> list[tuple[str, str]]:
    """(colour, words) of each state in the figure."""
    return [(STATE_COLOURS.get(part, OTHER)[0], WORDS.get(part, part)) for part in state_parts(rows)]


def wrong_sums(rows: Sequence[Row]) -> list[tuple[str, float]]:
    """Subjects whose shares do not sum to 1 within half a per mille, with their sum: the report says so."""
    sums: dict[str, float] = {}
    for row in rows:
        sums[row["subject"]] = sums.get(row["subject"], 0.0) + (row["mean"] if is_number(row["mean"]) else 0.0)
    return [(subject, total) for subject, total in sums.items() if abs(total - 1) > 5e-4]


def _state_bar(part: str, shares: list[float], subjects: list[str]) -> dict[str, Any]:
    fill, ink = STATE_COLOURS.get(part, OTHER)
    word = escape(WORDS.get(part, part), quote=False)
    return {
        "type": "bar",
        "orientation": "h",
        "name": word,
        "x": shares,
        "y": list(range(len(subjects))),
        "marker": {"color": fill, "line": {"color": "#ffffff", "width": 1}},
        "text": [f"{100 * share:.0f} %" if share >= 0.08 else "" for share in shares],
        "textposition": "inside",
        "insidetextanchor": "middle",
        "textangle": 0,
        "textfont": {"color": ink, "size": 12},
        "customdata": [label(s) for s in subjects],
        "hovertemplate": f"%{{customdata}}: {word} %{{x:.1%}}<extra></extra>",
    }


def layout_of(height: int) -> dict[str, Any]:
    axis = {"gridcolor": GRID, "zeroline": False, "automargin": True, "fixedrange": True, "linecolor": GRID}
    return {
        "height": height,
        "margin": {"l": 8, "r": 14, "t": 34, "b": 34},
        "font": FONT,
        "paper_bgcolor": "rgba(0,0,0,0)",
        "plot_bgcolor": "rgba(0,0,0,0)",
        "showlegend": False,
        "dragmode": False,
        "hoverlabel": {"font": {**FONT, "size": 12}},
        "xaxis": dict(axis),
        "yaxis": dict(axis),
    }


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
