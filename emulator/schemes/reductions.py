"""MPCA: one set of directions in space and one in time, found in turn until they capture the most together.

Horn's parallel analysis: how many components are larger than those of numbers without any structure.

Reductions of flattened sequences (n, T', C) by name, each with ``forward``, ``inverse`` and ``dims``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from emulator.model.reduction import JointPCA, SequentialPCA, components_of, wished

TOLERANCE, MOST_ROUNDS = 1e-10, 100


@dataclass(frozen=True)
class MPCA:
    """Coefficients Z = U' (X - mean) V of sequences X, d1 in space by d2 in time.

    mean : (T, C); spatial : (d1, C) and temporal : (d2, T), rows orthonormal
    captured : sum of squares of the training coefficients; n_rounds : alternations until it stood still
    Source: Lu, Plataniotis & Venetsanopoulos (2008), algorithm of table 1; Chen, Park & Srivastava sec. 4.2.
    """

    mean: np.ndarray
    spatial: np.ndarray
    temporal: np.ndarray
    captured: float
    n_rounds: int

    @property
    def dims(self) -> tuple[int, int]:
        return len(self.spatial), len(self.temporal)

    @classmethod
    def fit(cls, sequences: np.ndarray, d1: int | float = 10, d2: int | float = 30, *, centred: bool = True) -> MPCA:
        """Fit to sequences (N, T, C); d1 and d2 are numbers, or shares of each mode's own variance in (0, 1).

        Starts from each mode's own components. Not ``centred``, the mean course has to be captured too, as the paper's
        sec. 4.2 writes it, not its source: that loses as much of UI-PRMD as SequentialPCA; centred, 3 to 16 % less.
        Raises ValueError for a number beyond what a mode spans.
        """
        mean = sequences.mean(axis=0) if centred else np.zeros(sequences.shape[1:])
        in_space = sequences - mean
        in_time = np.swapaxes(in_space, 1, 2)
        values, spatial = components_of(in_space.reshape(-1, in_space.shape[2]))
        spatial = spatial[: wished("d1", d1, values)]
        values, temporal = components_of(in_time.reshape(-1, in_time.shape[2]))
        n_functions, captured, n_rounds = wished("d2", d2, values), 0.0, 0
        while n_rounds < MOST_ROUNDS:
            n_rounds += 1
            temporal = _leading(np.swapaxes(in_space @ spatial.T, 1, 2), n_functions)
            spatial = _leading(temporal @ in_space, len(spatial))
            now = float(np.sum((temporal @ in_space @ spatial.T) ** 2))
            if now - captured <= TOLERANCE * now:
                break
            captured = now
        return cls(mean, spatial, temporal, now, n_rounds)

    def forward(self, sequences: np.ndarray) -> np.ndarray:
        """Sequences (..., T, C) -> coefficients (..., d1 d2), time running fastest."""
        pairs = self.spatial @ np.swapaxes(self.temporal @ (sequences - self.mean), -1, -2)
        return np.asarray(pairs.reshape(*pairs.shape[:-2], -1))

    def inverse(self, coefficients: np.ndarray) -> np.ndarray:
        """Coefficients (..., d1 d2) -> sequences (..., T, C)."""
        pairs = coefficients.reshape(*coefficients.shape[:-1], *self.dims)
        return np.asarray(self.mean + self.temporal.T @ np.swapaxes(pairs, -1, -2) @ self.spatial)


def _leading(rows: np.ndarray, count: int) -> np.ndarray:
    """(count, P) leading components of rows (..., P) about zero."""
    components = components_of(rows.reshape(-1, rows.shape[-1]))[1]
    if count > len(components):
        raise ValueError(
            f"MPCA: found {count} components of one mode, but with the other only {len(components)} are left"
        )
    return components[:count]


def parallel_analysis(
    rows: np.ndarray, rng: np.random.Generator, *, quantile: float = 0.95, n_simulated: int = 50
) -> int:
    """The number of leading components of standardised rows (N, P) that noise does not reach.

    An eigenvalue counts while it is above the ``quantile`` of the same eigenvalue of standard normal numbers (N, P).
    Columns without variance do not count. With P far above N all noise eigenvalues are nearly P / (N - 1), the mean.
    Raises ValueError for fewer than 3 rows. Source: Horn (1965); the quantile by Glorfeld (1995).
    """
    if len(rows) < 3:
        raise ValueError(f"parallel analysis: found {len(rows)} rows, expected at least 3")
    spread = rows.std(axis=0)
    varying = rows[:, spread > 1e-12 * max(spread.max(initial=0.0), 1e-300)]
    noise = [_eigenvalues(rng.standard_normal(varying.shape)) for _ in range(n_simulated)]
    larger = _eigenvalues(varying) > np.quantile(noise, quantile, axis=0)
    return int(np.argmin(np.append(larger, False)))


def _eigenvalues(rows: np.ndarray) -> np.ndarray:
    """(min(N, P),) eigenvalues of the correlation matrix, largest first, by the smaller product."""
    centred = rows - rows.mean(axis=0)
    scaled = centred / np.linalg.norm(centred, axis=0)
    product = scaled @ scaled.T if len(scaled) < scaled.shape[1] else scaled.T @ scaled
    return np.linalg.eigvalsh(product)[::-1]


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
