"""Walks as they are walked: figures at their own places along the floor, with a footprint for each stance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from opsim.report.person import LEFT, RIGHT, TRUNK, draw_person

PALE = "#6b737d"
WIDE_IN, FEWEST_M = 12.0, 3.0
SIDES = (("left", LEFT), ("right", RIGHT))


@dataclass(frozen=True, eq=False)
class Walk:
    """One row: ``positions_m`` (T, J, 3) and ``contact`` (T, 2) at T equal steps of ``duration_s``, and what it is."""

    label: str
    positions_m: np.ndarray
    contact: np.ndarray
    duration_s: float


def walk_of(label: str, performance: Any, rate_hz: float = 60.0) -> Walk:
    """The only performance of a block of one."""
    duration_s = float(performance.duration_s[0])
    n_times = max(int(duration_s * rate_hz), 2)
    return Walk(label, performance.positions_m(n_times=n_times)[0], performance.contact(n_times=n_times)[0], duration_s)


def draw_walks(
    walks: Sequence[Walk], path: str | Path | None, skeleton: Any, *, title: str = "", every_s: float | None = None
) -> bytes:
    """The rows from the side, the way to the right, in metres; as PNG or SVG by the ending (None: SVG bytes).

    every_s : between two figures; None: so that they stand about 0.45 m apart
    Raises ValueError for another ending.
    """
    from opsim.report.strips import render

    ending = "svg" if path is None else Path(path).suffix.lower().lstrip(".")
    if ending not in ("png", "svg"):
        raise ValueError(f"walks are drawn as .png or .svg, found {str(path)!r}")
    picture = render(_figure(walks, skeleton, title, every_s, ending), ending)
    if path is not None:
        Path(path).write_bytes(picture)
    return picture


def _figure(walks: Sequence[Walk], skeleton: Any, title: str, every_s: float | None, ending: str) -> Any:
    from opsim.report.svg_axes import figure_of

    root = skeleton.parents.index(-1)
    far = max(FEWEST_M, max(float(walk.positions_m[:, root, 0].max()) for walk in walks)) + 0.75
    tall = max(float(walk.positions_m[..., 2].max()) for walk in walks) + 0.38
    low, left = -0.62, -0.75
    inches = WIDE_IN / (far - left)
    row_in, title_in = inches * (tall - low), 0.42 if title else 0.05
    figure = figure_of(ending, (WIDE_IN, row_in * len(walks) + title_in))
    high = figure.get_figheight()
    for row, walk in enumerate(walks):
        axes = figure.add_axes((0.0, 1 - (title_in + (row + 1) * row_in) / high, 1.0, row_in / high))
        axes.set(xlim=(left, far), ylim=(low, tall), aspect="equal")
        axes.axis("off")
        _row(axes, walk, skeleton, far, tall, every_s)
    if title:
        figure.text(0.012, 1 - 0.1 / high, title, va="top", size=12, weight="bold", parse_math=False)
        figure.text(0.988, 1 - 0.12 / high, "right limbs", va="top", ha="right", size=9, color=RIGHT)
        figure.text(0.925, 1 - 0.12 / high, "left limbs", va="top", ha="right", size=9, color=LEFT)
    return figure


def _row(axes: Any, walk: Walk, skeleton: Any, far: float, tall: float, every_s: float | None) -> None:
    root = skeleton.parents.index(-1)
    floor = float(np.quantile(walk.positions_m[..., 2].min(axis=1), 0.1))
    axes.plot([-0.7, far - 0.05], [floor - 0.02] * 2, color="#aab0b8", lw=1.2, zorder=1)
    for metre in range(int(far - 0.4) + 1):
        axes.plot([metre] * 2, [floor - 0.02, floor - 0.06], color="#aab0b8", lw=1.2)
        axes.text(metre, floor - 0.07, f"{metre} m", ha="center", va="top", size=8, color=PALE)
    _footprints(axes, walk, skeleton, floor)
    way_m = float(np.ptp(walk.positions_m[:, root, 0]))
    step_s = every_s or walk.duration_s / max(round(way_m / 0.45), 4)
    for at in np.arange(0.0, walk.duration_s + 0.5 * step_s, step_s):
        frame = min(round(at / walk.duration_s * (len(walk.positions_m) - 1)), len(walk.positions_m) - 1)
        joints = walk.positions_m[frame]
        draw_person(axes, joints[:, [0, 2]], -joints[:, 1] + joints[root, 1], 0.0, skeleton)
    words = f"{walk.label}: {way_m:.2f} m in {walk.duration_s:.2f} s, a figure every {step_s:.2f} s"
    axes.text(-0.72, tall - 0.03, words, va="top", size=10, weight="bold", color=TRUNK, parse_math=False)


def _footprints(axes: Any, walk: Walk, skeleton: Any, floor: float) -> None:
    """A bar from ankle to toe for each stance, as wide as all it covers: a foot that slides draws a long one."""
    names = list(skeleton.names)
    for row, (side, colour) in enumerate(SIDES):
        ankle, toe = (walk.positions_m[:, names.index(f"{side}_{joint}"), 0] for joint in ("ankle", "toe"))
        bears = np.concatenate([[False], walk.contact[:, row], [False]])
        edges = np.flatnonzero(np.diff(bears.astype(int)))
        height = floor - (0.33, 0.41)[row]
        for start, stop in zip(edges[::2], edges[1::2]):
            ends = [float(ankle[start]), float(np.max(toe[start:stop]))]
            axes.plot(ends, [height] * 2, color=colour, lw=5, solid_capstyle="round")
            seconds = f"{start / (len(bears) - 3) * walk.duration_s:.2f} s"
            words = {"size": 7, "color": PALE, "va": "top" if row else "bottom"}
            axes.text(ends[0], height + (0.035, -0.04)[row], seconds, **words)
