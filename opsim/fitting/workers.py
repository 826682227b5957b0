"""How much of the spread lies between workers, from times with the name of who took them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def between_share(times_s: np.ndarray, workers: Sequence[str]) -> float:
    """The share of the variance of log time that lies between workers, by analysis of variance; 0 at least.

    With W workers of n_w times: within = MSW, between = (MSB - MSW) / n0, n0 = (N - sum n_w^2 / N) / (W - 1).
    Raises ValueError for fewer than two workers, or where nobody has two times.
    Source: Searle, Casella & McCulloch, Variance Components (1992), section 3.6.
    """
    logs, names = np.log(np.asarray(times_s, dtype=float)), np.asarray(workers)
    groups = [logs[names == name] for name in dict.fromkeys(workers)]
    n, n_workers = logs.size, len(groups)
    if n_workers < 2 or n <= n_workers:
        raise ValueError("two workers at least, and two times of one of them, are needed to tell how far they differ")
    within = sum(float(((group - group.mean()) ** 2).sum()) for group in groups) / (n - n_workers)
    among = sum(group.size * float((group.mean() - logs.mean()) ** 2) for group in groups) / (n_workers - 1)
    n0 = (n - sum(group.size**2 for group in groups) / n) / (n_workers - 1)
    between = max(0.0, (among - within) / n0)
    return between / (between + within) if between + within > 0 else 0.0
