"""Warps: gamma (..., T) on the uniform common clock, from gamma(0) = 0 to gamma(1) = 1, strictly increasing.

A warp says at which share of a performance's own time the common clock's moment s comes. Their statistics live
in two coordinate systems: the Hilbert sphere of sqrt(gamma') for the mean, the centred log ratio of gamma' for models.

Marks (sub-task ends) on the common clock, as unbounded coordinates that keep them in order and inside (0, 1).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from emulator.geometry.flattening import resample


def check(gamma: np.ndarray) -> np.ndarray:
    """The warps (..., T) as floats. Raises ValueError where one does not run from 0 to 1, strictly increasing."""
    gamma = np.asarray(gamma, float)
    if gamma.shape[-1] < 2 or not np.all(np.isfinite(gamma)):
        raise ValueError("warp: needs two finite values or more")
    if np.abs(gamma[..., 0]).max() > 1e-9 or np.abs(gamma[..., -1] - 1).max() > 1e-9:
        raise ValueError("warp: must run from 0 to 1")
    if np.diff(gamma, axis=-1).min() <= 0:
        raise ValueError("warp: must increase strictly")
    return gamma


def evaluate(gamma: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Each warp (..., T) at common moments (..., S) or (S,) in [0, 1]: (..., S), piecewise linear."""
    cells = gamma.shape[-1] - 1
    place = np.clip(np.asarray(at, float), 0.0, 1.0) * cells
    low = np.minimum(place.astype(int), cells - 1)
    low = np.broadcast_to(low, (*gamma.shape[:-1], low.shape[-1]))
    left, right = np.take_along_axis(gamma, low, -1), np.take_along_axis(gamma, low + 1, -1)
    return left + (right - left) * (place - low)


def compose(outer: np.ndarray, inner: np.ndarray) -> np.ndarray:
    """outer(inner(s)) on inner's clock; (..., T) both, or one batch against a single warp."""
    shape = np.broadcast_shapes(outer.shape[:-1], inner.shape[:-1])
    return evaluate(np.broadcast_to(outer, (*shape, outer.shape[-1])), inner)


def invert(gamma: np.ndarray) -> np.ndarray:
    """The inverse warps, on the same uniform clock: (..., T)."""
    clock = np.linspace(0.0, 1.0, gamma.shape[-1])
    flat = [np.interp(clock, row, clock) for row in gamma.reshape(-1, gamma.shape[-1])]
    return np.array(flat).reshape(gamma.shape)


