"""A join, looked at closely: the body before, at and after it, the speed of its bones, and where its feet are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from opsim.report.plot.body import LEFT, RIGHT, TRUNK, draw_person

RATE_HZ = 100.0
STEP_S, M_PER_S = 0.3, 2.2
WIDE_IN, LEFT_IN, AXES_IN = 11.0, 1.0, 9.8
PALE, GREY = "#c9ced6", "#6b737d"


def draw_joins(drawn: Any, first: int, last: int, path: Path) -> None:
    """One performance (a block of one) from a second before part ``first`` to a second after part ``last``."""
    import matplotlib
    from matplotlib.figure import Figure

    joins_s = drawn.stop_s[0, first - 1 : last + 1]
    times_s = np.arange(joins_s[0] - 1.0, joins_s[-1] + 1.0, 1 / RATE_HZ)
    joints = drawn.positions_m(times_s=times_s)[0]
    tall_in = AXES_IN * 2.35 / (np.ptp(times_s) * M_PER_S)
    figure = Figure(figsize=(WIDE_IN, tall_in + 3.9), facecolor="white")
    low_in = ((3.6, tall_in), (2.1, 1.2), (0.55, 1.2))
    people, speeds, feet = (
        figure.add_axes((LEFT_IN / WIDE_IN, at / (tall_in + 3.9), AXES_IN / WIDE_IN, high / (tall_in + 3.9)))
        for at, high in low_in
    )
    _people(people, drawn, joints, times_s)
    _speeds(speeds, drawn, times_s)
    _feet(feet, drawn.skeleton, joints, times_s)
    labels = drawn.model.labels
    for axes in (people, speeds, feet):
        axes.spines[["top", "right"]].set_visible(False)
        scale = M_PER_S if axes is people else 1.0
        axes.set_xlim(times_s[0] * scale, times_s[-1] * scale)
        for k, at_s in enumerate(joins_s):
            before, after = (w[0] for w in drawn.windows_s[first - 1 + k])
            at_s, before, after = at_s * scale, before * scale, after * scale
            axes.axvspan(at_s - before, at_s + after, color="#eef1f5", zorder=-2)
            axes.axvline(at_s, color=GREY, lw=1.0, zorder=-1)
            if axes is people:
                said = f"{labels[first - 1 + k]} | {labels[first + k]}"
                axes.text(at_s, 2.1, said, ha="center", va="bottom", size=10, color=TRUNK)
    feet.set_xlabel("seconds from the start of the kit; shaded: where postures are led from one motion to the next")
    with matplotlib.rc_context({"svg.hashsalt": "opsim", "svg.fonttype": "path"}):
        figure.savefig(path, dpi=150)


def _people(axes: Any, drawn: Any, joints: np.ndarray, times_s: np.ndarray) -> None:
    """Figures at their times, seen from the right side, each at its own place in the picture."""
    root = drawn.skeleton.parents.index(-1)
    axes.set(ylim=(-0.05, 2.3), ylabel="metres", xticks=[])
    for frame in range(0, len(times_s), round(STEP_S * RATE_HZ)):
        body = joints[frame] - joints[frame, root] * np.array([1.0, 1.0, 0.0])
        draw_person(axes, body[:, [0, 2]], -body[:, 1], float(times_s[frame]) * M_PER_S, drawn.skeleton)
    axes.plot(times_s[[0, -1]] * M_PER_S, [0, 0], color=PALE, lw=1.2)


def _speeds(axes: Any, drawn: Any, times_s: np.ndarray) -> None:
    """The fastest bone: as joined, and as the parts are one after the other."""
    joined, raw = drawn.directions(times_s=times_s)[0], _end_to_end(drawn, times_s)
    middle_s = 0.5 * (times_s[1:] + times_s[:-1])
    for d, colour, width, label in ((raw, "#D55E00", 1.0, "end to end"), (joined, TRUNK, 1.6, "joined")):
        speed = np.linalg.norm(np.diff(d, axis=0), axis=-1).max(axis=1) * RATE_HZ
        axes.plot(middle_s, np.minimum(speed, 20.0), color=colour, lw=width, label=label)
    axes.set(ylabel="fastest bone\nrad/s (to 20)", ylim=(0, 20.5))
    axes.legend(frameon=False, loc="upper right")


def _end_to_end(drawn: Any, times_s: np.ndarray) -> np.ndarray:
    which = np.searchsorted(drawn.stop_s[0][:-1], times_s, side="right")
    own_s = times_s - (drawn.stop_s - drawn.part_s)[0][which]
    found = [drawn.parts[k].directions(times_s=own_s[which == k][None])[0] for k in np.unique(which)]
    return np.concatenate(found)


def _feet(axes: Any, skeleton: Any, joints: np.ndarray, times_s: np.ndarray) -> None:
    """How far each foot is along the floor, by the slower of ankle and toe."""
    middle_s = 0.5 * (times_s[1:] + times_s[:-1])
    for side, colour in (("left", LEFT), ("right", RIGHT)):
        both = [joints[:, skeleton.index(f"{side}_{joint}"), :2] for joint in ("ankle", "toe")]
        speed = np.min([np.linalg.norm(np.diff(way, axis=0), axis=-1) * RATE_HZ for way in both], axis=0)
        axes.plot(middle_s, np.maximum(speed, 1e-3), color=colour, lw=1.6, label=f"{side} foot")
    axes.set(ylabel="feet on the\nfloor, m/s", yscale="log", ylim=(0.9e-3, 12.0))
    axes.legend(frameon=False, loc="upper right")
