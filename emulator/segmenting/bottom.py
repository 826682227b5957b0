"""The eigenvectors to the smallest eigenvalues of an alignment matrix, the constant one left out.

The constant vector is known to be in the null space; it is taken out by projection, and the rest found by Lanczos'
method on the inverse, (B + shift)^-1, from one banded or sparse factorisation: O(n) in the number of frames.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

SHIFT = 1e-13
"""Of the largest diagonal entry; makes the matrix positive definite where it is singular up to rounding."""
SMALL = 120
"""Up to so many frames all eigenvectors are taken at once."""

Solve = Callable[[np.ndarray], np.ndarray]


def bottom_banded(bands: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """``count`` smallest eigenvalues (count,) above the constant's and their vectors (n, count), of a banded matrix."""
    from scipy.linalg import cho_solve_banded, cholesky_banded

    n = bands.shape[1]
    if n <= max(SMALL, 3 * (count + 1)):
        return _dense(_full(bands), count)
    factor = _factor(lambda shifted: cholesky_banded(shifted, lower=True), bands, bands[0].max())
    return _lanczos(lambda x: cho_solve_banded((factor, True), x), lambda x: _times(bands, x), n, count)


def bottom_sparse(matrix: Any, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The same of a sparse symmetric matrix."""
    from scipy.sparse import eye_array
    from scipy.sparse.linalg import splu

    n = matrix.shape[0]
    if n <= max(SMALL, 3 * (count + 1)):
        return _dense(matrix.toarray(), count)
    shifted = (matrix + SHIFT * matrix.diagonal().max() * eye_array(n)).tocsc()
    factor = splu(shifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return _lanczos(factor.solve, lambda x: matrix @ x, n, count)


def _factor(cholesky: Callable[[np.ndarray], np.ndarray], bands: np.ndarray, largest: float) -> np.ndarray:
    """The Cholesky factor with the least shift that is enough, from SHIFT upwards."""
    for power in range(6):
        shifted = bands.copy()
        shifted[0] += SHIFT * 10.0**power * largest
        try:
            return cholesky(shifted)
        except np.linalg.LinAlgError:
            continue
    raise ValueError("segmenting: the alignment matrix is not positive semidefinite; are all points finite?")


def _lanczos(solve: Solve, times: Solve, n: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    from scipy.sparse.linalg import LinearOperator, eigsh

    def inverse(x: np.ndarray) -> np.ndarray:
        found = solve(_centred(np.ravel(x)))
        return _centred(found)

    start = _centred(np.random.default_rng(0).normal(size=n))  # a fixed start: the same answer every time
    operator = LinearOperator((n, n), matvec=inverse, dtype=float)
    _, vectors = eigsh(operator, k=count, which="LA", v0=start, ncv=min(n - 1, 2 * count + 20))
    return _ordered(vectors, lambda x: times(x))


def _ordered(vectors: np.ndarray, times: Solve) -> tuple[np.ndarray, np.ndarray]:
    """Rayleigh's quotients and the vectors in their order: the inverse's own values have lost digits to the shift."""
    image = np.column_stack([times(column) for column in vectors.T])
    small = vectors.T @ image
    values, turn = np.linalg.eigh((small + small.T) / 2)
    return np.maximum(values, 0.0), vectors @ turn


def _dense(matrix: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """All at once; the constant is moved to the far end of the spectrum."""
    n = len(matrix)
    raised = matrix + np.full((n, n), 2.0 * np.trace(matrix) / n)
    values, vectors = np.linalg.eigh(raised)
    return np.maximum(values[:count], 0.0), vectors[:, :count]


def _full(bands: np.ndarray) -> np.ndarray:
    n = bands.shape[1]
    full = np.zeros((n, n))
    for lag, band in enumerate(bands[:n]):
        at = np.arange(n - lag)
        full[at + lag, at] = full[at, at + lag] = band[: n - lag]
    return full


def _times(bands: np.ndarray, x: np.ndarray) -> np.ndarray:
    """The banded matrix times a vector."""
    found = bands[0] * x
    for lag in range(1, len(bands)):
        band = bands[lag, : len(x) - lag]
        found[lag:] += band * x[:-lag]
        found[:-lag] += band * x[lag:]
    return found


def _centred(x: np.ndarray) -> np.ndarray:
    return x - x.mean()
