"""How the spread of a task's times splits between workers and within each.

A task has mean m and cv c over the population. A worker's own factor F is lognormal with mean 1 and log variance
``share * ln(1 + c^2)``; his times are F times a time of the task's family with mean m and the cv given here.
Then mean and cv over the population are exactly m and c, since (1 + cv_F^2)(1 + cv_within^2) = 1 + c^2.
For the lognormal family ln(1 + c^2) is the variance of log time, so the share is the share of that variance.
"""

from __future__ import annotations

from math import expm1, log1p, sqrt


def log_variance(cv: float) -> float:
    """Variance of the log of a lognormal time with this cv."""
    return log1p(cv * cv)


def within_cv(cv: float, between_share: float) -> float:
    """cv of a single worker's times where ``between_share`` of ``log_variance(cv)`` lies between workers."""
    if between_share == 0:
        return cv
    return sqrt(expm1((1 - between_share) * log_variance(cv)))
