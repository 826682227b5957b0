"""MPCA: one set of directions in space and one in time, found in turn until they capture the most together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.reduce import components_of, wished

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

        Starts from each mode's own components. Not ``centred``, the mean course has to be captured too, as [000] sec.
        4.2 writes it, though not its source: that loses as much of UI-PRMD as SequentialPCA; centred, 3 to 16 % less.
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
