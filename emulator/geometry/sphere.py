"""Products of unit spheres: exp, log, transport, distance, mean. Leading axes are the batch, the last is 3 long.

Source: Chen, Park & Srivastava, sec. 3.1, eq. 1-3, element by element. Angles by atan2, because arccos loses half the
digits near 0 and near pi (an angle of 1e-7 comes out 6 % wrong).
"""

from __future__ import annotations

import numpy as np

OPPOSITE_RAD = 1e-6
"""Nearer to pi than this, two points count as opposite: log and transport have no unique answer there."""


def normalise(vectors: np.ndarray) -> np.ndarray:
    """The vectors (..., 3) scaled to unit length. A zero vector becomes NaN."""
    return vectors / np.sqrt(np.einsum("...c,...c->...", vectors, vectors))[..., None]


def angle(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Arc between unit vectors p and q, both (..., 3): (...) radians in [0, pi]."""
    cosine = np.einsum("...c,...c->...", p, q)
    across = q - cosine[..., None] * p
    return np.arctan2(np.sqrt(np.einsum("...c,...c->...", across, across)), cosine)


def turned(vectors: np.ndarray, by: np.ndarray) -> np.ndarray:
    """Vectors (..., 3) turned about ``by`` (..., 3) by its length in radians (Rodrigues); by 0 the same bits."""
    angle = np.sqrt(np.einsum("...c,...c->...", by, by))[..., None]
    sine = np.sinc(angle / np.pi)
    bend = 0.5 * np.sinc(angle / (2 * np.pi)) ** 2
    across = _cross(by, vectors)
    return np.asarray(vectors + sine * across + bend * _cross(by, across))


def matrices(by: np.ndarray) -> np.ndarray:
    """(..., 3, 3) matrices that turn about ``by`` (..., 3) by its length in radians."""
    return np.ascontiguousarray(np.moveaxis(turned(np.eye(3), by[..., None, :]), -1, -2))


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The cross product of (..., 3); numpy's own takes twice the time."""
    (x, y, z), (u, v, w) = np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0)
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)


