"""The picture of ``opsim motion people``: how much lies between people, and what their own draws are worth."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from opsim.report.paper.drawing import COLOURS, GRID, INK, MARKERS, figure, said, svg

ROOM = 0.75
"""Share of a quantity's row that its tasks take."""


def picture(found: Sequence[Any]) -> str:
    """SVG: ICC intervals by quantity and task; of each repetition the score of pooled draws against the own."""
    quantities = list(dict.fromkeys(icc.quantity for one in found for icc in one.iccs))
    tall = max(4.0, 0.35 + 0.09 * len(found) * len(quantities))
    drawn, (left, right) = figure(2, 1, 5.6, tall)
    _intervals(left, found, quantities)
    _pairs(right, found)
    handles, names = right.get_legend_handles_labels()
    legend = drawn.legend(handles, names, loc="outside lower center", ncols=5, fontsize=8, frameon=False)
    for text in legend.get_texts():
        text.set_parse_math(False)
    return svg(drawn)


def _intervals(axes: Any, found: Sequence[Any], quantities: Sequence[str]) -> None:
    for i, one in enumerate(found):
        at = (i + 0.5) / len(found) * ROOM - ROOM / 2
        for icc in one.iccs:
            y = quantities.index(icc.quantity) + at
            axes.plot([icc.low, icc.high], [y, y], color=_look(i)["color"], lw=1.6)
            axes.scatter([icc.icc], [y], s=20, lw=0, zorder=3, **_look(i))
    axes.set_yticks(range(len(quantities)), quantities)
    axes.set_ylim(len(quantities) - 0.5, -0.5)
    axes.axvline(0, color=INK, lw=1)
    axes.grid(visible=False, axis="y")
    for y in range(1, len(quantities), 2):
        axes.axhspan(y - 0.5, y + 0.5, color=GRID, alpha=0.5, lw=0, zorder=0)
    axes.set_xlim(right=1.02)
    said(axes, "what lies between people", "ICC(1,1) and its 95 % interval", "")


def _pairs(axes: Any, found: Sequence[Any]) -> None:
    for i, one in enumerate(found):
        axes.scatter(one.pooled.sum(axis=1), one.known.sum(axis=1), s=22, alpha=0.75, lw=0, label=one.task, **_look(i))
    ends = _ends(np.concatenate([one.pooled.sum(axis=1) + 0 * one.known.sum(axis=1) for one in found]))
    axes.plot(ends, ends, color=INK, lw=1)
    axes.set_aspect("equal", adjustable="datalim")
    title = "each repetition left out: below the line the own worker's draws are closer"
    said(axes, title, "energy score of pooled draws", "energy score of draws of the own worker")


def _ends(values: np.ndarray) -> tuple[float, float]:
    finite = values[np.isfinite(values)]
    return (float(min(finite.min(), 0)), float(finite.max())) if len(finite) else (0.0, 1.0)


def _look(i: int) -> dict[str, str]:
    """Colour and marker of the i-th task; no pair comes twice among the first 36."""
    return {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[(i + i // len(COLOURS)) % len(MARKERS)]}
