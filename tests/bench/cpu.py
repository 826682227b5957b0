"""Times to compare: CPU of this process, interleaved, best of several, since machines are shared."""

from time import process_time

import numpy as np
from threadpoolctl import threadpool_limits


def best_s(*works, rounds=5):
    """The least CPU seconds of each work (all threads), one after the other in every round, after one to warm up."""
    taken = [[] for _ in works]
    with threadpool_limits(1, user_api="blas"):
        for _ in range(rounds + 1):
            for work, column in zip(works, taken):
                start = process_time()
                work()
                column.append(process_time() - start)
    return [min(column[1:]) for column in taken]


def multiply_adds_per_s(size=384):
    """What one core gives at its best: multiply-adds a second of a matrix product in float64."""
    one, other = np.random.default_rng(0).normal(size=(2, size, size))
    return size**3 / best_s(lambda: one @ other, rounds=40)[0]
