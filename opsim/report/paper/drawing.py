"""Axes and SVG for the figures: light, labelled, told apart without colour vision, the same bytes every time."""

from __future__ import annotations

import io
from typing import Any

INK, GRID = "#22262b", "#e3e6ea"
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
MARKERS = ("o", "s", "^", "D", "v", "P")
LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 2)))


def figure(columns: int = 1, rows: int = 1, wide: float = 4.6, tall: float = 3.2) -> tuple[Any, list[Any]]:
    """A figure and its axes, row by row."""
    from matplotlib.figure import Figure

    drawn = Figure(figsize=(wide * columns, tall * rows), facecolor="white", layout="constrained")
    axes = list(drawn.subplots(rows, columns, squeeze=False).ravel())
    for one in axes:
        one.grid(color=GRID, lw=0.8)
        one.set_axisbelow(True)
        one.spines[["top", "right"]].set_visible(False)
        one.tick_params(labelsize=8, colors=INK)
    return drawn, axes


def said(axes: Any, title: str, x: str, y: str) -> None:
    """Title and labels."""
    axes.set_title(title, size=9, color=INK, parse_math=False)
    axes.set_xlabel(x, size=8, color=INK)
    axes.set_ylabel(y, size=8, color=INK)


def style(i: int) -> dict[str, Any]:
    """Colour and dashes of the i-th line."""
    return {"color": COLOURS[i % len(COLOURS)], "ls": LINES[i % len(LINES)], "lw": 1.5}


def dots(i: int) -> dict[str, Any]:
    """Colour and shape of the i-th cloud."""
    return {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)], "s": 14, "alpha": 0.75, "lw": 0}


def legend(axes: Any) -> None:
    """Names of the lines, where they hide least."""
    axes.legend(fontsize=7, frameon=False)


def svg(drawn: Any) -> str:
    """The figure as the text of an SVG element."""
    import matplotlib

    stream = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "opsim", "svg.fonttype": "path"}):
        drawn.savefig(stream, format="svg", metadata={"Date": None, "Creator": "opsim"})
    text = stream.getvalue().decode()
    return text[text.index("<svg") :]