def distance(y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Distance of two postures (..., B, 3): the sum of their arcs, (...) radians.

    Source: Chen, Park & Srivastava eq. 1.
    """
    return angle(y, z).sum(-1)


def exp(base: np.ndarray, tangent: np.ndarray) -> np.ndarray:
    """The points reached from ``base`` along ``tangent``, both (..., 3), of unit length.

    Source: Chen, Park & Srivastava eq. 3.
    """
    length = np.sqrt(np.einsum("...c,...c->...", tangent, tangent))[..., None]
    return np.cos(length) * base + np.sinc(length / np.pi) * tangent


def log(base: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Tangent vectors at ``base`` that shoot to ``point``, both (..., 3); their length is the angle.

    Source: Chen, Park & Srivastava eq. 2.
    Raises ValueError where the points are opposite (the direction is then undefined).
    """
    cosine = np.einsum("...c,...c->...", base, point)
    across = point - cosine[..., None] * base
    sine = np.sqrt(np.einsum("...c,...c->...", across, across))
    _refuse_opposite("log", sine, cosine)
    return across * np.where(sine > 0, np.arctan2(sine, cosine) / np.where(sine > 0, sine, 1.0), 1.0)[..., None]


def log_coordinates(base: np.ndarray, point: np.ndarray, plane: np.ndarray | None = None) -> np.ndarray:
    """``log`` in the coordinates of ``plane`` (..., 2, 3), or of ``basis(base)``: points (..., 3) -> (..., 2).

    By half the work of ``log``; raises as it does.
    """
    plane = basis(base) if plane is None else plane
    cosine = np.einsum("...c,...c->...", point, base)
    x, y = (np.einsum("...c,...c->...", point, plane[..., k, :]) for k in (0, 1))
    sine = np.sqrt(x * x + y * y)
    _refuse_opposite("log", sine, cosine)
    ratio = np.where(sine > 0, np.arctan2(sine, cosine) / np.where(sine > 0, sine, 1.0), 1.0)
    return np.stack([ratio * x, ratio * y], axis=-1)


def transport(base: np.ndarray, target: np.ndarray, tangent: np.ndarray) -> np.ndarray:
    """``tangent`` (at ``base``) carried in parallel along the geodesic to ``target``, all (..., 3); lengths are kept.

    Source: Chen, Park & Srivastava sec. 3.1. Raises ValueError where base and target are opposite.
    """
    cosine = np.einsum("...c,...c->...", base, target)
    if np.any(cosine < -0.5):
        _refuse_opposite("transport", np.linalg.norm(target - cosine[..., None] * base, axis=-1), cosine)
    share = np.einsum("...c,...c->...", target, tangent) / (1.0 + cosine)
    return tangent - share[..., None] * (base + target)


def mean(points: np.ndarray, axis: int = 0, *, tolerance_rad: float = 1e-12, max_iterations: int = 200) -> np.ndarray:
    """Karcher mean over one axis of points (..., 3), sphere by sphere: (...) without that axis.

    The element-wise mean (root-sum-square metric), not the minimiser of the summed arcs of eq. 1 that eq. 6 asks for.
    By Newton's method: the mean of the logs alone halves the distance in a step, this squares it.
    Raises ValueError where points cancel out (no start) or lie opposite to the mean on the way.
    """
    points = np.moveaxis(np.asarray(points, float), axis, 0)
    start = points.mean(0)
    if np.any(np.einsum("...c,...c->...", start, start) < 1e-12):
        raise ValueError("mean: the points of a sphere cancel out; they have no unique mean direction")
    centre = normalise(start)
    for _ in range(max_iterations):
        step, full = _newton_step(centre, points)
        centre = normalise(exp(centre, step))
        length = np.sqrt(np.max(np.einsum("...c,...c->...", step, step)))
        if length < tolerance_rad or (full and length**2 < 0.01 * tolerance_rad):  # what is left is its square
            break
    return centre


def _newton_step(centre: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, bool]:
    """The tangent step (..., 3) at centre (..., 3) towards the Karcher mean of points (N, ..., 3); is it Newton's own?

    Half the squared arc to a point at angle t along the unit e has the Hessian e e' + t cot(t) (1 - e e'); the mean of
    these is the identity for near points, and kept above 0.1 for far ones, where the step would overshoot.
    Source: Pennec, Barycentric subspace analysis on manifolds (2018), appendix: Hessian of the squared distance.
    """
    plane = basis(centre)
    x, y = (np.einsum("n...c,...c->n...", points, plane[..., k, :]) for k in (0, 1))
    cosine = np.einsum("n...c,...c->n...", points, centre)
    sine = np.sqrt(x * x + y * y)
    _refuse_opposite("mean", sine, cosine)
    ratio = np.where(sine > 0, np.arctan2(sine, cosine) / np.where(sine > 0, sine, 1.0), 1.0)
    bend = np.where(sine > 1e-4, (1.0 - ratio * cosine) / np.maximum(sine, 1e-4) ** 2, 1.0 / 3.0)
    level, xx, xy, yy = (part.mean(0) for part in (ratio * cosine, bend * x * x, bend * x * y, bend * y * y))
    hessian = np.stack([np.stack([level + xx, xy], -1), np.stack([xy, level + yy], -1)], -2)
    values, vectors = np.linalg.eigh(hessian)
    gradient = np.stack([(ratio * x).mean(0), (ratio * y).mean(0)], -1)
    along = np.einsum("...ij,...i->...j", vectors, gradient) / np.maximum(values, 0.1)
    return np.einsum("...ij,...j,...ic->...c", vectors, along, plane), bool(np.all(values >= 0.1))


def basis(base: np.ndarray) -> np.ndarray:
    """An orthonormal basis of the tangent plane at ``base`` (..., 3): (..., 2, 3), the same for the same base."""
    helper = np.zeros_like(base)
    np.put_along_axis(helper, np.abs(base).argmin(-1)[..., None], 1.0, axis=-1)
    first = normalise(np.cross(base, helper))
    return np.stack([first, np.cross(base, first)], axis=-2)


def between(p: np.ndarray, q: np.ndarray, share: np.ndarray) -> np.ndarray:
    """The point at ``share`` (0: p, 1: q) of the geodesic from p to q (..., 3); share broadcasts against (...)."""
    return exp(p, np.asarray(share, float)[..., None] * log(p, q))


def _refuse_opposite(what: str, sine: np.ndarray, cosine: np.ndarray) -> None:
    opposite = (cosine < 0) & (sine < OPPOSITE_RAD)
    if np.any(opposite):
        where = tuple(int(i) for i in np.argwhere(np.atleast_1d(opposite))[0])
        raise ValueError(f"{what}: base and point are opposite at index {where}; no unique direction")
