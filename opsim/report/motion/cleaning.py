"""What a picture of a cleaned recording is made of: arrays and words, no emulator.

One repair before and after: the joint's way through time, and the body about the worst frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.report.plot.body import Stage, Strip, view_axes
from opsim.report.plot.plotly import GRID, INK, MUTED

VERDICTS = {
    "left out": ("#7a1f1f", "cannot be used"),
    "bad": ("#D55E00", "a fault that was left"),
    "shortened": ("#CC4678", "part of the movement is gone"),
    "repaired": ("#0072B2", "mended"),
    "told": ("#8a5a00", "odd, but left as it is"),
    "good": ("#009E73", "nothing to mend"),
}
"""Colour and meaning of what is said of a take, the worst first. "repaired, told" is both, in the first's colour."""


def headline(verdict: str) -> str:
    """The verdict that comes first in, say, "repaired, told"."""
    return verdict.partition(", ")[0]


@dataclass(frozen=True)
class Finding:
    """One thing found in a take: which kind, where in seconds, how much, in words; ``share`` from 0 to 1 colours it.

    column : where it stands in the table, such as "glitch left"; its kind unless said
    """

    kind: str
    first_s: float
    last_s: float
    size: str
    share: float
    mended: bool
    words: str
    column: str = ""

    @property
    def of(self) -> str:
        return self.column or self.kind


@dataclass(frozen=True)
class TakeCard:
    """A take, how long it is, what is said of it, and what was found in it."""

    name: str
    duration_s: float
    verdict: str
    findings: tuple[Finding, ...]


@dataclass(frozen=True)
class Mended:
    """One joint of one take before and after.

    time_s                 : (T,) of the take that was read
    before_m, after_m      : (T, J, 3), nan where not seen or cut off
    first_s, last_s, at_s  : the frames that it is about, and the worst of them
    mended                 : whether anything was changed; else the fault was left
    """

    take: str
    verdict: str
    joint: str
    words: str
    time_s: np.ndarray
    before_m: np.ndarray
    after_m: np.ndarray
    first_s: float
    last_s: float
    at_s: float
    skeleton: Any
    mended: bool = True


@dataclass(frozen=True)
class CleanedView:
    """All of a picture: takes in the order of the recording, kinds in the order of the work, the worst repairs."""

    title: str
    cards: Sequence[TakeCard]
    kinds: Sequence[tuple[str, str]]
    worst: Sequence[Mended]
    notes: Sequence[str]

    @property
    def columns(self) -> list[str]:
        """Of the table: by kind, and of each kind what was mended before what was left."""
        order = [kind for kind, _ in self.kinds]
        found = [finding for card in self.cards for finding in card.findings if finding.kind in order]
        found.sort(key=lambda finding: (order.index(finding.kind), not finding.mended, finding.of))
        return list(dict.fromkeys(finding.of for finding in found))


def cell(findings: Sequence[Finding]) -> str:
    """How many findings of a column, and the size of the largest."""
    if not findings:
        return ""
    largest = max(findings, key=lambda finding: finding.share).size
    return largest if len(findings) == 1 else f"{len(findings)} x {largest}"


BEFORE, AFTER = "#D55E00", "#0072B2"
AROUND_S = 0.6
N_BODIES = 5
HEIGHT_IN = 3.5
NEEDED = ("left_hip", "right_hip", "head")


def draw_beside(figure: Any, mended: Mended) -> None:
    """Fill a subfigure: the coordinate that changes most, above bodies at five frames before and after."""
    figure.suptitle(
        f"{mended.take}, {mended.joint}{_left(mended)}: {_wrapped(mended.words)}",
        x=0.012, ha="left", fontsize=9, color=INK,
    )  # fmt: skip
    curve, bodies = figure.subplots(1, 2, gridspec_kw={"width_ratios": (1.0, 1.25), "wspace": 0.12})
    _draw_way(curve, mended)
    _draw_bodies(bodies, mended)


def _left(mended: Mended) -> str:
    """For the title: that nothing was mended here, or that something else was left in this take."""
    if not mended.mended:
        return " (left as it is: before and after are the same)"
    left = {"bad": " (the take is bad: another fault was left)", "told": " (something else was left, told)"}
    return left.get(mended.verdict.rpartition(", ")[2], "")


