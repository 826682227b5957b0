"""The two-level simulation: as many sequences as one likes from a known law, to try schemes on.

Level one: a simple scheme is fitted to the recordings and draws a thousand sequences, the truth from here on, dealt out
for training and testing. Level two: each scheme is fitted to the training, and its draws are held against the test.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from emulator.judge.disco import disco
from emulator.judge.distance import distances
from emulator.judge.energy import energy_u, pooled
from emulator.judge.likelihood import qq_points
from emulator.judge.streams import stream


class FittedScheme(Protocol):
    """What a scheme must do: draw sequences (n, T, B, 3), and say how likely sequences are, (n, T, B, 3) -> (n,)."""

    def sample(self, n: int, rng: np.random.Generator, /) -> np.ndarray: ...

    def log_likelihood(self, sequences: np.ndarray, /) -> np.ndarray: ...


Fit = Callable[[str, np.ndarray], FittedScheme]


@dataclass(frozen=True, eq=False)
class TwoLevelRow:
    """One scheme at level two.

    p, energy  : DISCO of its draws against the test; energy distance as U-statistic
    qq         : (P, 2) quantiles of the log-likelihoods of test and draws under the law of level one
    """

    level_one: str
    level_two: str
    p: float
    energy: float
    qq: np.ndarray


def two_level(
    sequences: np.ndarray,
    level_one: str,
    level_two: Iterable[str],
    fit: Fit,
    *,
    seed: int = 0,
    n_train: int = 800,
    n_test: int = 200,
    n_drawn: int = 200,
    n_permutations: int = 999,
) -> list[TwoLevelRow]:
    """A row for each name in ``level_two``, from aligned sequences (N, T, B, 3).

    fit : ``fit(name, sequences)`` gives a fitted scheme
    Likelihoods are those of level one, which is the true law here. A scheme's row does not depend on the other schemes.
    Source: Chen, Park & Srivastava sec. 5.3, table 3, figure 19 (there 60 sequences, 1,000 drawn, 800/200).
    """
    truth = fit(level_one, sequences)
    known = truth.sample(n_train + n_test, stream(seed, "level one", level_one))
    train, test = known[:n_train], known[n_train:]
    among_test, likely = distances(test), truth.log_likelihood(test)
    rows = []
    for name in level_two:
        drawn = fit(name, train).sample(n_drawn, stream(seed, "level two", level_one, name))
        parts = distances(drawn, test), distances(drawn), among_test
        tested = disco(pooled(*parts), n_drawn, stream(seed, "permutations", level_one, name), n_permutations)
        qq = qq_points(likely, truth.log_likelihood(drawn))
        rows.append(TwoLevelRow(level_one, name, tested.p, energy_u(*parts), qq))
    return rows
