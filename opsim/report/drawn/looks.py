"""Colours, dashes, marks and words of plotly's language in matplotlib's."""

from __future__ import annotations

import re
from html import unescape
from typing import Any

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