def _draw_way(axes: Any, mended: Mended) -> None:
    joint = list(mended.skeleton.names).index(mended.joint)
    low, high = mended.first_s - AROUND_S, mended.last_s + AROUND_S
    near = (mended.time_s >= low) & (mended.time_s <= high)
    before, after = mended.before_m[near, joint], mended.after_m[near, joint]
    axis = _liveliest(before, after)
    axes.axvspan(mended.first_s, mended.last_s, color="#eceff2", lw=0)
    middle = float(np.nanmedian(after[:, axis])) if np.isfinite(after[:, axis]).any() else 0.0
    style: Any = {"marker": ".", "ms": 3.5, "lw": 1.3}
    axes.plot(mended.time_s[near], 100 * (before[:, axis] - middle), color=BEFORE, label="before", **style)
    axes.plot(mended.time_s[near], 100 * (after[:, axis] - middle), color=AFTER, label="after", **style)
    axes.set_xlabel("time in the take, s", fontsize=8, color=MUTED)
    axes.set_ylabel(f"{mended.joint} along {'xyz'[axis]}, cm", fontsize=8, color=MUTED)
    axes.tick_params(labelsize=8, colors=MUTED)
    axes.grid(color=GRID, linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(fontsize=8, frameon=False, loc="best")


def _liveliest(before: np.ndarray, after: np.ndarray) -> int:
    """The coordinate that was changed most, or, where nothing was, the one that jumps most."""
    with np.errstate(invalid="ignore"):
        changed = np.nan_to_num(np.abs(before - after), nan=0.0).max(axis=0)
        jumps = np.nan_to_num(np.abs(np.diff(before, n=2, axis=0)), nan=0.0)
    return int(changed.argmax() if changed.max() > 1e-3 else jumps.max(axis=0).argmax() if len(jumps) else 2)


def _draw_bodies(axes: Any, mended: Mended) -> None:
    from opsim.report.plot.body import draw_person

    axes.axis("off")
    if not set(NEEDED) <= set(mended.skeleton.names):
        return
    seen = np.isfinite(mended.after_m).all(axis=(1, 2))
    if seen.sum() < 2:
        return
    right, viewer = view_axes(mended.after_m[seen], mended.skeleton)
    stage = Stage(right, viewer, 1.0, 1.0, mended.skeleton)
    times = _moments(mended)
    flats = [[_flat(stage, mended, way, at_s) for at_s in times] for way in (mended.before_m, mended.after_m)]
    places = np.stack([[flat for flat, _ in row] for row in flats])
    left_m, right_m, tall = float(np.nanmin(places[..., 0])), float(np.nanmax(places[..., 0])), 0.35
    tall += float(np.nanmax(places[..., 1]))
    step = max(float(np.max(_widths(places))) + 0.15, 0.7)
    joint = list(mended.skeleton.names).index(mended.joint)
    for row, (label, colour) in enumerate((("before", BEFORE), ("after", AFTER))):
        down = -row * tall
        axes.text(left_m - 0.25, down + 0.5 * tall, label, rotation=90, ha="center", va="center", size=9, color=colour)
        for column, (flat, nearness) in enumerate(flats[row]):
            place = flat + np.array([0.0, down])
            if np.isfinite(place).any():
                draw_person(axes, place, nearness, column * step, mended.skeleton)
                axes.plot(*(place[joint] + [column * step, 0.0]), "o", ms=9, mfc="none", mec=colour, mew=1.6, zorder=30)
    for column, at_s in enumerate(times):
        axes.text(column * step, -tall - 0.08, f"{at_s:.2f} s", ha="center", va="top", size=8, color=MUTED)
    axes.set(
        xlim=(left_m - 0.4, (len(times) - 1) * step + right_m + 0.2), ylim=(-tall - 0.25, tall - 0.05), aspect="equal"
    )


def _widths(places: np.ndarray) -> np.ndarray:
    """(2, N) how wide each figure of places (2, N, J, 2) is, 0 where nothing of it is seen."""
    x = places[..., 0]
    seen = np.isfinite(x)
    widest = np.where(seen, x, -np.inf).max(axis=-1) - np.where(seen, x, np.inf).min(axis=-1)
    return np.where(seen.any(axis=-1), widest, 0.0)


def _moments(mended: Mended) -> np.ndarray:
    """Five times about the worst frame, a few frames apart, all within the take."""
    frame_s = mended.time_s[1] - mended.time_s[0]
    step = max(1, round((mended.last_s - mended.first_s) / frame_s / 4) + 1) * frame_s
    step = min(step, 0.12)
    times = mended.at_s + step * (np.arange(N_BODIES) - N_BODIES // 2)
    times += max(0.0, -times[0]) - max(0.0, times[-1] - mended.time_s[-1])
    return np.clip(times, 0.0, mended.time_s[-1])


def _flat(stage: Stage, mended: Mended, way_m: np.ndarray, at_s: float) -> tuple[np.ndarray, np.ndarray]:
    """The posture of the nearest frame, about where the pelvis is after cleaning."""
    frame = int(np.abs(mended.time_s - at_s).argmin())
    posture = way_m[frame]
    root = list(mended.skeleton.parents).index(-1)
    centre = mended.after_m[frame, root] if np.isfinite(mended.after_m[frame, root]).all() else posture[root]
    floor = float(np.nanmin(mended.after_m[..., 2])) if np.isfinite(mended.after_m).any() else 0.0
    return stage.flat(Strip("", np.stack([posture - [*centre[:2], floor]] * 2), 1.0, np.zeros(0)), 0.0)


def _wrapped(words: str) -> str:
    return words if len(words) < 130 else words[:129] + "…"
