"""Dimension reduction: JointPCA, one principal component analysis of space and time together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

DEFAULT_EXPLAINED = 0.98


@dataclass(frozen=True)
class JointPCA:
    """Coefficients of flattened sequences on common space-time components.

    mean  : (P,) mean sequence, P = T * channels
    basis : (K, P) components, rows orthonormal up to storage rounding
    explained_variance : share of the training variance that the K components carry
    Source: Chen, Park & Srivastava sec. 4.2, with one joint PCA in place of two in sequence.
    """

    mean: np.ndarray
    basis: np.ndarray
    explained_variance: float

    @property
    def n_components(self) -> int:
        return len(self.basis)

    @classmethod
    def fit(
        cls, sequences: np.ndarray, n_components: int | float | None = None, largest: int | None = None
    ) -> JointPCA:
        """Fit to sequences (N, P); ``n_components`` is a number, a share of variance in (0, 1), or None for 0.98.

        The singular vectors come from the (N, N) product, since N is far smaller than P.
        Raises ValueError when the number asked for is below 1, not whole, or beyond what N sequences can span.
        """
        mean = sequences.mean(axis=0)
        centred = sequences - mean
        values, vectors = np.linalg.eigh(centred @ centred.T)
        values, vectors = np.maximum(values[::-1], 0.0), vectors[:, ::-1]
        rank = int(np.sum(values > max(values[0] * 1e-12, 1e-24))) if len(values) else 0
        count = min(_count(n_components, values[:rank], rank), largest if largest is not None else rank)
        basis = (vectors[:, :count] / np.sqrt(values[:count])).T @ centred
        total = values.sum()
        return cls(mean, _signed(basis), float(values[:count].sum() / total) if total > 0 else 1.0)

    def forward(self, sequences: np.ndarray) -> np.ndarray:
        """Sequences (..., P) -> coefficients (..., K)."""
        return (sequences - self.mean) @ self.basis.T

    def inverse(self, coefficients: np.ndarray) -> np.ndarray:
        """Coefficients (..., K) -> sequences (..., P)."""
        return self.mean + coefficients @ self.basis


def _count(wish: int | float | None, values: np.ndarray, rank: int) -> int:
    """How many components the wish means, given the positive eigenvalues."""
    wish = DEFAULT_EXPLAINED if wish is None else wish
    if 0 < wish < 1:
        return int(np.searchsorted(np.cumsum(values) / values.sum(), wish) + 1) if rank else 0
    if wish != int(wish) or wish < 1:
        raise ValueError(f"n_components: found {wish}, expected a whole number from 1 or a share of variance in (0, 1)")
    if wish > rank:
        raise ValueError(f"n_components: found {wish}, but the sequences span only {rank} components")
    return int(wish)


def _signed(basis: np.ndarray) -> np.ndarray:
    """Components with their largest entry positive, so that two machines agree on the sign."""
    if len(basis) == 0:
        return basis
    largest = np.take_along_axis(basis, np.abs(basis).argmax(axis=1)[:, None], axis=1)
    return basis * np.where(largest < 0, -1.0, 1.0)
