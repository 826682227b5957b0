"""Bars that lie in rows, each from one value to another, told apart by colour, by pattern and by the words in them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from opsim.report.figures import label

THICK = 0.74
"""Of a row."""
PALE = "#ffffff"
CLOCK = "<br>until %{x|%a %H:%M:%S}"
PATTERN = {".": {"size": 7, "solidity": 0.2}}


@dataclass(frozen=True, slots=True)
class Look:
    """words : for a legend, any text; ink : of the words within; pattern : of plotly's, "" for none."""

    words: str
    colour: str
    ink: str = "#ffffff"
    pattern: str = ""

    @property
    def swatch(self) -> tuple[str, str]:
        """(CSS background, words) of a legend."""
        return SWATCHES.get(self.pattern, "{0}").format(self.colour), self.words


SWATCHES = {
    "/": "repeating-linear-gradient(135deg, {0} 0 3px, #ffffff 3px 5px)",
    "\\": "repeating-linear-gradient(45deg, {0} 0 3px, #ffffff 3px 5px)",
    "x": "repeating-linear-gradient(45deg, {0} 0 3px, transparent 3px 5px), "
    "repeating-linear-gradient(135deg, {0} 0 3px, #ffffff 3px 5px)",
    ".": "radial-gradient(#ffffff 28%, {0} 36%) 0 0 / 5px 5px",
}


@dataclass(frozen=True, slots=True)
class Bar:
    """row : its middle, rows are 1 apart; start, length : in the axis' unit; text : within, where there is room;
    said : what pointing at it tells, behind the words of its look. Text and said may be anything: escaped here."""

    look: Look
    row: float
    start: float
    length: float
    text: str = ""
    said: str = ""
    thick: float = THICK


def bar_traces(bars: Iterable[Bar], *, clock: bool = False) -> list[dict[str, Any]]:
    """One trace a look and thickness: as few as can be, since each costs a page more than many bars.

    clock : whether the axis is a clock, and pointing at a bar tells when it ends
    """
    groups: dict[tuple[Look, float], list[Bar]] = {}
    for bar in bars:
        groups.setdefault((bar.look, bar.thick), []).append(bar)
    return [_trace(look, thick, of, CLOCK if clock else "") for (look, thick), of in groups.items()]


def in_hover(name: str) -> str:
    """A name within a template of what pointing tells: no markup, and nothing that plotly would fill in."""
    return label(name).replace("%{", "%&#123;")


def fitting() -> dict[str, Any]:
    """What a layout gets so that words stand in a bar only where they fit, and never smaller than can be read."""
    return {"barmode": "overlay", "uniformtext": {"minsize": 11, "mode": "hide"}}


def _trace(look: Look, thick: float, bars: Sequence[Bar], more: str) -> dict[str, Any]:
    pattern = {
        "shape": look.pattern,
        "fillmode": "overlay",
        "fgcolor": PALE,
        **PATTERN.get(look.pattern, {"size": 6, "solidity": 0.35}),
    }
    trace = {
        "type": "bar",
        "orientation": "h",
        "name": escape(look.words, quote=False),
        "base": [_short(bar.start) for bar in bars],
        "x": [_short(bar.length) for bar in bars],
        "y": [_short(bar.row) for bar in bars],
        "width": thick,
        "marker": {
            "color": look.colour,
            "line": {"color": PALE, "width": 0.5},
            **({"pattern": pattern} if look.pattern else {}),
        },
        "customdata": [escape(bar.said, quote=False) for bar in bars],
        "hovertemplate": f"{in_hover(look.words)}<br>%{{customdata}}{more}<extra></extra>",
    }
    if any(bar.text for bar in bars):
        trace |= {
            "text": [escape(bar.text, quote=False) for bar in bars],
            "textposition": "inside",
            "insidetextanchor": "middle",
            "textangle": 0,
            "insidetextfont": {"color": look.ink, "size": 12},
        }
    return trace


def _short(value: float) -> float:
    """As few digits as a screen can show."""
    value = round(float(value), 4)
    return int(value) if value == int(value) else value
