"""The few strokes of matplotlib's that our pictures of people are made of, written as SVG: for pages, without it.

What draws on matplotlib's axes (lines, filled outlines, dots, words) draws on these as it is. Lengths are points.

Outlines of round shapes as the ``d`` of an SVG path, all the same way round: several make one filled area.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from html import escape
from itertools import groupby
from typing import Any

import numpy as np

from opsim.report.plot.body import outer_tangents

FONT = "system-ui,-apple-system,'Segoe UI',Roboto,'DejaVu Sans',sans-serif"
POINTS = 72.0
"""Of an inch."""
ANCHORS = {"left": "start", "center": "middle", "right": "end"}
DOWN = {"top": 0.78, "center": 0.35, "baseline": 0.0, "bottom": -0.22}
"""From where a word is placed to its base line, in sizes of its letters."""


@dataclass(eq=False)
class SvgFigure:
    """A sheet of white paper: ``figsize`` in inches, as matplotlib's."""

    figsize: tuple[float, float]
    axes: list[SvgAxes] = field(default_factory=list)

    def get_figheight(self) -> float:
        return self.figsize[1]

    def add_axes(self, place: Sequence[float]) -> SvgAxes:
        """place : left, bottom, width, height as shares of the sheet"""
        left, bottom, wide, high = place
        width, height = self._size
        self.axes.append(SvgAxes((left * width, (1 - bottom - high) * height, wide * width, high * height)))
        return self.axes[-1]

    def text(self, x: float, y: float, words: str, **look: Any) -> None:
        """Words on the sheet; x, y : shares of it"""
        axes = self.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.text(x, y, words, **look)

    @property
    def _size(self) -> tuple[float, float]:
        return POINTS * self.figsize[0], POINTS * self.figsize[1]

    def svg(self) -> bytes:
        """The same bytes for the same strokes."""
        width, height = self._size
        size = f'viewBox="0 0 {width:.1f} {height:.1f}" width="{width:.1f}pt" height="{height:.1f}pt"'
        style = f'font-family="{FONT}" fill="none" stroke-linecap="round" stroke-linejoin="round"'
        strokes = "\n".join(line for axes in self.axes for line in axes.lines())
        paper = f'<rect width="{width:.1f}" height="{height:.1f}" fill="#fff"/>'
        return f'<svg xmlns="http://www.w3.org/2000/svg" {size} {style}>\n{paper}\n{strokes}\n</svg>\n'.encode()


