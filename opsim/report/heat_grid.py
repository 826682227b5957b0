"""Time spent on a floor, spread over a grid: nothing of it is lost, however much it is smoothed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, hypot

import numpy as np

Point = tuple[float, float]


@dataclass(frozen=True)
class Grid:
    """Even cells over a floor. left_m, top_m : its corner; cell_m : wide and high of a cell; shape : rows, columns.

    Rows go from the top down.
    """

    left_m: float
    top_m: float
    cell_m: float
    shape: tuple[int, int]

    def cells(self, points: np.ndarray) -> np.ndarray:
        """(n,) flat numbers of the cells in which points (n, 2) in metres lie; beyond the edge those at it."""
        columns = np.clip(((points[:, 0] - self.left_m) / self.cell_m).astype(int), 0, self.shape[1] - 1)
        rows = np.clip(((self.top_m - points[:, 1]) / self.cell_m).astype(int), 0, self.shape[0] - 1)
        return rows * self.shape[1] + columns


def spread(grid: Grid, lines: Sequence[tuple[Sequence[Point], float]], sigma_m: float) -> np.ndarray:
    """(rows, columns) of some quantity by cell. lines : corners of a line, or one point, and how much lies on it

    It lies evenly along its line, and is smoothed by a bell of this standard deviation, which ends at the floor's edge.
    """
    held = np.zeros(grid.shape[0] * grid.shape[1])
    for corners, amount in lines:
        cells = grid.cells(_along(corners, grid.cell_m))
        held += np.bincount(cells, minlength=held.size) * (amount / cells.size)
    down, across = (_bell(n, sigma_m / grid.cell_m) for n in grid.shape)
    return np.asarray(down @ held.reshape(grid.shape) @ across.T)


def _along(corners: Sequence[Point], step_m: float) -> np.ndarray:
    """(n, 2) points at about even distances along a line: the middles of its steps; of one point that point."""
    pieces = [_piece(a, b, step_m) for a, b in pairwise(corners) if a != b]
    return np.concatenate(pieces) if pieces else np.array([corners[0]], dtype=float)


def _piece(a: Point, b: Point, step_m: float) -> np.ndarray:
    n = ceil(hypot(b[0] - a[0], b[1] - a[1]) / step_m)
    part = (np.arange(n) + 0.5)[:, None] / n
    return np.array(a) + (np.array(b) - np.array(a)) * part


def _bell(n: int, sigma: float) -> np.ndarray:
    """(n, n) how much of each cell (column) comes to each other one (row); columns sum to 1."""
    apart = np.arange(n)[:, None] - np.arange(n)[None]
    share = np.exp(-0.5 * (apart / max(sigma, 1e-6)) ** 2)
    return share / share.sum(axis=0)