def apply(gamma: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """The sequence (T', B, 3), uniform in its own time, at the moments of one warp (T,): (T, B, 3), along geodesics."""
    return resample(directions, gamma)


def clr(gamma: np.ndarray, n_knots: int = 20) -> np.ndarray:
    """Centred log ratio (..., K) of the mean slopes on K equal cells: log slope minus its mean; sums to 0.

    Coarser than the warp on purpose: the slopes of dynamic programming are quantised, by 15 % on 300 cells, 8 % on 15.
    Raises ValueError where a warp stands still over a whole cell.
    """
    rise = np.diff(evaluate(np.asarray(gamma, float), np.linspace(0.0, 1.0, n_knots + 1)), axis=-1)
    if np.any(rise <= 0):
        raise ValueError("clr: a warp must increase strictly")
    ratio = np.log(rise)
    return ratio - ratio.mean(-1, keepdims=True)


def from_clr(x: np.ndarray, n_times: int = 101) -> np.ndarray:
    """The warps (..., T) whose log slope is, up to a constant, the cubic spline with control points x (..., K).

    The points lie in the middles of K equal cells, and the outermost go on beyond the ends. A spline does not go
    through its control points: the slopes are those of ``clr`` a little smoothed. So a warp has three derivatives, and
    a posture under another's pace does not jerk where the cells meet.
    """
    level = np.zeros((*np.shape(x)[:-1], n_times))
    slope = np.matmul(np.asarray(x, float), _spline_table(np.shape(x)[-1], n_times))
    np.exp(slope, out=slope)
    np.cumsum(slope, axis=-1, out=level[..., 1:])
    level /= level[..., -1:].copy()
    return level


def from_clr_at(x: np.ndarray, at: np.ndarray) -> np.ndarray:
    """``evaluate(from_clr(x), at)`` on a clock as fine as one likes: (N, E), control points (N, K), moments (N, E).

    Where a few moments are asked: on 301 points the sums are 1e-5 from the integrals, and take six times as long.
    """
    from emulator.kernels.warping import spline_warps_at

    share = np.empty(at.shape)
    spline_warps_at(np.ascontiguousarray(x), at, share)
    return share


@lru_cache(maxsize=16)
def _spline_table(n_knots: int, n_times: int) -> np.ndarray:
    """(K, T - 1) weights of the control points in the middles of the clock's cells."""
    place = (np.arange(n_times - 1) + 0.5) / (n_times - 1) * n_knots - 0.5
    cell = np.floor(place).astype(int)
    u = place - cell
    weights = (1.0 - u) ** 3, 3.0 * u**3 - 6.0 * u**2 + 4.0, 3.0 * (1.0 - u) ** 3 - 6.0 * (1.0 - u) ** 2 + 4.0, u**3
    table = np.zeros((n_knots, n_times - 1))
    for step, weight in zip((-1, 0, 1, 2), weights):
        np.add.at(table, (np.clip(cell + step, 0, n_knots - 1), np.arange(n_times - 1)), weight / 6.0)
    return table


def through(x: np.ndarray) -> np.ndarray:
    """Control points (..., K) of the spline that goes through x (..., K) in the middles of the cells.

    Libraries of before have the slopes themselves, with a monotone cubic through the knots.
    """
    n_knots = np.shape(x)[-1]
    at = np.zeros((n_knots, n_knots))
    for step, weight in ((-1, 1 / 6), (0, 4 / 6), (1, 1 / 6)):
        np.add.at(at, (np.clip(np.arange(n_knots) + step, 0, n_knots - 1), np.arange(n_knots)), weight)
    return np.asarray(x @ np.linalg.inv(at))


def mean(gammas: np.ndarray, *, max_iterations: int = 50) -> np.ndarray:
    """Karcher mean (T,) of warps (N, T) on the Hilbert sphere of sqrt(gamma')."""
    cells = gammas.shape[-1] - 1
    psi = np.sqrt(np.maximum(np.diff(gammas, axis=-1), 0.0))  # unit vectors: their squares sum to 1
    centre = psi.mean(0) / np.linalg.norm(psi.mean(0))
    for _ in range(max_iterations):
        cosine = np.clip(psi @ centre, -1.0, 1.0)
        across = psi - cosine[:, None] * centre
        sine = np.linalg.norm(across, axis=-1)
        step = (across * np.where(sine > 1e-15, np.arctan2(sine, cosine) / np.maximum(sine, 1e-15), 0.0)[:, None]).mean(
            0
        )
        length = np.linalg.norm(step)
        if length < 1e-13:
            break
        centre = np.cos(length) * centre + np.sin(length) * step / length
        centre /= np.linalg.norm(centre)
    gamma = np.concatenate([[0.0], np.cumsum(np.maximum(centre, 1e-6 / cells) ** 2)])
    return gamma / gamma[-1]


def centre(gammas: np.ndarray) -> np.ndarray:
    """The warps (N, T) composed with the inverse of their mean, so that their mean is the identity."""
    return compose(gammas, invert(mean(gammas)))


SMALLEST_GAP = 1e-3


def clock_to_coordinates(mark_clock: np.ndarray) -> np.ndarray:
    """Additive log ratios of the gaps between marks: (N, E) in (0, 1), increasing -> (N, E).

    Gaps below 1e-3 of the performance are raised to it, since a mark on the very start or end has no log ratio.
    Source: Aitchison's additive log ratio; the last gap (last mark to the end) is the divisor.
    """
    n = len(mark_clock)
    edges = np.concatenate([np.zeros((n, 1)), mark_clock, np.ones((n, 1))], axis=1)
    gaps = np.maximum(np.diff(edges, axis=1), SMALLEST_GAP)
    return np.log(gaps[:, :-1] / gaps[:, -1:])


def coordinates_to_clock(coordinates: np.ndarray) -> np.ndarray:
    """The way back: (N, E) -> (N, E), increasing along E and strictly inside (0, 1)."""
    edges = np.ones((len(coordinates), coordinates.shape[1] + 1))
    np.exp(np.minimum(np.maximum(coordinates, -12.0), 12.0), out=edges[:, :-1])  # beyond, a gap is lost to rounding
    for e in range(1, edges.shape[1]):  # running sums of the gaps: a few columns are quicker one by one
        edges[:, e] += edges[:, e - 1]
    return np.asarray(edges[:, :-1] / edges[:, -1:])
