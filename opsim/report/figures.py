"""Figures as plain dicts that plotly.js draws. Every name is escaped, as plotly reads its labels as half HTML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from opsim.report.palette import GRID, INK, OTHER, STATES, WORDS, in_order
from opsim.report.words import is_number

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
    return [(STATES.get(part, OTHER)[0], WORDS.get(part, part)) for part in state_parts(rows)]


def wrong_sums(rows: Sequence[Row]) -> list[tuple[str, float]]:
    """Subjects whose shares do not sum to 1 within half a per mille, with their sum: the report says so."""
    sums: dict[str, float] = {}
    for row in rows:
        sums[row["subject"]] = sums.get(row["subject"], 0.0) + (row["mean"] if is_number(row["mean"]) else 0.0)
    return [(subject, total) for subject, total in sums.items() if abs(total - 1) > 5e-4]


def _state_bar(part: str, shares: list[float], subjects: list[str]) -> dict[str, Any]:
    fill, ink = STATES.get(part, OTHER)
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
