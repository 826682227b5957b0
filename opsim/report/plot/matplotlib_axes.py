"""Colours, dashes, marks and words of plotly's language in matplotlib's.

Axes of a plotly layout as matplotlib's: where they are, their ranges, their ticks.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from html import unescape
from typing import Any

import numpy as np

Colour = tuple[float, float, float, float]
DASHES = {
    "solid": "-",
    "dash": (0, (6, 4)),
    "dot": (0, (1.5, 2.5)),
    "dashdot": (0, (6, 3, 1.5, 3)),
    "longdash": (0, (10, 4)),
}
SYMBOLS = {
    "circle": "o",
    "square": "s",
    "diamond": "D",
    "x": "X",
    "cross": "P",
    "triangle-up": "^",
    "triangle-down": "v",
    "triangle-left": "<",
    "triangle-right": ">",
    "line-ns": "|",
    "line-ew": "_",
}
HATCHES = {"": "", "/": "///", "\\": "\\\\\\", "x": "xxx", "-": "---", "|": "|||", "+": "+++", ".": "..."}
STEPS = {"linear": "default", "hv": "steps-post", "vh": "steps-pre", "hvh": "steps-mid"}
WHITES, DARK = ("#fff", "#ffffff"), "#22262b"
POINT = 0.75
"""Points to a pixel."""


def colour(said: str | None, opacity: float = 1.0) -> Colour | None:
    """RGBA of ``#rgb``, ``rgb()``, ``rgba()``, or of the first colour of a CSS background that is not white."""
    from matplotlib.colors import to_rgba

    if said is None:
        return None
    several = list(re.finditer(r"rgba?\(([^)]*)\)|#[0-9a-fA-F]{3,8}", said))
    if not several:
        return to_rgba(said, opacity)
    found = next((one for one in several if one[0].lower() not in WHITES), several[0])
    if found[1] is None:
        r, g, b, a = to_rgba(found[0])
        return r, g, b, a * opacity
    parts = [float(part) for part in found[1].split(",")]
    r, g, b = (part / 255 for part in parts[:3])
    return r, g, b, (parts[3] if len(parts) > 3 else 1.0) * opacity


def hatched(said: str) -> str:
    """The pattern that a CSS background shows, "" for a plain colour."""
    return "" if "gradient" not in said else "." if "radial" in said else "/"


def ink_on(fill: Colour | None) -> str:
    """Of words on a colour, light or dark, whichever is read more easily."""
    if fill is None or fill[3] < 0.5:
        return DARK
    return DARK if 0.299 * fill[0] + 0.587 * fill[1] + 0.114 * fill[2] > 0.5 else "#ffffff"


def dash(said: str | None) -> Any:
    """A line style, of a name or of lengths such as ``4px,3px``."""
    if said is None or said in DASHES:
        return DASHES[said or "solid"]
    return 0, tuple(float(part.strip().removesuffix("px")) for part in said.split(","))


def symbol(said: str) -> tuple[str, bool]:
    """(matplotlib's mark, whether it is filled)."""
    return SYMBOLS[said.removesuffix("-open")], not said.endswith("-open")


def words(said: Any) -> str:
    """A text without marks, its lines apart; entities are the letters they stand for."""
    lines = re.sub(r"<br\s*/?>", "\n", str(said))
    return unescape(re.sub(r"</?(?:b|i|sub|sup|span)(?:\s[^>]*)?>", "", lines))


def each(said: Any, n: int) -> list[Any]:
    """One a point, of a list or of what holds for all."""
    return list(said) if isinstance(said, list | tuple) else [said] * n


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
