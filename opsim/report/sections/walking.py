"""Walks as they are walked: figures at their own places along the floor, with a footprint for each stance.

One walk to scale: figures from the side, and below them, on the same metres, where the feet bear from above.

How each worker of a run walks: a walk of the run over his most usual way, drawn again.

Who walks most, and which ways, in sentences.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from opsim.kpi.window import SECONDS_PER_HOUR, window_length_s
from opsim.report.material import Material
from opsim.report.numbers import digits, is_number
from opsim.report.page import Picture, Section, Words
from opsim.report.plot.body import LEFT, RIGHT, TRUNK, draw_person
from opsim.report.plot.svg_canvas import SvgFigure
from opsim.report.sections.common import WalkedWays, with_closed
from opsim.report.sections.motions import LIMBS, origin_of

if TYPE_CHECKING:
    from opsim.plan import Plan

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
    from opsim.report.sections.motions import render

    ending = "svg" if path is None else Path(path).suffix.lower().lstrip(".")
    if ending not in ("png", "svg"):
        raise ValueError(f"walks are drawn as .png or .svg, found {str(path)!r}")
    picture = render(_figure(walks, skeleton, title, every_s, ending), ending)
    if path is not None:
        Path(path).write_bytes(picture)
    return picture


def _figure(walks: Sequence[Walk], skeleton: Any, title: str, every_s: float | None, ending: str) -> Any:
    from opsim.report.plot.svg_canvas import figure_of

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


FOOT_SIDES = ("left", "right")
COLOURS = (LEFT, RIGHT)
LONGEST_M, SHORTEST_M = 7.0, 4.0
"""Of the way in a picture: a longer walk is shown as far as this, a shorter one leaves room."""
APART_M = 0.75
"""Between figures, so that each stands clear of the next."""
EVERY = 2
"""Of the moments a foot bears, so many to a print: others would lie on it."""
BEFORE_M, AFTER_M = 0.45, 0.5
PALE_GREY, LINE = "#6b737d", "#aab0b8"


@dataclass(frozen=True, eq=False)
class FootWalk:
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
        return self.along_m[:, [names.index(f"{FOOT_SIDES[side]}_{joint}") for joint in ("ankle", "toe")]]

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


def draw_walk(walk: FootWalk, wide_m: float = SHORTEST_M) -> bytes:
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


def _side_view(axes: Any, walk: FootWalk, wide_m: float) -> None:
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


def _plan_view(axes: Any, walk: FootWalk, wide_m: float) -> None:
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
    axes.text(-BEFORE_M + 0.08, 0.38, "where feet bear, from above", va="top", size=8, color=PALE_GREY)
    for metre in range(int(wide_m) + 1):
        axes.plot([metre] * 2, [-0.3, -0.27], color=LINE, lw=1.0)
        axes.text(metre, -0.32, f"{metre} m", ha="center", va="top", size=8, color=PALE_GREY)


MOST = 6
"""Workers shown: those who walk furthest."""
SAID = (
    "A walk of each worker over the way he takes most often, drawn again from the first replication, to scale. Below, "
    "where his feet bear, seen from above, at thirty moments a second: a foot that does not slide leaves one print, "
    "rolling from heel to toe."
)
RATE_HZ = 60.0
"""Of what is looked at: a foot goes over from its heel to its toe within a few hundredths of a second."""


def walking_section(material: Material) -> Section | None:
    """How people walk; None where the scenario names no walking emulator or nobody walks."""
    if material.log is None or material.plan.walking is None:
        return None
    walks, n_more = usual_walks(material.plan, material.log)
    return section_of(walks, n_more, material.summary.get("walking", {})) if walks else None


def section_of(walks: Sequence[FootWalk], n_more: int, source: Mapping[str, Any]) -> Section:
    """The pictures of some walks, and what they were learned from.

    n_more : how many more people walk; source : of the summary: model, library, source, licence, counts
    """
    wide_m = max(walk.distance_m for walk in walks)
    pictures = [
        Picture(draw_walk(walk, wide_m), said_of(walk), caption=f"{walk.worker}: {words(walk)}.") for walk in walks
    ]
    more = [Words(f"{n_more} more walk, less far.", muted=True)] if n_more else []
    learned = Words(origin_of(source["model"], source), muted=True)
    return Section("walking", "How people walk", [Words(SAID), LIMBS, *pictures, *more, learned], "Walking")


def said_of(walk: FootWalk) -> str:
    """The picture in words."""
    return f"{walk.worker} walking, seen from the side, with footprints seen from above"


def words(walk: FootWalk) -> str:
    """Speed, step and cadence of a walk, and whether feet slide in it."""
    speed = walk.distance_m / walk.duration_s
    steps = "" if np.isnan(walk.step_length_m) else f"steps of {walk.step_length_m:.2f} m, "
    return (
        f"{speed:.2f} m/s, {steps}{walk.cadence_per_min:.0f} a minute; "
        f"bearing feet slide by at most {walk.slide_mm:.1f} mm a step"
    )


def usual_walks(plan: Plan, log: Any) -> tuple[list[FootWalk], int]:
    """A walk of each worker over his most usual way in the first replication; how many more workers walk."""
    from opsim.history import walks_of

    walks = walks_of(log, plan)
    whole = walks.end_s - walks.start_s >= walks.whole_s - 1e-9
    metres = np.bincount(walks.worker, walks.distance_m, len(plan.workers))
    walkers = [rank for rank in np.argsort(-metres, kind="stable").tolist() if metres[rank] > 0]
    chosen = [_usual(walks, np.flatnonzero(whole & (walks.worker == rank)), plan) for rank in sorted(walkers[:MOST])]
    return [_walk(plan, log, walks, row) for row in chosen if row is not None], max(0, len(walkers) - MOST)


def _usual(walks: Any, rows: np.ndarray, plan: Plan) -> int | None:
    """The first walk over the way that some walks take most often (back or forth), of those that can be drawn."""
    from opsim.ergonomics.walking import drawable

    assert plan.walking is not None  # there are walks to draw
    rows = rows[drawable(plan.walking.model, walks.distance_m[rows])]
    if not rows.size:
        return None
    _, first, counts = np.unique(walks.distance_m[rows], return_index=True, return_counts=True)
    return int(rows[first[np.argmax(counts)]])


def _walk(plan: Plan, log: Any, walks: Any, row: int) -> FootWalk:
    """One of the walks, drawn again by its number."""
    from opsim.ergonomics.walking import walk_again

    rank, distance_m = int(walks.worker[row]), float(walks.distance_m[row])
    drawn = walk_again(plan, log.replication, rank, int(walks.k[row]), distance_m)
    n_times = max(round(float(walks.whole_s[row]) * RATE_HZ), 8) + 1
    way = f"{plan.places[walks.place_from[row]]} to {plan.places[walks.place_to[row]]}"
    return FootWalk(
        plan.workers[rank].name,
        way,
        distance_m,
        float(walks.whole_s[row]),
        drawn.decoded("positions_m", n_times=n_times),
        drawn.decoded("contact", n_times=n_times),
        drawn.block.skeleton,
    )


Row = Mapping[str, Any]


def walk_sentences(walked: WalkedWays, plan: Plan, names: Sequence[str], rows: Sequence[Row]) -> Iterator[str]:
    """rows : ``walked_m`` of the summary, a worker each, over all replications; walked : of the first; names : of
    places"""
    an_hour = f"an hour{with_closed(plan)}"
    known = [row for row in rows if row["subject"] and is_number(row["mean"])]
    if len(known) > 1:
        hours = window_length_s(plan) / SECONDS_PER_HOUR
        most, least = (pick(known, key=lambda row: row["mean"]) for pick in (max, min))
        far = f"{_metres(most, hours)} m {an_hour}"
        yield f"{most['subject']} walks most: {far}; {_least(least, most, hours)}."
    pairs = [pair for pair in walked.by_pair() if pair[3] > 0]
    total = sum(pair[3] for pair in pairs)
    a, b, trips, metres = pairs[0]
    often = f"{trips:.0f} trips" if trips >= 9.95 else "1 trip" if trips == 1 else f"{trips:.2g} trips"
    yield (
        f"In the first replication most is walked between {names[a]} and {names[b]}: {often} and "
        f"{metres:,.0f} m {an_hour}, {100 * metres / total:.0f} % of all that people walk between places."
    )


def _least(least: Row, most: Row, hours: float) -> str:
    if least["mean"] >= most["mean"]:
        return "all walk as far"
    return (
        f"{least['subject']} least, {_metres(least, hours)}" if least["mean"] > 0 else f"{least['subject']} not at all"
    )


def _metres(row: Row, hours: float) -> str:
    """The mean, with its interval where there is one."""
    known = all(is_number(row.get(end)) for end in ("low", "high"))
    half = (row["high"] - row["low"]) / 2 / hours if known else None
    mean = digits(row["mean"] / hours, half)
    if not known:
        return mean
    low, high = (digits(max(row[end], 0.0) / hours, half) for end in ("low", "high"))
    return mean if low == high else f"{mean} ({low} to {high})"
