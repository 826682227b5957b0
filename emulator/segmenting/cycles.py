"""The curve that cycles are read from: coordinates of the manifold, and the one that goes to and fro once a cycle.

Cycle boundaries on a curve: between peaks and valleys in turn, where the second difference is nearest 0.

Source: spatio-temporal LTSA, sec. 3.1: the first and the third such point bound a cycle.

Denoising: points of a curve further than a threshold from the fitted one are pulled back to it.

Source: spatio-temporal LTSA, sec. 3.2 and its equation for the translation.

How long a cycle takes: the lag after which a movement is most like itself.

Five units of a cyclic movement: preparing, initial, cyclic, final, wind-up.

Source: spatio-temporal LTSA, sec. 3.1. Preparing lasts until the first difference of the curve changes
sharply; initial ends, and cyclic begins, where the second difference first is 0 (the first boundary of a cycle); cyclic
lasts until the last such place; final until the coordinates do not change any more; the rest is wind-up.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np

from emulator.segmenting.ltsa import Embedding, dimension, stltsa
from emulator.segmenting.synthesis import to_manifold

CYCLES_AROUND = 1.25
"""k, in cycles: frames of one cycle and a quarter before and after are looked at for neighbours. Within less than a
cycle the neighbours are only those next in time, and the first coordinate is time itself."""
FRAMES_A_CYCLE = 36
"""Slower cycles are thinned out to about so many frames before they are embedded; the others are mapped."""
COORDINATES = 3


@dataclass(frozen=True, eq=False)
class Curve:
    """coordinates (n, d) on the manifold, y (n,) that of a cycle, dimension intrinsic, gaps (7,) that it was read from.

    embedding : of every ``stride``-th frame
    """

    coordinates: np.ndarray
    y: np.ndarray
    dimension: int
    gaps: np.ndarray
    embedding: Embedding
    stride: int


def curve_of(points: np.ndarray, period: float | None, *, k: int | None = None) -> Curve:
    """Embed points (n, m) of a movement with ``period`` frames a cycle; without one, a third of it is looked at.

    k : neighbours of a frame, in frames that are left after thinning; None: CYCLES_AROUND cycles
    Raises ValueError as ``stltsa`` does.
    """
    n = len(points)
    cycle = n / 3 if period is None else period
    stride = max(1, round(cycle / FRAMES_A_CYCLE))
    thin = np.ascontiguousarray(points[::stride])
    near = k if k is not None else max(4, min(round(CYCLES_AROUND * cycle / stride), len(thin) - 2))
    if not 4 <= near < len(thin):
        raise ValueError(f"found k = {near} neighbours, expected 4 to {len(thin) - 1} of {len(thin)} frames")
    found, gaps = dimension(thin, near)
    embedding = stltsa(thin, near, COORDINATES)
    coordinates = embedding.coordinates
    if stride > 1:
        coordinates = to_manifold(embedding, points, np.arange(n) / stride)
    return Curve(coordinates, cyclic_coordinate(coordinates, period), found, gaps, embedding, stride)


def cyclic_coordinate(coordinates: np.ndarray, period: float | None) -> np.ndarray:
    """The direction (n,) in which the manifold is most like itself after a cycle and least after half a cycle.

    coordinates : (n, d); without a period the first coordinate is it
    """
    if period is None or round(period) >= len(coordinates) or period < 4:
        return coordinates[:, 0]
    centred = coordinates - coordinates.mean(axis=0)
    there = _after(centred, round(period)) - _after(centred, round(period / 2))
    here = centred.T @ centred / len(centred)
    turn = np.linalg.eigh(np.linalg.inv(_root(here)) @ there @ np.linalg.inv(_root(here)))[1]
    y = centred @ np.linalg.solve(_root(here), turn[:, -1])
    return np.asarray(y * np.sign(y[np.argmax(np.abs(y))]) / np.linalg.norm(y))


def _after(centred: np.ndarray, lag: int) -> np.ndarray:
    """Symmetric covariance of the coordinates with themselves ``lag`` frames later."""
    product = centred[:-lag].T @ centred[lag:] / (len(centred) - lag)
    return (product + product.T) / 2


def _root(matrix: np.ndarray) -> np.ndarray:
    values, vectors = np.linalg.eigh(matrix)
    return (vectors * np.sqrt(np.maximum(values, 1e-12 * values.max()))) @ vectors.T


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


def fitted_curve(y: np.ndarray, period: float, knots_a_cycle: float = 6.0) -> np.ndarray:
    """The least-squares cubic spline (n,) through a curve y (n,), with even knots."""
    from scipy.interpolate import make_lsq_spline

    n = len(y)
    pieces = int(np.clip(round(knots_a_cycle * n / period), 1, max(1, n // 2 - 3)))
    inner = np.linspace(0, n - 1, pieces + 1)[1:-1]
    knots = np.concatenate([np.zeros(4), inner, np.full(4, n - 1.0)])
    at = np.arange(n, dtype=float)
    return np.asarray(make_lsq_spline(at, y, knots, k=3)(at))


def denoised(y: np.ndarray, fitted: np.ndarray, threshold: float | None = None) -> tuple[np.ndarray, np.ndarray]:
    """The curve with noisy points translated towards the fitted one, and which these are, (n,) bool.

    threshold : points further from the fitted curve are noisy; None: twice the median distance
    Each is moved by the mean distance of all noisy points, as in the paper, but never past the fitted curve.
    """
    away = y - fitted
    far = np.abs(away)
    noisy = far > (2.0 * float(np.median(far)) if threshold is None else threshold)
    if not noisy.any():
        return y.copy(), noisy
    step = float(far[noisy].mean())
    moved = np.where(far > step, y - np.sign(away) * step, fitted)
    return np.where(noisy, moved, y), noisy


APART = 0.5
"""Before it comes back, a movement must have gone this far: 1 is as unlike as two frames at random."""
ALIKE = 0.6
"""Come back is nearer than this."""
AS_GOOD = 0.15
"""The first return that is as good as the best, but for this share of the way from the best to the worst."""
LONGEST_SHARE = 0.6
"""Of the take: there must be more than one cycle and a half to be sure of it."""


def unlikeness(points: np.ndarray) -> np.ndarray:
    """Mean squared distance of frames a lag apart, over twice the variance: 0 alike, 1 as two frames at random.

    points  : (n, m)
    returns : (L,) for lags 0 to LONGEST_SHARE n, by the fast Fourier transform
    """
    n = len(points)
    lags = np.arange(int(LONGEST_SHARE * n) + 1)
    centred = points - points.mean(axis=0)
    size = 1 << (2 * n - 1).bit_length()
    power = (np.abs(np.fft.rfft(centred, size, axis=0)) ** 2).sum(axis=1)
    products = np.fft.irfft(power, size)[lags]
    sums = np.concatenate([[0.0], np.cumsum(np.einsum("tm,tm->t", centred, centred))])
    whole = sums[n - lags] + sums[n] - sums[lags]
    return np.maximum(1.0 - 2.0 * products / np.maximum(whole, 1e-300), 0.0)


def period_frames(points: np.ndarray) -> int | None:
    """Frames a cycle, or None where the movement does not come back to itself."""
    unlike = unlikeness(points)
    dips = [
        lag
        for lag in range(2, len(unlike) - 1)
        if unlike[lag] <= unlike[lag - 1] and unlike[lag] < unlike[lag + 1] and unlike[:lag].max() > APART
    ]
    dips = [lag for lag in dips if unlike[lag] < ALIKE]
    if not dips:
        return None
    best = min(unlike[lag] for lag in dips)
    return next(lag for lag in dips if unlike[lag] <= best + AS_GOOD * (unlike.max() - best))


NAMES = ("preparing", "initial", "cyclic", "final", "wind-up")
SHARP = 0.15
"""Still is slower than this share of the curve's typical speed within the cyclic unit (root mean square)."""


