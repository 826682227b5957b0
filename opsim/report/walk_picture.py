"""One walk to scale: figures from the side, and below them, on the same metres, where the feet bear from above."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from opsim.report.person import LEFT, RIGHT, TRUNK, draw_person
from opsim.report.svg_axes import SvgFigure

SIDES = ("left", "right")
COLOURS = (LEFT, RIGHT)
LONGEST_M, SHORTEST_M = 7.0, 4.0
"""Of the way in a picture: a longer walk is shown as far as this, a shorter one leaves room."""
APART_M = 0.75
"""Between figures, so that each stands clear of the next."""
EVERY = 2
"""Of the moments a foot bears, so many to a print: others would lie on it."""
BEFORE_M, AFTER_M = 0.45, 0.5
PALE, LINE = "#6b737d", "#aab0b8"


@dataclass(frozen=True, eq=False)
class Walk:
    """A walk at T even points of its time: ``positions_m`` (T, J, 3), z up, and which foot bears, (T, 2) left, right.

    duration_s : what it took on the floor; way : from where to where, in words
    """

    worker: str
    way: str
    distance_m: float
    duration_s: float
    positions_m: np.ndarray
    contact: np.ndarray
    skeleton: Any

    @cached_property
    def along_m(self) -> np.ndarray:
        """(T, J, 3) with the way along x, from 0, and feet about y = 0."""
        root = self.positions_m[:, list(self.skeleton.parents).index(-1)]
        go = root[-1, :2] - root[0, :2]
        x, y = go / max(float(np.linalg.norm(go)), 1e-9)
        centred = self.positions_m - np.append(root[0, :2], 0.0)
        return centred @ np.array([[x, -y, 0.0], [y, x, 0.0], [0.0, 0.0, 1.0]])

    def foot_m(self, side: int) -> np.ndarray:
        """(T, 2, 3) ankle and toe of the left (0) or the right foot (1)."""
        names = list(self.skeleton.names)
        return self.along_m[:, [names.index(f"{SIDES[side]}_{joint}") for joint in ("ankle", "toe")]]

    def stances(self, side: int) -> list[slice]:
        """The stretches of time in which a foot bears."""
        bears = np.r_[False, self.contact[:, side], False]
        edges = np.flatnonzero(bears[1:] != bears[:-1])
        return [slice(int(start), int(stop)) for start, stop in zip(edges[::2], edges[1::2])]

    @cached_property
    def slide_mm(self) -> float:
        """How far a bearing foot slides at most over the floor in one stance, in millimetres.

        A foot rolls over its ankle and its toe, so that one of the two stands still: of each moment the lesser way
        of both counts.
        """
        slid = [0.0]
        for side in (0, 1):
            foot = self.foot_m(side)[..., :2]
            for stance in self.stances(side):
                ways = np.linalg.norm(np.diff(foot[stance], axis=0), axis=-1)
                slid.append(float(ways.min(axis=-1).sum()))
        return 1000.0 * max(slid)

    @cached_property
    def footfalls_m(self) -> np.ndarray:
        """(S,) where along the way a foot comes to stand, in the order of time; where it stood at first is left out."""
        falls = [
            (stance.start, float(self.foot_m(side)[stance, 1, 0].max()))
            for side in (0, 1)
            for stance in self.stances(side)
            if stance.start > 0
        ]
        return np.array([place for _, place in sorted(falls)])

    @property
    def step_length_m(self) -> float:
        """The median way from one footfall to the other foot's next, without the last, which closes; nan for none."""
        steps_m = np.diff(self.footfalls_m[:-1])
        return float(np.median(steps_m)) if steps_m.size else float("nan")

    @property
    def cadence_per_min(self) -> float:
        """Footfalls a minute."""
        return 60.0 * self.footfalls_m.size / self.duration_s


