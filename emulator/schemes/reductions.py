"""Reductions of flattened sequences (n, T', C) by name, each with ``forward``, ``inverse`` and ``dims``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from emulator.reduce import JointPCA, SequentialPCA, components_of, wished
from emulator.schemes.mpca import MPCA
from emulator.schemes.parallel import parallel_analysis

PAPER_DIMS = (10, 30)
"""Source: Chen, Park & Srivastava sec. 5.1."""


class Reduction(Protocol):
    """Flattened sequences to fewer numbers and back; ``dims`` says how many."""

    @property
    def dims(self) -> tuple[int, ...]: ...
    def forward(self, sequences: np.ndarray) -> np.ndarray: ...
    def inverse(self, coefficients: np.ndarray) -> np.ndarray: ...


@dataclass(frozen=True)
class SpaceTimePCA:
    """``JointPCA`` of sequences (..., T, C) taken as one long vector: coefficients (..., K)."""

    pca: JointPCA
    shape: tuple[int, int]

    @property
    def dims(self) -> tuple[int, ...]:
        return (self.pca.n_components,)

    def forward(self, sequences: np.ndarray) -> np.ndarray:
        return self.pca.forward(sequences.reshape(*sequences.shape[:-2], -1))

    def inverse(self, coefficients: np.ndarray) -> np.ndarray:
        return self.pca.inverse(coefficients).reshape(*coefficients.shape[:-1], *self.shape)


@dataclass(frozen=True)
class SpatialPCA:
    """Only space: scores (..., T, d1) for a time-series model. mean : (C,); basis : (d1, C), rows orthonormal."""

    mean: np.ndarray
    basis: np.ndarray

    @property
    def dims(self) -> tuple[int, ...]:
        return (len(self.basis),)

    @classmethod
    def fit(cls, sequences: np.ndarray, d1: int | float = PAPER_DIMS[0]) -> SpatialPCA:
        """Fit to the postures of sequences (N, T, C); d1 is a number, or a share of the variance in (0, 1)."""
        postures = sequences.reshape(-1, sequences.shape[-1])
        mean = postures.mean(axis=0)
        values, basis = components_of(postures - mean)
        return cls(mean, basis[: wished("d1", d1, values)])

    def forward(self, sequences: np.ndarray) -> np.ndarray:
        return np.asarray((sequences - self.mean) @ self.basis.T)

    def inverse(self, coefficients: np.ndarray) -> np.ndarray:
        return np.asarray(self.mean + coefficients @ self.basis)


@dataclass(frozen=True)
class Unreduced:
    """Every number is kept, as by the pointwise path."""

    dims: tuple[int, ...] = ()

    def forward(self, sequences: np.ndarray) -> np.ndarray:
        return sequences

    def inverse(self, coefficients: np.ndarray) -> np.ndarray:
        return coefficients


@dataclass(frozen=True)
class SpaceThenTime:
    """``SequentialPCA`` that says its ``dims``."""

    pca: SequentialPCA

    @property
    def dims(self) -> tuple[int, ...]:
        return self.pca.temporal.shape[:2]

    def forward(self, sequences: np.ndarray) -> np.ndarray:
        return self.pca.forward(sequences)

    def inverse(self, coefficients: np.ndarray) -> np.ndarray:
        return self.pca.inverse(coefficients)


def fitted(name: str, flat: np.ndarray, dims: Any, rng: np.random.Generator) -> Reduction:
    """The reduction ``name`` of flattened sequences (N, T', C).

    dims : for SequentialPCA and MPCA two numbers or shares of variance, None for the paper's 10 and 30 as far as N
           sequences span them; for JointPCA one, None for a share of 0.98, "parallel" for Horn's number; for
           SpatialPCA one (of two the first), None for 10.
    Raises ValueError for dims that do not fit the reduction, or beyond what the sequences span.
    """
    if name in ("SequentialPCA", "MPCA"):
        d1, d2 = _two(name, dims, flat)
        return SpaceThenTime(SequentialPCA.fit(flat, d1, d2)) if name == "SequentialPCA" else MPCA.fit(flat, d1, d2)
    if name == "JointPCA":
        rows = flat.reshape(len(flat), -1)
        count = max(parallel_analysis(rows, rng), 1) if isinstance(dims, str) and dims == "parallel" else dims
        return SpaceTimePCA(JointPCA.fit(rows, _one(name, count)), flat.shape[1:])
    if name == "SpatialPCA":
        first = dims[0] if isinstance(dims, (tuple, list)) and len(dims) == 2 else dims
        return SpatialPCA.fit(flat, spanned(flat, *PAPER_DIMS)[0] if first is None else _one(name, first))
    if dims not in (None, ()):
        raise ValueError(f"dims: found {dims!r}, but {name} keeps every number; expected None")
    return Unreduced()


def spanned(flat: np.ndarray, d1: int, d2: int) -> tuple[int, int]:
    """The most components of space and, for each of their scores, of time that (N, T', C) span, up to d1 and d2."""
    centred = flat - flat.mean(axis=(0, 1))
    values, spatial = components_of(centred.reshape(-1, flat.shape[2]))
    scores = np.moveaxis(centred @ spatial[:d1].T, -1, 0)
    functions = [len(components_of(courses - courses.mean(axis=0))[0]) for courses in scores]
    return min(d1, len(values)), min([d2, *functions])


def _two(name: str, dims: Any, flat: np.ndarray) -> tuple[float, float]:
    if dims is None:
        return spanned(flat, *PAPER_DIMS)
    if not isinstance(dims, (tuple, list)) or len(dims) != 2 or not all(_is_number(d) for d in dims):
        raise ValueError(f"dims: found {dims!r}, expected two for {name}: components of space and of time")
    return dims[0], dims[1]


def _one(name: str, dims: Any) -> Any:
    only = dims[0] if isinstance(dims, (tuple, list)) and len(dims) == 1 else dims
    if only is not None and not _is_number(only):
        raise ValueError(f"dims: found {dims!r}, expected one number or share of variance for {name}")
    return only


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)