@dataclass(frozen=True)
class Unit:
    """Frames ``start`` to ``stop``, the latter not within; of no length where a take has no such unit."""

    name: str
    start: int
    stop: int

    @property
    def n_frames(self) -> int:
        return self.stop - self.start


def units(found: Cycles) -> tuple[Unit, ...]:
    """The five units, in order, without gap, from frame 0 to the last. Raises ValueError where no cycle was found."""
    if len(found.start) == 0:
        raise ValueError("no cycle found: no units to tell apart")
    n = len(found.smooth)
    first, last = round(float(found.boundary[0])), round(float(found.boundary[-1]))
    first_difference = np.abs(np.gradient(found.smooth))
    still = first_difference < SHARP * float(np.sqrt(np.mean(first_difference[first : last + 1] ** 2)))
    moves = _until_it_moves(still[:first])
    rests = n - _until_it_moves(still[last:][::-1])
    edges = (0, moves, first, last, rests, n)
    return tuple(Unit(name, a, b) for name, a, b in zip(NAMES, edges, edges[1:]))


def _until_it_moves(still: np.ndarray) -> int:
    """Frames before the first two in a row that are not still; all of them where there are no such two."""
    moving = ~still
    both = np.flatnonzero(moving[:-1] & moving[1:])
    return int(both[0]) if len(both) else len(still)
