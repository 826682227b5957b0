"""The three pictures of a long run: how it settles (Welch), its batch means, and how alike neighbours are."""

from __future__ import annotations

from typing import Any

import numpy as np

from opsim.report.long_run_words import NAMES
from opsim.report.palette import ACCENT, GRID, INK, MUTED
from opsim.report.small_chart import SmallChart, around, panels
from opsim.report.words import digits, scale_of

MOST_POINTS = 400
WARM = "#E69F00"
SETTLING_LEGEND = (
    (GRID, GRID, "average of the replications"),
    (ACCENT, ACCENT, "smoothed (Welch)"),
    (WARM, WARM, "left out"),
)
BATCH_LEGEND = ((ACCENT, ACCENT, "mean of a batch"), (ACCENT, "#cfe3f0", "95 % interval of the mean"))


def settling_svg(run: Any) -> str:
    """A chart a series that goes by time. run : a LongRun"""
    return panels(_settling(one, run) for one in run.series if one.curve.size)


def batches_svg(run: Any) -> str:
    """A chart a series that has batches."""
    return panels(_batches(one) for one in run.series if one.batches is not None)


def correlogram_svg(run: Any) -> str:
    """A chart a series that has batches."""
    return panels(_correlogram(one) for one in run.series if one.correlogram.size > 1)


def _settling(one: Any, run: Any) -> SmallChart:
    factor, unit = scale_of("s", run.horizon_s)
    values, word = _in_unit(one, one.curve)
    smooth, _ = _in_unit(one, one.smooth)
    at = (np.arange(values.size) + 0.5) * run.slice_s * factor
    y = _reached(smooth, values)
    chart = SmallChart(
        _title(one, word), (0.0, run.horizon_s * factor), y, f"time, {unit}", f"{NAMES[one.name]} over time, smoothed"
    )
    if run.left_out_s > 0:
        chart.box((0.0, run.left_out_s * factor), y, WARM, 0.25)
    chart.line(*_thinned(at, values), GRID, 1.0)
    chart.line(*_thinned(at[: smooth.size], smooth), ACCENT, 2.0)
    return chart


def _batches(one: Any) -> SmallChart:
    found = one.batches
    means, word = _in_unit(one, found.means.ravel())
    factor = _factor(one)
    known = np.isfinite(found.half_width)
    edges = [found.low * factor, found.high * factor] if known else [found.mean * factor]
    at = np.arange(1, means.size + 1)
    said = f"{NAMES[one.name]}: {means.size} batch means from {digits(means.min())} to {digits(means.max())} {word}"
    chart = SmallChart(_title(one, word), (0.0, means.size + 1.0), around([*means, *edges]), "batch", said)
    if known:
        chart.box((0.0, means.size + 1.0), (edges[0], edges[1]), ACCENT, 0.18)
    chart.level(found.mean * factor, ACCENT)
    chart.dots(at.tolist(), means.tolist(), ACCENT)
    return chart


def _correlogram(one: Any) -> SmallChart:
    lags = np.arange(one.correlogram.size)
    low = min(-0.25, float(one.correlogram.min()) - 0.05)
    said = f"{NAMES[one.name]}: correlation of neighbours {one.correlogram[1]:.2f}"
    chart = SmallChart(NAMES[one.name], (-0.8, lags.size - 0.2), (low, 1.0), "pieces apart", said)
    chart.bars(lags.tolist(), one.correlogram.tolist(), ACCENT)
    chart.level(0.0, INK)
    for edge in (-1, 1):
        chart.level(edge * 1.96 / np.sqrt(max(1, one.values)), MUTED, dashed=True)
    return chart


def _title(one: Any, word: str) -> str:
    return NAMES[one.name] if word in ("", "jobs", "people") else f"{NAMES[one.name]}, {word}"


def _factor(one: Any) -> float:
    return scale_of(one.unit, None if one.batches is None else one.batches.mean)[0]


def _in_unit(one: Any, values: np.ndarray) -> tuple[np.ndarray, str]:
    factor, word = scale_of(one.unit, None if one.batches is None else one.batches.mean)
    return values * factor, word


def _reached(smooth: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """What the smooth curve reaches, with room for most of the values: spikes of thin slices stand on the edge."""
    low, high = np.quantile(values, [0.01, 0.99])
    return around([0.0, float(low), float(high), *smooth.tolist()], with_zero=True)


def _thinned(x: np.ndarray, y: np.ndarray) -> tuple[list[float], list[float]]:
    """Means of neighbours where there are more points than a chart can show."""
    each = -(-x.size // MOST_POINTS)
    n = x.size // each * each
    first, second = (of[:n].reshape(-1, each).mean(axis=1).tolist() for of in (x, y))
    return first, second
