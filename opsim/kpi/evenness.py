"""How evenly something is spread over people."""

from __future__ import annotations

import numpy as np


def gini(values: np.ndarray) -> float:
    """The Gini coefficient of what n people have: 0 where all have the same, 1 - 1/n where one has all of it.

    The mean difference of two of them (each with each, himself too) over twice the mean. nan values are of nobody; 0
    where nobody has anything, nan where there is nobody. Raises ValueError for what is below 0.
    Source: Gini 1912, Variabilita e mutabilita; Sen 1973, On Economic Inequality, eq. 2.8.2.
    """
    have = np.sort(np.asarray(values, float)[~np.isnan(values)])
    if not have.size:
        return np.nan
    if have[0] < 0:
        raise ValueError(f"nobody can have less than nothing, found {have[0]:g}")
    whole = have.sum()
    rank = 2 * np.arange(1, have.size + 1) - have.size - 1
    return max(0.0, float(rank @ have / (have.size * whole))) if whole > 0 else 0.0
