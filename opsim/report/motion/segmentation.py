"""How a take was cut: postures at the cuts, the curve over time with what was cut shaded, the manifold beside it.

Histograms of how well bodies foretell joint angles: figures 4 and 5 of Baydal-Bertomeu et al., as SVG or PNG.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from opsim.files import whole_file
from opsim.report.plot.body import LEFT, RIGHT, draw_person, view_axes
from opsim.report.plot.plotly import ACCENT, GRID, INK, MUTED

WIDE_IN = 13.0
HEADING_IN = 0.4
LEFT_SHARE = 0.075
"""Of the width, left of the panels."""
MOST_TIMES = 10
WORD_SHARE = (0.24, 0.09)
"""Of the panel of the manifold, what the word of a time takes."""
EDGE_M = 0.5
"""From the middle of the first and of the last figure to the edge."""
SHADES = ("#cfe3f1", "#f6dcc9")
UNITS = {
    "preparing": "#e3e6ea",
    "initial": "#F0E442",
    "cyclic": "#8db8d8",
    "final": "#F0E442",
    "wind-up": "#e3e6ea",
}


@dataclass(frozen=True, eq=False)
class CutTake:
    """What is drawn of one take.

    time_s, curve : (T,) the curve over time, called ``says``
    pieces        : (start_s, end_s, name) of each piece; units: (name, start_s, end_s), or none
    manifold      : (n, 2) coordinates of frames at manifold_s (n,), or none
    positions_m   : (T, J, 3) of a body of ``skeleton``; drawn at posture_s
    """

    title: str
    time_s: np.ndarray
    curve: np.ndarray
    says: str
    pieces: Sequence[tuple[float, float, str]]
    skeleton: Any
    positions_m: np.ndarray
    posture_s: np.ndarray
    units: Sequence[tuple[str, float, float]] = ()
    manifold: np.ndarray | None = None
    manifold_s: np.ndarray = field(default_factory=lambda: np.zeros(0))


def draw_cuts(takes: Sequence[CutTake], path: str | Path, *, heading: str = "") -> Path:
    """One row of panels a take below a heading, if any, as PNG or SVG by the ending of ``path``."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    path = Path(path)
    style: Any = {"svg.fonttype": "none", "svg.hashsalt": "opsim", "text.parse_math": False}
    with rc_context(style), whole_file(path) as temporary:
        heights = [*([HEADING_IN] if heading else []), *[4.6] * len(takes)]
        figure = Figure(figsize=(WIDE_IN, sum(heights)), facecolor="white")
        parts = figure.subfigures(len(heights), 1, squeeze=False, height_ratios=heights)[:, 0]
        if heading:
            parts[0].text(LEFT_SHARE, 0.3, heading, size=11, color=INK, va="center")
        for row, (take, part) in enumerate(zip(takes, parts[len(heights) - len(takes) :])):
            _draw(part, take, legend=row == 0)
        kind = path.suffix.removeprefix(".").lower()
        figure.savefig(temporary, format=kind, dpi=150, metadata={"Date": None} if kind == "svg" else None)
    return path


def _draw(figure: Any, take: CutTake, *, legend: bool) -> None:
    figure.text(LEFT_SHARE, 0.965, take.title, size=12, weight="bold", color=INK, va="top")
    if legend:
        figure.text(0.985, 0.965, "right limbs", size=9, color=RIGHT, va="top", ha="right")
        figure.text(0.925, 0.965, "left limbs", size=9, color=LEFT, va="top", ha="right")
    wide = (0.745 if take.manifold is not None else 0.985) - LEFT_SHARE
    people = figure.add_axes((LEFT_SHARE, 0.49, wide, 0.42))
    curve = figure.add_axes((LEFT_SHARE, 0.12, wide, 0.36))
    curve.set_xlim(float(take.time_s[0]), float(take.time_s[-1]))
    _draw_people(people, curve, take)
    _draw_curve(curve, take)
    _draw_units_legend(figure, take)
    if take.manifold is not None:
        _draw_manifold(figure.add_axes((0.785, 0.12, 0.2, 0.70)), take)


