"""A forest plot: a row each with its name and numbers above a dot and its interval, readable on a telephone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from opsim.report.figures import FONT, label, layout_of
from opsim.report.palette import ACCENT, INK, MUTED

ROW_PX, FOOT_PX = 44, 58
HERE = " (this report)"


@dataclass(frozen=True, slots=True)
class Dot:
    """One row in the axis' unit, None where it is not known. number : the same in words; base : what the others are
    held against; here : the variant that a report is of; clear : whether it is told apart from the base"""

    name: str
    number: str
    low: float | None
    mean: float | None
    high: float | None
    base: bool = False
    here: bool = False
    clear: bool = False


@dataclass(frozen=True, slots=True)
class Forest:
    """Rows from above; at : where the line across them stands, and what it is."""

    dots: Sequence[Dot]
    unit: str
    at: float | None
    what: str

    @property
    def said(self) -> str:
        """All rows as words."""
        rows = "; ".join(f"{dot.name}{HERE if dot.here else ''}: {dot.number}" for dot in self.dots)
        return f"{rows}. In {self.unit}; {self.what}." if self.unit else f"{rows}. {self.what}."


def forest_chart(forest: Forest) -> dict[str, Any]:
    """The figure: diamonds are bases, full dots clearly differ, open ones do not (or are not held against anything)."""
    layout = layout_of(FOOT_PX + ROW_PX * len(forest.dots)) | {"annotations": _names(forest.dots)}
    title = ", ".join(filter(None, (forest.unit, forest.what)))
    layout["xaxis"] |= {"title": {"text": title, "standoff": 6, "font": {**FONT, "size": 12}}, "nticks": 6}
    layout["xaxis"] |= {"zeroline": False, **_range(forest)}
    layout["yaxis"] |= {"range": [len(forest.dots) - 0.45, -0.75], "showticklabels": False, "showgrid": False}
    layout["margin"] |= {"t": 4, "b": 44, "l": 2, "r": 8}
    if forest.at is not None:
        layout["shapes"] = [_across(forest.at)]
    known = [(row, dot) for row, dot in enumerate(forest.dots) if dot.mean is not None]
    return {"data": [_dots(known, kind) for kind in _kinds(known)], "layout": layout}


def _range(forest: Forest) -> dict[str, Any]:
    """All intervals and the line, with a margin; one about a constant too."""
    ends = [end for dot in forest.dots for end in (dot.low, dot.mean, dot.high) if end is not None]
    ends += [] if forest.at is None else [forest.at]
    low, high = min(ends, default=0.0), max(ends, default=1.0)
    margin = 0.07 * (high - low) or 0.05 * abs(high) or 1.0
    return {"range": [low - margin, high + margin]}


Kind = tuple[bool, bool]
"""(base, clear)"""


def _kinds(known: Sequence[tuple[int, Dot]]) -> list[Kind]:
    return sorted({(dot.base, dot.clear) for _, dot in known})


def _dots(known: Sequence[tuple[int, Dot]], kind: Kind) -> dict[str, Any]:
    base, clear = kind
    of = [(row, dot) for row, dot in known if (dot.base, dot.clear) == kind]
    colour = INK if base else ACCENT if clear else MUTED
    symbol = "diamond" if base else "circle" if clear else "circle-open"
    error = {
        "type": "data",
        "symmetric": False,
        "array": [_apart(dot.mean, dot.high) for _, dot in of],
        "arrayminus": [_apart(dot.low, dot.mean) for _, dot in of],
        "color": colour,
        "thickness": 2.4,
        "width": 5,
    }
    return {
        "type": "scatter",
        "mode": "markers",
        "name": "base" if base else "clear" if clear else "not clear",
        "x": [dot.mean for _, dot in of],
        "y": [row for row, _ in of],
        "error_x": error,
        "marker": {"size": 11 if base else 10, "color": colour, "symbol": symbol, "line": {"width": 2}},
        "customdata": [f"{label(dot.name)}: {escape(dot.number, quote=False)}" for _, dot in of],
        "hovertemplate": "%{customdata}<extra></extra>",
    }


def _apart(low: float | None, high: float | None) -> float:
    """Nothing where one of them is not known."""
    return 0.0 if low is None or high is None else high - low


def _names(dots: Sequence[Dot]) -> list[dict[str, Any]]:
    """Above each row, from the left edge: nothing is lost beside the chart on a narrow screen."""
    place = {"xref": "paper", "x": 0, "xanchor": "left", "yanchor": "bottom", "showarrow": False}
    return [
        {
            **place,
            "y": row - 0.2,
            "text": f"<b>{label(dot.name)}</b>{HERE if dot.here else ''}  {escape(dot.number, quote=False)}",
            "font": {**FONT, "size": 12},
            "bgcolor": "rgba(255,255,255,0.85)",
            "borderpad": 0,
        }
        for row, dot in enumerate(dots)
    ]


def _across(at: float) -> dict[str, Any]:
    line = {"color": INK, "width": 1.2, "dash": "dot"}
    return {"type": "line", "x0": at, "x1": at, "y0": 0, "y1": 1, "yref": "paper", "line": line, "layer": "below"}
