"""Dimension reduction: JointPCA, space and time in one; SequentialPCA, space first and time after, as in the paper."""

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


@dataclass(frozen=True)
class SequentialPCA:
    """Coefficients of sequences by spatial PCA of their postures, then functional PCA of each spatial score.

    mean          : (C,) mean posture over sequences and times; spatial : (d1, C) components, rows orthonormal
    temporal_mean : (d1, T) mean course of each spatial score; temporal : (d1, d2, T), orthonormal for each score
    Source: Chen, Park & Srivastava sec. 4.2.
    """

    mean: np.ndarray
    spatial: np.ndarray
    temporal_mean: np.ndarray
    temporal: np.ndarray

    @property
    def n_components(self) -> int:
        """Numbers that say one sequence: d1 d2."""
        return self.temporal.shape[0] * self.temporal.shape[1]

    @classmethod
    def fit(cls, sequences: np.ndarray, d1: int | float = 10, d2: int | float = 30) -> SequentialPCA:
        """Fit to sequences (N, T, C); d1 and d2 are numbers, or shares of the variance in (0, 1).

        A share for d2 takes as many functions as the spatial score that needs most of them.
        Raises ValueError for a number below 1, not whole, or beyond what the sequences can span.
        """
        postures = sequences.reshape(-1, sequences.shape[-1])
        mean = postures.mean(axis=0)
        values, vectors = components_of(postures - mean)
        spatial = vectors[: wished("d1", d1, values)]
        scores = np.moveaxis((sequences - mean) @ spatial.T, -1, 0)
        temporal_mean = scores.mean(axis=1)
        functions = [components_of(courses - middle) for courses, middle in zip(scores, temporal_mean)]
        count = max(wished("d2", d2, values) for values, _ in functions)
        fewest = min(len(values) for values, _ in functions)
        if count > fewest:
            raise ValueError(f"d2: found {count}, but a spatial score spans only {fewest} functions of time")
        return cls(mean, spatial, temporal_mean, np.stack([vectors[:count] for _, vectors in functions]))

    def forward(self, sequences: np.ndarray) -> np.ndarray:
        """Sequences (..., T, C) -> coefficients (..., d1 d2)."""
        scores = np.moveaxis((sequences - self.mean) @ self.spatial.T, -1, -2) - self.temporal_mean
        return np.einsum("...it,ijt->...ij", scores, self.temporal).reshape(*scores.shape[:-2], self.n_components)

    def inverse(self, coefficients: np.ndarray) -> np.ndarray:
        """Coefficients (..., d1 d2) -> sequences (..., T, C)."""
        pairs = coefficients.reshape(*coefficients.shape[:-1], *self.temporal.shape[:2])
        scores = self.temporal_mean + np.einsum("...ij,ijt->...it", pairs, self.temporal, optimize=True)
        return self.mean + np.moveaxis(scores, -1, -2) @ self.spatial


def components_of(centred: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positive eigenvalues (R,) and components (R, P) of centred rows (N, P), by the smaller of the two products."""
    by_rows = len(centred) < centred.shape[1]
    values, vectors = np.linalg.eigh(centred @ centred.T if by_rows else centred.T @ centred)
    values, vectors = values[::-1], vectors[:, ::-1]
    rank = int(np.sum(values > max(values[0] * 1e-12, 1e-24)))
    values = values[:rank]
    basis = (vectors[:, :rank] / np.sqrt(values)).T @ centred if by_rows else vectors[:, :rank].T
    return values, _signed(basis)


def wished(name: str, wish: int | float, values: np.ndarray) -> int:
    """How many components ``wish`` means, given the positive eigenvalues; ``name`` is what an error calls it."""
    try:
        return _count(wish, values, len(values))
    except ValueError as why:
        raise ValueError(str(why).replace("n_components", name)) from None


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