@dataclass(eq=False)
class SvgAxes:
    """A field of the sheet with coordinates of its own. box : left, top, width, height in points"""

    box: tuple[float, float, float, float]
    _x: tuple[float, float] = (0.0, 1.0)
    _y: tuple[float, float] = (0.0, 1.0)
    _strokes: list[tuple[float, str, str]] = field(default_factory=list)
    """(height in the pile, look, what)"""

    def set(self, *, xlim: tuple[float, float], ylim: tuple[float, float], aspect: str = "auto") -> None:
        """The coordinates of the edges; who calls has chosen a field of their proportion."""
        self._x, self._y = xlim, ylim

    def axis(self, _: str) -> None:
        """No axis is ever drawn."""

    def get_xlim(self) -> tuple[float, float]:
        return self._x

    def get_ylim(self) -> tuple[float, float]:
        return self._y

    def plot(self, x: Any, y: Any, *, color: str, zorder: float = 2.0, marker: str = "", **look: Any) -> None:
        """A line, or one a column; with a marker a triangle at each point. A point that is nan breaks the line."""
        if marker:
            self._triangles(x, y, color, look.get("ms", 6.0), zorder)
            return
        opacity = f' stroke-opacity="{look["alpha"]:g}"' if "alpha" in look else ""
        style = f'stroke="{color}" stroke-width="{look.get("lw", 1.5):g}"{opacity}'
        for line in _columns(np.asarray(x, float), np.asarray(y, float)):
            if path := self._path(line):
                self._strokes.append((zorder, style, f'<path d="{path}"/>'))

    def fill(self, x: Any, y: Any, *, facecolor: str, edgecolor: str, lw: float, zorder: float = 1.0, **_: Any) -> None:
        """The area within an outline."""
        style = f'fill="{facecolor}" stroke="{edgecolor}" stroke-width="{lw:g}"'
        path = self._path(np.column_stack([x, y]))
        self._strokes.append((zorder, style, f'<path d="{path}z"/>'))

    def scatter(self, x: Any, y: Any, *, s: float, alpha: float = 1.0, zorder: float = 1.0, **look: Any) -> None:
        """Dots of ``s`` square points."""
        inside, rim = look.get("facecolor", look.get("color", "none")), look.get("edgecolor", "none")
        style = f'fill="{inside}" stroke="{rim}" stroke-width="{look.get("lw", 1.0):g}" opacity="{alpha:g}"'
        radius = np.sqrt(s) / 2
        for px, py in self._points(np.column_stack([x, y])):
            self._strokes.append((zorder, style, f'<circle cx="{px:.1f}" cy="{py:.1f}" r="{radius:.1f}"/>'))

    def text(self, x: float, y: float, words: str, *, size: float = 10.0, color: str = "#000", **look: Any) -> None:
        """Words, never read as anything else; a ``bbox`` is a white rim about the letters."""
        ((px, py),) = self._points(np.array([[x, y]], float))
        rim = ' stroke="#fff" stroke-width="3" paint-order="stroke"' if "bbox" in look else ""
        bold = ' font-weight="bold"' if look.get("weight") == "bold" else ""
        anchor = ANCHORS[look.get("ha", "left")]
        base = py + DOWN[look.get("va", "baseline")] * size
        place = f'x="{px:.1f}" y="{base:.1f}" text-anchor="{anchor}" font-size="{size:g}"'
        said = f'<text {place} fill="{color}"{bold}{rim}>{escape(words, quote=False)}</text>'
        self._strokes.append((look.get("zorder", 3.0), "", said))

    def lines(self) -> Iterator[str]:
        """Lowest first; neighbours of one look together."""
        pile = sorted(self._strokes, key=lambda stroke: stroke[0])
        for look, strokes in groupby(pile, key=lambda stroke: stroke[1]):
            within = "".join(what for *_, what in strokes)
            yield f"<g {look}>{within}</g>" if look else within

    def _points(self, at: np.ndarray) -> np.ndarray:
        """(n, 2) in this field's coordinates -> on the sheet, y down."""
        left, top, wide, high = self.box
        x = left + wide * (at[:, 0] - self._x[0]) / (self._x[1] - self._x[0])
        y = top + high * (self._y[1] - at[:, 1]) / (self._y[1] - self._y[0])
        return np.column_stack([x, y])

    def _path(self, at: np.ndarray) -> str:
        known = np.isfinite(at).all(axis=1)
        runs = [
            [point for _, point in of]
            for is_known, of in groupby(zip(known, self._points(at)), lambda p: p[0])
            if is_known
        ]
        return "".join("M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in run) for run in runs)

    def _triangles(self, x: Any, y: Any, colour: str, size: float, zorder: float) -> None:
        half = size / 2
        for px, py in self._points(np.column_stack([x, y])):
            path = f"M{px:.1f} {py - half:.1f}L{px + half:.1f} {py + half:.1f}H{px - half:.1f}z"
            self._strokes.append((zorder, f'fill="{colour}"', f'<path d="{path}"/>'))


def _columns(x: np.ndarray, y: np.ndarray) -> Iterator[np.ndarray]:
    """The lines, (n, 2) each, of coordinates (n,) or (n, lines)."""
    if x.ndim == 1:
        yield np.column_stack([x, y])
    else:
        yield from (np.column_stack([x[:, i], y[:, i]]) for i in range(x.shape[1]))


def figure_of(ending: str, figsize: tuple[float, float]) -> Any:
    """A sheet to draw on: for svg one of ours, for png matplotlib's. Raises ValueError where that is not there."""
    if ending == "svg":
        return SvgFigure(figsize)
    from opsim.report.page import need_matplotlib

    need_matplotlib("pictures as PNG files")
    from matplotlib.figure import Figure

    return Figure(figsize=figsize, facecolor="white")


def path_of(kind: str, what: Any) -> str:
    """Of a shape of ``body_parts``: taper, disc or inside."""
    if kind == "inside":
        return polygon(what)
    if kind == "disc":
        return disc(*what)
    return taper(*what)


def taper(a: np.ndarray, b: np.ndarray, a_px: float, b_px: float) -> str:
    """Two discs and what lies between their outer tangents."""
    corners = outer_tangents(a, b, a_px, b_px)
    if not len(corners):
        return disc(a, a_px) if a_px >= b_px else disc(b, b_px)
    on_a, on_b, from_b, back = map(_point, corners)
    round_b, round_a = (
        f"A{r:.1f} {r:.1f} 0 {int(large)} 0 " for r, large in ((b_px, b_px > a_px), (a_px, a_px > b_px))
    )
    return f"M{on_a}L{on_b}{round_b}{from_b}L{back}{round_a}{on_a}Z"


def disc(middle: np.ndarray, radius_px: float) -> str:
    """A whole circle, as two arcs."""
    left, right = (_point(np.array([middle[0] + way * radius_px, middle[1]])) for way in (-1, 1))
    half = f"A{radius_px:.1f} {radius_px:.1f} 0 0 0 "
    return f"M{right}{half}{left}{half}{right}Z"


def polygon(corners: np.ndarray) -> str:
    """Corners (n, 2), turned round where they run the other way."""
    x, y = corners[:, 0], corners[:, 1]
    clockwise = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) > 0  # as seen, since y points down
    return f"M{'L'.join(map(_point, corners[::-1] if clockwise else corners))}Z"


def _point(at: np.ndarray) -> str:
    return f"{at[0]:.1f} {at[1]:.1f}"
