"""Axes of a plotly layout as matplotlib's: where they are, their ranges, their ticks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

import numpy as np

from opsim.report.drawn.looks import POINT, colour, words

DAY_MS = 86_400_000.0
LINEAR, LOG, DATE, CATEGORY = "linear", "log", "date", "category"
Axis = Mapping[str, Any]


class Scale:
    """How values of one axis become numbers of matplotlib's: times as days, names as their places."""

    def __init__(self, axis: Axis, values: Sequence[Any]) -> None:
        named = any(isinstance(value, str) for value in values)
        self.kind = axis.get("type") or (CATEGORY if named else LINEAR)
        given = axis.get("categoryarray") or []
        self.names = list(dict.fromkeys([*given, *(str(v) for v in values if v is not None)]))
        self.place = {name: place for place, name in enumerate(self.names)}

    def __call__(self, values: Sequence[Any] | np.ndarray) -> np.ndarray:
        return np.array([self.number(value) for value in values], float)

    def number(self, value: Any) -> float:
        """nan for nothing."""
        if value is None:
            return float("nan")
        if self.kind == DATE:
            return _days(value)
        return float(self.place[str(value)]) if self.kind == CATEGORY and str(value) in self.place else float(value)

    def lengths(self, values: Sequence[Any]) -> np.ndarray:
        """Of bars that begin elsewhere than at 0: plotly says those of times in milliseconds."""
        found = np.array([np.nan if value is None else value for value in values], float)
        return found / DAY_MS if self.kind == DATE else found

    def edge(self, value: Any) -> float:
        """An end of a range: of a logarithmic axis plotly says its power of ten."""
        return float(10.0**value) if self.kind == LOG else self.number(value)


def _days(value: Any) -> float:
    """Since 1970, of milliseconds or of a text."""
    if not isinstance(value, str):
        return float(value) / DAY_MS
    return datetime.fromisoformat(value.replace("Z", "")).replace(tzinfo=UTC).timestamp() / 86400.0


def set_axis(axes: Any, which: str, said: Axis, scale: Scale) -> None:
    """which : x or y"""
    axis = axes.xaxis if which == "x" else axes.yaxis
    if scale.kind == LOG:
        (axes.set_xscale if which == "x" else axes.set_yscale)("log")
    _limits(axes, which, said, scale)
    _ticks(axis, said, scale)
    small = (said.get("tickfont") or {}).get("size", 12) * POINT
    shown = said.get("showticklabels", True) and said.get("visible", True)
    far = said.get("side") in ("right", "top")
    near, other = {"x": ("bottom", "top"), "y": ("left", "right")}[which]
    sides = {near: shown and not far, other: shown and far}
    axes.tick_params(
        axis=which, length=0, labelsize=small, **sides, **{f"label{side}": on for side, on in sides.items()}
    )
    if said.get("showgrid", True) and said.get("visible", True):
        axis.grid(True, color=colour(said.get("gridcolor", "#e3e6ea")), linewidth=0.8)
    title = said.get("title") or {}
    text = title if isinstance(title, str) else title.get("text", "")
    if text:
        if far:
            axis.set_label_position("right" if which == "y" else "top")
        axis.set_label_text(words(text), fontsize=12 * POINT, parse_math=False)


def _limits(axes: Any, which: str, said: Axis, scale: Scale) -> None:
    set_range = axes.set_xlim if which == "x" else axes.set_ylim
    low, high = axes.get_xlim() if which == "x" else axes.get_ylim()
    if said.get("range"):
        given = [None if end is None else scale.edge(end) for end in said["range"]]
        set_range(*(own if end is None else end for end, own in zip(given, (low, high))))
    elif scale.kind == CATEGORY:
        ends = (-0.5, len(scale.names) - 0.5)
        set_range(*(ends[::-1] if said.get("autorange") == "reversed" else ends))
    else:
        low = min(low, 0.0) if said.get("rangemode") == "tozero" else low
        set_range(*((high, low) if said.get("autorange") == "reversed" else (low, high)))


def _ticks(axis: Any, said: Axis, scale: Scale) -> None:
    from matplotlib import ticker

    if said.get("tickvals") is not None:
        shown = said.get("ticktext")
        named = [words(text) for text in shown] if shown is not None else None
        axis.set_major_locator(ticker.FixedLocator(scale(said["tickvals"]).tolist()))
        if named is not None:
            axis.set_major_formatter(ticker.FixedFormatter(named))
            _plain(axis)
            return
    elif scale.kind == CATEGORY:
        axis.set_major_locator(ticker.FixedLocator(range(len(scale.names))))
        axis.set_major_formatter(ticker.FixedFormatter([words(name) for name in scale.names]))
        _plain(axis)
        return
    elif scale.kind == DATE:
        _clock(axis, said)
        return
    elif said.get("dtick") is not None and scale.kind == LINEAR:
        axis.set_major_locator(ticker.MultipleLocator(said["dtick"]))
    elif scale.kind == LINEAR:
        axis.set_major_locator(ticker.MaxNLocator(max(2, said.get("nticks") or 7), steps=[1, 2, 2.5, 5, 10]))
    if scale.kind != DATE:
        axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: _number(value, said)))


def _plain(axis: Any) -> None:
    """Names are no formulas."""
    for label in axis.get_ticklabels():
        label.set_parse_math(False)


def _clock(axis: Any, said: Axis) -> None:
    from matplotlib import dates

    axis.set_major_locator(dates.AutoDateLocator(tz="UTC", maxticks=9))
    axis.set_major_formatter(dates.DateFormatter(words(said.get("tickformat") or "%H:%M\n%a"), tz="UTC"))


def _number(value: float, said: Axis) -> str:
    form = said.get("tickformat") or ""
    text = f"{round(value)}" if form == "d" else f"{value:{form}}" if form else f"{value:g}"
    return f"{said.get('tickprefix', '')}{text}{said.get('ticksuffix', '')}"
