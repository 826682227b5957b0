"""Waits in queues with one server, and autoregressions, many at once and without a model."""

import numpy as np


def mm1_waits(load, n, seed):
    """(n,) waits of the customers of an M/M/1 queue that begins empty; one arrival a unit of time.

    Lindley's recursion W' = max(0, W + service - interarrival), as the distance of a walk from its least value so far.
    """
    rng = np.random.default_rng(seed)
    steps = np.r_[0.0, np.cumsum(rng.exponential(load, n - 1) - rng.exponential(1.0, n - 1))]
    return steps - np.minimum.accumulate(steps)


def naive_waits(service, interarrival):
    """The same, step by step: wait of customer i + 1 from service i and the time until i + 1 arrives."""
    waits = [0.0]
    for s, a in zip(service, interarrival):
        waits.append(max(0.0, waits[-1] + s - a))
    return waits


def autoregressions(phi, n, how_many, seed):
    """(how_many, n) stationary AR(1) series of mean 0 and unit innovations."""
    from scipy.signal import lfilter

    rng = np.random.default_rng(seed)
    first = rng.normal(0, 1 / np.sqrt(1 - phi**2), (how_many, 1))
    made, _ = lfilter([1.0], [1.0, -phi], rng.normal(size=(how_many, n)), axis=1, zi=phi * first)
    return made


def variance_of_mean(phi, n):
    """Of the mean of n values of such a series: (1 + 2 sum (1 - k/n) phi^k) / (1 - phi^2) / n."""
    k = np.arange(1, n)
    return (1 + 2 * np.sum((1 - k / n) * phi**k)) / (1 - phi**2) / n
