"""Horn's parallel analysis: how many components are larger than those of numbers without any structure."""

from __future__ import annotations

import numpy as np


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