def draw_walk(walk: Walk, wide_m: float = SHORTEST_M) -> bytes:
    """The picture as SVG; ``wide_m`` is how much of the way fits, so that several pictures have one scale."""
    wide_m = float(np.clip(wide_m, SHORTEST_M, LONGEST_M))
    inch = 11.0 / (wide_m + BEFORE_M + AFTER_M)
    tall_m, plan_m = float(walk.along_m[..., 2].max()) + 0.42, 0.95
    figure = SvgFigure((11.0, inch * (tall_m + plan_m)))
    share = plan_m / (tall_m + plan_m)
    above = figure.add_axes((0.0, share, 1.0, 1.0 - share))
    below = figure.add_axes((0.0, 0.0, 1.0, share))
    for axes, low, high in ((above, -0.08, tall_m - 0.08), (below, -0.55, plan_m - 0.55)):
        axes.set(xlim=(-BEFORE_M, wide_m + AFTER_M), ylim=(low, high), aspect="equal")
        axes.axis("off")
    _side_view(above, walk, wide_m)
    _plan_view(below, walk, wide_m)
    return figure.svg()


def _side_view(axes: Any, walk: Walk, wide_m: float) -> None:
    root_m = walk.along_m[:, list(walk.skeleton.parents).index(-1), 0]
    shown_m = min(float(root_m[-1]), wide_m)
    axes.plot([-BEFORE_M, wide_m + AFTER_M], [-0.02] * 2, color=LINE, lw=1.2, zorder=1)
    for place_m in np.linspace(0.0, shown_m, max(int(shown_m / APART_M) + 1, 2)):
        frame = int(np.argmax(root_m >= place_m - 1e-6)) if place_m < shown_m else _last(root_m, shown_m)
        body = walk.along_m[frame]
        draw_person(axes, body[:, [0, 2]], -body[:, 1], 0.0, walk.skeleton)
    words = {"ha": "left", "va": "top", "size": 10.5, "weight": "bold", "color": TRUNK, "parse_math": False}
    cut = f", the first {wide_m:g} m" if walk.distance_m > wide_m else ""
    text = f"{walk.worker}: {walk.way}, {walk.distance_m:.1f} m in {walk.duration_s:.1f} s{cut}"
    axes.text(-BEFORE_M + 0.08, axes.get_ylim()[1] - 0.04, text, **words)


def _last(root_m: np.ndarray, shown_m: float) -> int:
    """The frame at the end of what is shown."""
    return int(np.flatnonzero(root_m <= shown_m + 1e-6)[-1])


def _plan_view(axes: Any, walk: Walk, wide_m: float) -> None:
    """Each foot at every moment it bears, as a faint line from ankle to toe with a dot at either end."""
    inside = (-BEFORE_M, wide_m + AFTER_M)
    root = walk.along_m[:, list(walk.skeleton.parents).index(-1)]
    axes.plot(*root[root[:, 0] < inside[1], :2].T, color=LINE, lw=1.0, zorder=1)
    for side, colour in enumerate(COLOURS):
        foot = walk.foot_m(side)[walk.contact[:, side]][::EVERY]
        foot = foot[foot[:, 1, 0] < inside[1]]
        axes.plot(foot[..., 0].T, foot[..., 1].T, color=colour, lw=2.0, alpha=0.12, zorder=2, solid_capstyle="round")
        axes.scatter(foot[:, 1, 0], foot[:, 1, 1], s=9, color=colour, alpha=0.5, lw=0, zorder=4)
        axes.scatter(
            foot[:, 0, 0], foot[:, 0, 1], s=9, facecolor="none", edgecolor=colour, alpha=0.35, lw=0.5, zorder=3
        )
    axes.text(-BEFORE_M + 0.08, 0.38, "where feet bear, from above", va="top", size=8, color=PALE)
    for metre in range(int(wide_m) + 1):
        axes.plot([metre] * 2, [-0.3, -0.27], color=LINE, lw=1.0)
        axes.text(metre, -0.32, f"{metre} m", ha="center", va="top", size=8, color=PALE)
