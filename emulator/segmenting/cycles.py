"""Cycle boundaries on a curve: between peaks and valleys in turn, where the second difference is nearest 0.

Source: spatio-temporal LTSA (seed 003), sec. 3.1: the first and the third such point bound a cycle.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np

SMOOTHING = 0.04
"""Standard deviation, in cycles, of the Gaussian by which the curve is smoothed before it is differentiated."""
PROMINENCE = 0.35
"""A peak stands out by this share of the curve's span (5 % to 95 %), else it is a wave on the way."""

MOST_OF_THE_WAY = 0.6
"""Of the usual height from valley to peak: the least of a first or last wave that is smaller or cut off."""


@dataclass(frozen=True, eq=False)
class Cycles:
    """smooth (n,) the curve; extremes (E,) frames of its peaks and valleys in turn; boundary (E - 1,) frames, also
    between frames, of the boundaries between them; rising (E - 1,) whether the curve rises there.

    begins      : 0 or 1, the boundary that the first cycle begins with: where the curve rises or where it falls
    start, stop : (C,) frames of the cycles, each beginning where the one before ends
    """

    smooth: np.ndarray
    extremes: np.ndarray
    boundary: np.ndarray
    rising: np.ndarray
    begins: int = 0

    @property
    def start(self) -> np.ndarray:
        return self.edges[:-1]

    @property
    def stop(self) -> np.ndarray:
        return self.edges[1:]

    @property
    def edges(self) -> np.ndarray:
        """(C + 1,) frames where cycles begin or end; none where there is no whole cycle."""
        found = self.boundary[self.begins :: 2]
        return found if len(found) > 1 else found[:0]


def cycles(y: np.ndarray, period: float) -> Cycles:
    """The cycles of a curve y (n,) with about ``period`` frames a cycle; as many as there are, also none."""
    from scipy.ndimage import gaussian_filter1d
    from scipy.signal import find_peaks

    smooth = gaussian_filter1d(np.asarray(y, float), max(SMOOTHING * period, 1e-3), mode="nearest")
    least = PROMINENCE * float(np.subtract(*np.quantile(smooth, [0.95, 0.05])))
    if not least > 0:
        return Cycles(smooth, np.zeros(0, int), np.zeros(0), np.zeros(0, bool))
    found = [(int(i), 1) for i in find_peaks(smooth, prominence=least)[0]]
    found += [(int(i), -1) for i in find_peaks(-smooth, prominence=least)[0]]
    turns = _with_ends(_in_turn(sorted(found), smooth), smooth, round(period))
    extremes = np.array([frame for frame, _ in turns], dtype=int)
    boundary = np.array([_inflection(smooth, a, b) for a, b in itertools.pairwise(extremes)], dtype=float)
    rising = np.array([sign < 0 for _, sign in turns[:-1]], dtype=bool)
    return Cycles(smooth, extremes, boundary, rising)


def at_the_most_alike(found: Cycles, points: np.ndarray) -> Cycles:
    """The cycles cut where the curve rises or where it falls: the more cycles, else where postures are more alike.

    points : (n, m) postures; alike at the boundaries, so that cycles can be joined in any order
    """

    def badness(begins: int) -> tuple[int, float]:
        edges = replace(found, begins=begins).edges
        return -len(edges), float(np.mean(np.var(points[np.rint(edges).astype(int)], axis=0))) if len(edges) else 0.0

    return replace(found, begins=min((0, 1), key=badness))


def _in_turn(found: list[tuple[int, int]], smooth: np.ndarray) -> list[tuple[int, int]]:
    """Peaks (1) and valleys (-1) in turn: of several of a kind in a row the one that stands out most."""
    turns: list[tuple[int, int]] = []
    for frame, sign in found:
        if turns and turns[-1][1] == sign:
            if sign * smooth[frame] > sign * smooth[turns[-1][0]]:
                turns[-1] = frame, sign
        else:
            turns.append((frame, sign))
    return turns


def _with_ends(turns: list[tuple[int, int]], smooth: np.ndarray, period: int) -> list[tuple[int, int]]:
    """The turns, and before the first and after the last the nearest to a turn that a smaller or cut-off wave has."""
    if len(turns) < 2:
        return turns
    usual = float(np.median(np.abs(np.diff(smooth[[frame for frame, _ in turns]]))))
    (first, sign), (last, last_sign) = turns[0], turns[-1]
    start = max(0, first - period)
    before = start + int(np.argmin(sign * smooth[start : first + 1]))
    after = last + int(np.argmin(last_sign * smooth[last : last + period + 1]))
    if sign * (smooth[first] - smooth[before]) > MOST_OF_THE_WAY * usual:
        turns = [(before, -sign), *turns]
    if last_sign * (smooth[last] - smooth[after]) > MOST_OF_THE_WAY * usual:
        turns = [*turns, (after, -last_sign)]
    return turns


def _inflection(smooth: np.ndarray, first: int, last: int) -> float:
    """Where the second difference passes 0 between two extremes; of several such places the one nearest half-way."""
    if last - first < 3:
        return (first + last) / 2
    at = np.arange(first + 1, last)
    second = smooth[at + 1] - 2 * smooth[at] + smooth[at - 1]
    change = np.flatnonzero(np.signbit(second[1:]) != np.signbit(second[:-1]))
    if not len(change):
        return float(at[np.argmin(np.abs(second))])
    low, high = np.abs(second[change]), np.abs(second[change + 1])
    place = at[change] + low / np.maximum(low + high, 1e-300)
    half_way = (smooth[first] + smooth[last]) / 2
    return float(place[np.argmin(np.abs(np.interp(place, np.arange(len(smooth)), smooth) - half_way))])