def _draw_people(axes: Any, curve: Any, take: CutTake) -> None:
    """Figures side by side, each tied to its time on the curve below."""
    from matplotlib.patches import ConnectionPatch

    right, viewer = view_axes(take.positions_m, take.skeleton)
    at_s = take.posture_s
    frames = np.clip(np.searchsorted(take.time_s, at_s), 0, len(take.time_s) - 1)
    root = take.skeleton.parents.index(-1)
    floor = float(np.quantile(take.positions_m[..., 2].min(axis=1), 0.1))
    tall = float(np.quantile(take.positions_m[..., 2].max(axis=1), 0.98)) - floor + 0.36
    box = axes.get_window_extent()
    wide = tall * box.width / box.height
    axes.set(xlim=(0, wide), ylim=(-0.12, tall - 0.12), aspect="equal")
    axes.axis("off")
    room = wide - 2 * EDGE_M
    apart = min(0.8, room / max(len(at_s) - 1, 1))
    places = EDGE_M + spread(at_s / float(take.time_s[-1]) * wide - EDGE_M, room, apart)
    for place, second, frame in zip(places, at_s, frames):
        around = take.positions_m[frame] - np.append(take.positions_m[frame, root, :2], floor)
        flat = np.stack([around[:, :2] @ right, around[:, 2]], axis=1)
        draw_person(axes, flat, around[:, :2] @ viewer, place, take.skeleton)
        below = {"coordsB": curve.get_xaxis_transform(), "axesA": axes, "axesB": curve}
        tie = ConnectionPatch((place, -0.06), (second, 1.0), "data", **below, color=MUTED, lw=0.6)
        axes.add_artist(tie)


def spread(wanted: np.ndarray, wide: float, apart: float) -> np.ndarray:
    """Places as near to those wanted (increasing) as may be, ``apart`` from each other and within 0 .. wide."""
    n = len(wanted)
    steps = apart * np.arange(n)
    free = np.clip(_rising(wanted - steps), 0.0, max(wide - apart * (n - 1), 0.0))
    return np.asarray(free + steps)


def _rising(values: np.ndarray) -> np.ndarray:
    """The non-decreasing sequence nearest to the values (pool adjacent violators)."""
    blocks: list[list[float]] = []
    for value in values:
        blocks.append([float(value), 1.0])
        while len(blocks) > 1 and blocks[-2][0] > blocks[-1][0]:
            mean, size = blocks.pop()
            other, count = blocks[-1]
            blocks[-1] = [(mean * size + other * count) / (size + count), size + count]
    return np.concatenate([np.full(int(size), mean) for mean, size in blocks]) if blocks else values


def _draw_curve(axes: Any, take: CutTake) -> None:
    for number, (start_s, end_s, name) in enumerate(take.pieces):
        axes.axvspan(start_s, end_s, color=SHADES[number % 2], lw=0, zorder=0)
        if len(take.pieces) <= 40:
            middle = ((start_s + end_s) / 2, 0.985)
            axes.text(*middle, name, transform=axes.get_xaxis_transform(), ha="center", va="top", size=9, color=INK)
    for name, start_s, end_s in take.units:
        axes.axvspan(start_s, end_s, ymax=0.055, color=UNITS.get(name, GRID), lw=0, zorder=1)
        if (end_s - start_s) > 0.055 * take.time_s[-1]:
            below = ((start_s + end_s) / 2, 0.012)
            axes.text(*below, name, transform=axes.get_xaxis_transform(), ha="center", va="bottom", size=8, color=INK)
    for at_s in sorted({edge for start_s, end_s, _ in take.pieces for edge in (start_s, end_s)}):
        axes.axvline(at_s, color=MUTED, lw=0.6, zorder=1)
    axes.plot(take.time_s, take.curve, color=ACCENT, lw=1.4, zorder=3)
    low, high = float(take.curve.min()), float(take.curve.max())
    room = max(high - low, 1e-9)
    axes.set_ylim(low - 0.14 * room, high + 0.16 * room)
    axes.set_ylabel(take.says, size=8, color=MUTED)
    axes.set_xlabel("time, s", size=9, color=MUTED)
    axes.tick_params(labelsize=8, colors=MUTED)
    axes.spines[["top", "right"]].set_visible(False)


def _draw_units_legend(figure: Any, take: CutTake) -> None:
    """What the colours of the bar below the curve are, in the order of the units."""
    from matplotlib.patches import Patch

    of_colour: dict[str, list[str]] = {}
    for name, start_s, end_s in take.units:
        if end_s > start_s:
            of_colour.setdefault(UNITS.get(name, GRID), []).append(name)
    if of_colour:
        patches = [Patch(facecolor=colour, edgecolor=MUTED, lw=0.4, label=" and ".join(names))
                   for colour, names in of_colour.items()]  # fmt: skip
        look: Any = {"ncols": len(patches), "fontsize": 8, "frameon": False, "labelcolor": MUTED}
        figure.legend(handles=patches, loc="lower left", bbox_to_anchor=(LEFT_SHARE - 0.005, -0.005), **look)


