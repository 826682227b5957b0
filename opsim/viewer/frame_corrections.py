"""What frames many times a second miss: feet that turn at once, and joints that start or stop at once.

Where a joint would be seen too far from where it belongs, the directions of bones are amended by broken lines over
time. These are kept as knots, and no knot is where frames are good enough.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

FAR_M = 1.3e-3
"""A joint further than this from where it belongs makes the time between two frames one to amend."""
NEAR_M = 4e-4
"""So near, times the length of the bone, broken lines come; of what is less nothing is kept."""
STEP = 2e-4
"""Of amends (no unit)."""
LOOKS, FINE, PARTS, ROUNDS = 3, 32, 8, 3
"""Looks at each time between two frames, looks at one that is to be amended, and how often what comes at once is looked
for in so many parts. Every look at all of a performance may cost its whole path anew: few looks, many times each."""

Residual = Callable[[np.ndarray], np.ndarray]
"""(S,) own seconds -> (S, B, 3) unit directions as they are less those that the frames show."""
Far = Callable[[np.ndarray], np.ndarray]
"""(S,) own seconds -> (S,) how far the worst joint is from where it belongs, in metres."""


@dataclass(frozen=True, eq=False)
class Knots:
    """Corners of broken lines, (K,) each and by (K, 3): bone by bone, by time; by is in whole steps."""

    bone: np.ndarray
    at_s: np.ndarray
    by: np.ndarray

    def __len__(self) -> int:
        return len(self.bone)


NONE = Knots(np.zeros(0, int), np.zeros(0), np.zeros((0, 3), int))


def amends(far: Far, residual: Residual, bone_m: np.ndarray, duration_s: float, rate_hz: float) -> Knots:
    """The knots of one performance."""
    n_cells = int(np.ceil(duration_s * rate_hz - 1e-9))
    shares = (np.arange(LOOKS) + 0.5) / LOOKS
    looks_s = (np.arange(n_cells)[:, None] + shares) / rate_hz
    bad = np.any(far(np.minimum(looks_s.ravel(), duration_s)).reshape(n_cells, LOOKS) > FAR_M, axis=1)
    if not bad.any():
        return NONE
    wide = np.flatnonzero(bad | np.r_[bad[1:], False] | np.r_[False, bad[:-1]])
    edges_s = np.unique(np.minimum((wide[:, None] + np.arange(FINE + 1) / FINE).ravel().round(9) / rate_hz, duration_s))
    at_s, by = with_jumps(edges_s, residual, bone_m, 1.5 / FINE / rate_hz)
    return joined(
        [line(bone, at_s, by[:, bone], 1.5 / FINE / rate_hz, NEAR_M / bone_m[bone]) for bone in range(len(bone_m))]
    )


def with_jumps(
    at_s: np.ndarray, residual: Residual, bone_m: np.ndarray, near_s: float
) -> tuple[np.ndarray, np.ndarray]:
    """Times and residuals, and those just before and just after what comes at once between two neighbouring times."""
    by = residual(at_s)
    steps_m = (np.linalg.norm(np.diff(by, axis=0), axis=2) * bone_m).max(axis=1)
    jump = np.flatnonzero((steps_m > 2 * NEAR_M) & (np.diff(at_s) < near_s))
    if not jump.size:
        return at_s, by
    low_s, high_s, low, high = at_s[jump], at_s[jump + 1], by[jump], by[jump + 1]
    found_s, found, row = [at_s], [by], np.arange(jump.size)
    for _ in range(ROUNDS):
        inner_s = low_s[:, None] + (high_s - low_s)[:, None] * np.arange(PARTS + 1) / PARTS
        inner = residual(inner_s[:, 1:-1].ravel())
        found_s.append(inner_s[:, 1:-1].ravel())
        found.append(inner)
        whole = np.concatenate(
            [low[:, None], inner.reshape(jump.size, PARTS - 1, *by.shape[1:]), high[:, None]], axis=1
        )
        part = (np.linalg.norm(np.diff(whole, axis=1), axis=3) * bone_m).max(axis=2).argmax(axis=1)
        low_s, high_s, low, high = inner_s[row, part], inner_s[row, part + 1], whole[row, part], whole[row, part + 1]
    every_s, first = np.unique(np.concatenate(found_s), return_index=True)
    return every_s, np.concatenate(found)[first]


def line(bone: int, at_s: np.ndarray, by: np.ndarray, near_s: float, near: float) -> Knots:
    """A bone's residuals (S, 3) as a broken line that comes as ``near``; times further apart than near_s are apart."""
    kept = []
    for run in np.split(np.arange(at_s.size), np.flatnonzero(np.diff(at_s) > near_s) + 1):
        if run.size > 1 and np.linalg.norm(by[run], axis=1).max() > near:
            kept.append(run[corners(at_s[run], by[run], near)])
    if not kept:
        return NONE
    steps = [np.rint(by[rows] / STEP).astype(int) for rows in kept]
    for one in steps:
        one[[0, -1]] = 0  # between runs there is nothing to amend
    rows = np.concatenate(kept)
    return Knots(np.full(rows.size, bone), at_s[rows], np.concatenate(steps))


def corners(at_s: np.ndarray, by: np.ndarray, near: float) -> np.ndarray:
    """Which of points (S, 3) are corners enough (Douglas and Peucker), the first and the last among them."""
    kept, open_runs = {0, at_s.size - 1}, [(0, at_s.size - 1)]
    while open_runs:
        low, high = open_runs.pop()
        if high - low < 2:
            continue
        share = ((at_s[low + 1 : high] - at_s[low]) / (at_s[high] - at_s[low]))[:, None]
        away = np.linalg.norm(by[low + 1 : high] - by[low] - share * (by[high] - by[low]), axis=1)
        worst = int(away.argmax())
        if away[worst] > near:
            middle = low + 1 + worst
            kept.add(middle)
            open_runs += [(low, middle), (middle, high)]
    return np.array(sorted(kept))


def joined(some: list[Knots]) -> Knots:
    """One after the other."""
    if not some:
        return NONE
    return Knots(*(np.concatenate([getattr(one, name) for one in some]) for name in ("bone", "at_s", "by")))
