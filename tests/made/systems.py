"""Made systems with known means: normal, each with numbers of its own, or sharing some of their luck."""

import numpy as np

from opsim.study.select import Observe, each


def normal_systems(means, sds, *key: int, shared: float = 0.0, n: int = 4000) -> Observe:
    """means, sds : (k,) or (k, m). shared : the share of the variance that all systems have in common."""
    means, sds = (np.asarray(of, dtype=float).reshape(len(means), -1) for of in (means, sds))
    drawn: dict[int, np.ndarray] = {}

    def luck(system: int) -> np.ndarray:
        if system not in drawn:
            drawn[system] = np.random.default_rng([*key, system + 1]).normal(size=(n, means.shape[1]))
        return drawn[system]

    def observed(system: int, first: int, upto: int) -> np.ndarray:
        own = luck(system)[first:upto]
        both = own if not shared else np.sqrt(1 - shared) * own + np.sqrt(shared) * luck(-1)[first:upto]
        return means[system] + sds[system] * both

    return each(observed)


def slippage(k: int = 10, by: float = 1.0) -> np.ndarray:
    """(k,) means of which the fourth is better by so much: the hardest case that a promise covers."""
    means = np.zeros(k)
    means[3] = by
    return means