def _draw_manifold(axes: Any, take: CutTake) -> None:
    """Two coordinates of the manifold, coloured by time, with the time at some points."""
    assert take.manifold is not None
    x, y = take.manifold[:, 0], take.manifold[:, 1]
    gone = np.concatenate([[False], np.diff(take.manifold_s) > 1.5 * np.median(np.diff(take.manifold_s))])
    axes.plot(np.where(gone, np.nan, x), np.where(gone, np.nan, y), color=GRID, lw=0.8, zorder=1)
    axes.scatter(x, y, c=take.manifold_s, cmap="viridis", s=9, lw=0, zorder=2)
    for frame in apart(take.manifold):
        word = f"{take.manifold_s[frame]:.1f} s"
        axes.annotate(word, (x[frame], y[frame]), (4, 3), textcoords="offset points", size=7, color=INK, zorder=3)
    axes.set_title("manifold, two coordinates\n(colour: time)", size=9, color=MUTED, loc="left")
    axes.set(xticks=[], yticks=[])
    axes.spines[:].set_color(GRID)
    axes.margins(0.12)


def apart(places: np.ndarray) -> list[int]:
    """Of points (n, 2), those whose words, right above each, do not stand in one another."""
    spread_of = np.maximum(np.ptp(places, axis=0), 1e-12)
    said: list[int] = []
    for point in np.linspace(0, len(places) - 1, MOST_TIMES).astype(int).tolist():
        away = np.abs(places[point] - places[said]) / spread_of / WORD_SHARE
        if not said or bool(np.all(away.max(axis=1) > 1)):
            said.append(point)
    return said


N_BARS = 20
ICC_OF_THE_PAPER, SEM_OF_THE_PAPER = (0.91, 0.829, 0.971), (4.16, 0.41, 14.23)
"""Mean, 5th and 95th percentile that the paper reports for 18 runners."""


def draw_agreement(validation: Any, path: str | Path) -> Path:
    """ICC of people and SEM of joint angles, by body filled and by the others' mean as outline, the paper's range grey.

    validation : with ``task``, ``by_body`` and ``by_mean``, each with ``person_icc`` (W,) and ``sem_deg`` (W, A)
    path       : ends in .svg or .png
    """
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    path = Path(path)
    style: Any = {"svg.fonttype": "none", "svg.hashsalt": "opsim", "text.parse_math": False}
    with rc_context(style), whole_file(path) as temporary:
        figure = Figure(figsize=(9.0, 3.6), layout="constrained")
        title = f"{validation.task}: people left out, foretold from their bodies"
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, color=INK)
        left, right = figure.subplots(1, 2)
        pairs = [(validation.by_body.person_icc, validation.by_mean.person_icc)]
        pairs.append((validation.by_body.sem_deg.ravel(), validation.by_mean.sem_deg.ravel()))
        _panel(left, *pairs[0], ICC_OF_THE_PAPER, "ICC(2,1) of a person, all joint angles", 3)
        _panel(right, *pairs[1], SEM_OF_THE_PAPER, "SEM of a joint angle, degrees", 2)
        right.legend(fontsize=8, frameon=False)
        kind = path.suffix.removeprefix(".").lower()
        figure.savefig(temporary, format=kind, dpi=150, metadata={"Date": None} if kind == "svg" else None)
    return path


def _panel(axes: Any, body: np.ndarray, mean: np.ndarray, paper: tuple[float, ...], label: str, digits: int) -> None:
    body, mean = body[np.isfinite(body)], mean[np.isfinite(mean)]
    edges = np.linspace(min(body.min(), mean.min(), paper[1]), max(body.max(), mean.max(), paper[2]), N_BARS + 1)
    axes.axvspan(paper[1], paper[2], color=MUTED, alpha=0.12, linewidth=0, label="paper, 5th to 95th percentile")
    axes.hist(body, edges, weights=np.full(body.size, 100 / body.size), color=ACCENT, label="by body")
    outline = np.full(mean.size, 100 / mean.size)
    axes.hist(mean, edges, weights=outline, histtype="step", color=INK, linewidth=1.2, label="by the others' mean")
    said = f"by body {body.mean():.{digits}f} ({body.std(ddof=1):.{digits}f}), paper {paper[0]:g}"
    axes.set_title(said, loc="left", fontsize=9, color=INK)
    axes.set_xlabel(label, fontsize=9, color=MUTED)
    axes.set_ylabel("per cent", fontsize=9, color=MUTED)
    axes.grid(color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=8)
    axes.spines[["top", "right"]].set_visible(False)
