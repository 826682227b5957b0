"""Figures as plain dicts that plotly.js draws. Every name is escaped, as plotly reads its labels as half HTML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from itertools import pairwise
from typing import Any

from opsim.report.palette import ACCENT, GRID, INK, MUTED, OTHER, STATES, WORDS, in_order
from opsim.report.words import digits, is_number, scale_of

FONT = {"family": "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif", "size": 13, "color": INK}
LONGEST_LABEL = 22
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
    layout = layout_of(58 + 38 * len(subjects)) | {"barmode": "stack", "bargap": 0.3}
    layout["xaxis"] |= {"range": [0, 1.0005], "tickformat": ".0%", "dtick": 0.25}
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


def histogram(distribution: Row, unit: str = "s") -> dict[str, Any]:
    """Bars of counts, with the median and the tenth and ninetieth percentiles as lines."""
    quantiles = {float(q): value for q, value in distribution["quantiles"].items()}
    factor, word = scale_of(unit, quantiles.get(0.9))
    edges = [edge * factor for edge in distribution["histogram"]["edges"]]
    counts = distribution["histogram"]["counts"]
    total = max(1, distribution.get("n") or sum(counts))
    bars = {
        "type": "bar",
        "x": [(low + high) / 2 for low, high in pairwise(edges)],
        "y": [100 * count / total for count in counts],
        "width": [high - low for low, high in pairwise(edges)],
        "marker": {"color": ACCENT, "opacity": 0.75, "line": {"width": 0.5, "color": "#ffffff"}},
        "customdata": [[digits(low), digits(high)] for low, high in pairwise(edges)],
        "hovertemplate": f"%{{customdata[0]}} to %{{customdata[1]}} {word}<br>%{{y:.1f}} %<extra></extra>",
    }
    layout = layout_of(230)
    layout["xaxis"] |= {"title": {"text": word, "standoff": 6, "font": {"size": 12}}, "showgrid": False, "nticks": 7}
    layout["yaxis"] |= {
        "title": {"text": "% of all", "standoff": 8, "font": {"size": 12}},
        "rangemode": "tozero",
        "nticks": 5,
    }
    layout["shapes"] = [_line(quantiles[q] * factor, q) for q in (0.1, 0.5, 0.9) if q in quantiles]
    layout["annotations"] = [_flag(quantiles[q] * factor, q) for q in (0.1, 0.5, 0.9) if q in quantiles]
    return {"data": [bars], "layout": layout}


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
        "text": [f"{share:.0%}" if share >= 0.08 else "" for share in shares],
        "textposition": "inside",
        "insidetextanchor": "middle",
        "textangle": 0,
        "textfont": {"color": ink, "size": 12},
        "customdata": [label(s) for s in subjects],
        "hovertemplate": f"%{{customdata}}: {word} %{{x:.1%}}<extra></extra>",
    }


def _line(at: float, quantile: float) -> dict[str, Any]:
    style = {"color": INK, "width": 1.6 if quantile == 0.5 else 1.1, "dash": "solid" if quantile == 0.5 else "dot"}
    return {"type": "line", "x0": at, "x1": at, "y0": 0, "y1": 1, "yref": "paper", "line": style}


def _flag(at: float, quantile: float) -> dict[str, Any]:
    anchor = {0.1: "right", 0.5: "center", 0.9: "left"}[quantile]
    text = "median" if quantile == 0.5 else f"P{100 * quantile:.0f}"
    font = {"size": 11, "color": INK if quantile == 0.5 else MUTED}
    return {
        **{"x": at, "y": 1.0 if quantile != 0.5 else 1.09, "yref": "paper", "yanchor": "bottom", "xanchor": anchor},
        **{"text": text, "showarrow": False, "font": font},
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
