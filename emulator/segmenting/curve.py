"""The curve that cycles are read from: coordinates of the manifold, and the one that goes to and fro once a cycle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.segmenting.dimension import dimension
from emulator.segmenting.mapping import to_manifold
from emulator.segmenting.stltsa import Embedding, stltsa

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
