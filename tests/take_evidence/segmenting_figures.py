"""Figures 1 to 3 of the paper on spatio-temporal LTSA on other walks, and what else is to be looked at."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from emulator.segmenting.cycles import denoised, fitted_curve
from emulator.segmenting.ltsa import stltsa
from emulator.segmenting.segment import Segments
from emulator.skeleton import Skeleton
from opsim.report.motion.segmentation import UNITS, spread
from opsim.report.plot.body import draw_person, view_axes
from opsim.report.plot.plotly import ACCENT, GRID, INK, MUTED

RED = "#D55E00"
ROWS = {"height_ratios": [1.1, 1.2, 1.1], "hspace": 0.2, "left": 0.05, "right": 0.99, "bottom": 0.01, "top": 0.94}


def _figure(wide: float, tall: float) -> Any:
    from matplotlib.figure import Figure

    return Figure(figsize=(wide, tall), facecolor="white")


def _plain(axes: Any, title: str, x: str = "", y: str = "") -> None:
    axes.set_title(title, loc="left", size=10, color=INK)
    axes.set_xlabel(x, size=9, color=MUTED)
    axes.set_ylabel(y, size=9, color=MUTED)
    axes.tick_params(labelsize=8, colors=MUTED)
    axes.spines[["top", "right"]].set_visible(False)


def period_of(found: Segments) -> float:
    return float(np.median([cut.stop - cut.start for cut in found.cuts]))


def draw_manifold(found: Segments, path: Path) -> None:
    """Figure 1: the two-dimensional manifold with frame numbers; beside it, simplified as a circle and two curves."""
    figure = _figure(13, 6)
    one, other = figure.subplots(1, 2)
    assert found.curve is not None
    y = stltsa(found.curve.embedding.points, found.curve.embedding.k, 2).coordinates
    one.plot(*y.T, color=GRID, lw=0.8, zorder=1)
    one.plot(*y.T, "*", color=RED, ms=5, zorder=2)
    for frame in range(0, len(y), 6):
        one.annotate(str(frame + 1), y[frame], (3, 3), textcoords="offset points", size=7, color=INK)
    _plain(one, f"(a) {found.take.name}: frames in the order of time", "first coordinate", "second coordinate")
    first, last = found.cuts[0].start, found.cuts[-1].stop
    share = np.linspace(0, 1, 60)
    rounds = [
        np.stack([np.interp(cut.start + share * (cut.stop - cut.start), np.arange(len(y)), column) for column in y.T])
        for cut in found.cuts
    ]
    mean = np.mean(rounds, axis=0)
    for each in rounds:
        other.plot(*each, color=GRID, lw=0.8)
    other.plot(*np.hstack([mean, mean[:, :1]]), color=ACCENT, lw=3, label=f"mean of {len(rounds)} cycles")
    other.plot(*y[: first + 1].T, color="#009E73", lw=2, label=f"frames 1 to {first + 1}: preparing, initial")
    other.plot(*y[last:].T, color="#CC79A7", lw=2, label=f"frames {last + 1} to {len(y)}: final, wind-up")
    other.legend(fontsize=8, frameon=False)
    _plain(other, "(b) simplified: a closed curve and two ends", "first coordinate", "second coordinate")
    figure.savefig(path, bbox_inches="tight")


def draw_denoising(found: Segments, path: Path) -> None:
    """Figure 2: points of the one-dimensional manifold and the fitted curve, before and after they are pulled back."""
    assert found.curve is not None
    rng, y = np.random.default_rng(0), found.curve.y
    noisy = y + 0.06 * np.ptp(y) * rng.standard_normal(len(y)) * (rng.random(len(y)) < 0.3)
    fitted = fitted_curve(noisy, period_of(found))
    pulled, which = denoised(noisy, fitted)
    figure = _figure(13, 5.2)
    at = np.arange(len(y)) / found.take.rate_hz
    for axes, values, said in zip(
        figure.subplots(2, 1, sharex=True), (noisy, pulled), ("before", "after"), strict=True
    ):
        axes.plot(at, fitted, color=ACCENT, lw=1.2, label="fitted curve")
        axes.plot(at, values, "*", color=RED, ms=4, lw=0, label="frames")
        axes.legend(fontsize=8, frameon=False, loc="upper right", ncols=2)
        off = np.sqrt(np.mean((values - fitted) ** 2)) / np.ptp(y)
        _plain(axes, f"{found.take.name}, {said}: {off:.2%} of the span from the curve", "", "coordinate")
    axes.set_xlabel(f"time, s (noise added to 3 of 10 frames; {which.sum()} of {len(y)} moved)", size=9, color=MUTED)
    figure.savefig(path, bbox_inches="tight")


def draw_units(found: Sequence[Segments], path: Path) -> None:
    """Figure 3: the coordinate over time with units shaded; postures at its peaks above, at its valleys below."""
    figure = _figure(14, 5.4 * len(found))
    for part, one in zip(figure.subfigures(len(found), 1, squeeze=False)[:, 0], found, strict=True):
        above, curve, below = part.subplots(3, 1, gridspec_kw=ROWS)
        assert one.cycles is not None
        at = np.arange(one.take.n_frames)
        curve.set_xlim(0, at[-1])
        for unit in one.units:
            curve.axvspan(unit.start, unit.stop, color=UNITS[unit.name], lw=0)
            if unit.n_frames > 0.04 * len(at):
                middle, said = (unit.start + unit.stop) / 2, f"{unit.name}, {unit.n_frames} frames"
                words = {"transform": curve.get_xaxis_transform(), "ha": "center", "va": "top"}
                curve.text(middle, 0.97, said, size=8, color=INK, **words)
        for cut in one.cuts:
            curve.axvline(cut.start, color=MUTED, lw=0.8)
        curve.axvline(one.cuts[-1].stop, color=MUTED, lw=0.8)
        curve.plot(at, one.cycles.smooth, color=ACCENT, lw=1.6)
        _draw_contact(curve, np.asarray(one.take.contact), one.cycles.smooth)
        frames, smooth = one.cycles.extremes, one.cycles.smooth
        curve.plot(frames, smooth[frames], "o", color=RED, ms=4)
        curve.set_ylim(smooth.min() - 0.22 * np.ptp(smooth), smooth.max() + 0.28 * np.ptp(smooth))
        _plain(curve, "", "", "coordinate (over frames)")
        peaks = smooth[frames] > np.median(smooth)
        _draw_row(above, one, frames[peaks])
        _draw_row(below, one, frames[~peaks])
        dimension = one.curve.dimension if one.curve else 0
        said = (
            f"{one.take.name}: {len(one.cuts)} cycle{'s' if len(one.cuts) > 1 else ''}, intrinsic dimension {dimension}"
        )
        above.set_title(said + "; bars below the curve: left and right foot bear", loc="left", size=11, color=INK)
    figure.savefig(path, bbox_inches="tight")


def _draw_contact(axes: Any, contact: np.ndarray, smooth: np.ndarray) -> None:
    for foot, colour in ((0, "#0072B2"), (1, "#D55E00")):
        level = smooth.min() - (0.09 + 0.06 * foot) * np.ptp(smooth)
        axes.plot(np.where(contact[:, foot], level, np.nan), color=colour, lw=4, solid_capstyle="butt")


def _draw_row(axes: Any, found: Segments, frames: np.ndarray) -> None:
    skeleton = Skeleton(found.take.names, found.take.parents or ())
    positions, root = found.take.positions_m, skeleton.root
    right, viewer = view_axes(positions, skeleton)
    floor = float(np.quantile(positions[..., 2].min(axis=1), 0.1))
    tall = float(np.quantile(positions[..., 2].max(axis=1), 0.98)) - floor + 0.5
    box = axes.get_window_extent()
    wide = tall * box.width / box.height
    axes.set(xlim=(0, wide), ylim=(-0.25, tall - 0.25), aspect="equal")
    axes.axis("off")
    if not len(frames):
        return
    apart = min(0.8, (wide - 1) / max(len(frames) - 1, 1))
    for place, frame in zip(0.5 + spread(frames / len(positions) * wide - 0.5, wide - 1, apart), frames, strict=True):
        around = positions[frame] - np.append(positions[frame, root, :2], floor)
        flat = np.stack([around[:, :2] @ right, around[:, 2]], axis=1)
        draw_person(axes, flat, around[:, :2] @ viewer, place, skeleton)
        axes.text(place, -0.2, str(frame + 1), size=7, ha="center", color=MUTED)


def draw_offsets(figures: Sequence[Any], path: Path) -> None:
    """How far all boundaries are from foot strikes, the constant of each take taken off."""
    off = np.concatenate([one.off_frames for one in figures])
    figure = _figure(9, 3)
    axes = figure.subplots()
    axes.hist(np.minimum(off, 10), np.arange(0, 10.5, 0.5), color=ACCENT)
    axes.axvline(3, color=RED)
    _plain(
        axes, f"{len(off)} boundaries of {len(figures)} takes", "frames from the foot strike (10: more)", "boundaries"
    )
    figure.savefig(path, bbox_inches="tight")


def draw_long(views: Sequence[tuple[str, Segments, np.ndarray]], path: Path) -> None:
    """Long takes: distance from the posture of rest, what was found shaded, the truth as bars below."""
    figure = _figure(14, 2.6 * len(views))
    for axes, (name, found, truth) in zip(figure.subplots(len(views), 1, squeeze=False)[:, 0], views, strict=True):
        assert found.repetitions is not None
        rate_hz, away = found.take.rate_hz, found.repetitions.away
        for cut in found.cuts:
            axes.axvspan(cut.start / rate_hz, cut.stop / rate_hz, color=UNITS["cyclic"], lw=0)
        for start, stop in truth / rate_hz:
            axes.plot([start, stop], [-0.25, -0.25], color=RED, lw=4, solid_capstyle="butt")
        axes.plot(np.arange(len(away)) / rate_hz, away, color=ACCENT, lw=1.2)
        axes.set_xlim(0, len(away) / rate_hz)
        said = f"{name} by {found.take.worker}: {len(found.cuts)} found (shaded), {len(truth)} joined (bars)"
        _plain(axes, said, "time, s", "distance from rest")
    figure.tight_layout()
    figure.savefig(path)
