"""The series behind a suggested warm-up, as PNG or SVG."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from opsim.report.palette import ACCENT, GRID, INK, MUTED
from opsim.report.words import kpi_name, quantity, scale_of
from opsim.whole import whole_file


def draw_warm_up(found: Sequence[Any], path: str | Path, title: str) -> Path:
    """One panel a series (each a WarmUp): slices, their batches of five, and what is left out in grey."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    path = Path(path)
    style: Any = {"svg.fonttype": "none", "svg.hashsalt": "opsim", "text.parse_math": False}
    with rc_context(style), whole_file(path) as temporary:
        figure = Figure(figsize=(9.0, 0.6 + 2.4 * len(found)), layout="constrained")
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, color=INK)
        for axes, warm_up in zip(figure.subplots(len(found), 1, squeeze=False)[:, 0], found):
            _panel(axes, warm_up)
        kind = path.suffix.removeprefix(".").lower()
        figure.savefig(temporary, format=kind, dpi=150, metadata={"Date": None} if kind == "svg" else None)
    return path


def _panel(axes: Any, warm_up: Any) -> None:
    n = warm_up.series.size
    factor, unit = scale_of("s", n * warm_up.slice_s)
    at = (np.arange(n) + 0.5) * warm_up.slice_s * factor
    batches = warm_up.series[: n // 5 * 5].reshape(-1, 5).mean(axis=1)
    axes.plot(at, warm_up.series, color=GRID, linewidth=0.8)
    axes.plot(at[2::5][: batches.size], batches, color=ACCENT, linewidth=1.3)
    words = "no warm-up found: the run is too short to tell"
    if warm_up.until_s is not None:
        axes.axvspan(0, warm_up.until_s * factor, color=MUTED, alpha=0.18, linewidth=0)
        words = (
            f"warm-up {quantity(warm_up.until_s, 's', 5 * warm_up.slice_s)}" if warm_up.until_s else "no warm-up needed"
        )
    axes.set_title(f"{kpi_name(warm_up.name)}: {words}", loc="left", fontsize=10, color=INK)
    axes.set_xlabel(f"time since the start, {unit}", fontsize=9, color=MUTED)
    axes.set_ylabel(scale_of(warm_up.unit, None)[1], fontsize=9, color=MUTED)
    axes.set_xlim(0, n * warm_up.slice_s * factor)
    axes.tick_params(labelsize=8)
    axes.spines[["top", "right"]].set_visible(False)
