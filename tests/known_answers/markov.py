"""Shares of time of the states of a Markov chain, listed from one of them: an oracle without simulation."""

from collections.abc import Callable, Iterable
from typing import TypeVar

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve

S = TypeVar("S")
Moves = Callable[[S], Iterable[tuple[float, S]]]
"""Of a state: each rate with the state that it leads to."""


def shares_of_time(start: S, moves: Moves) -> dict[S, float]:
    """All states that can be reached from ``start``, which can be reached from all of them, and how long each lasts."""
    states, known = [start], {start: 0}
    flows: list[tuple[float, int, int]] = []
    for here, state in enumerate(states):
        for rate, after in moves(state):
            if after not in known:
                known[after] = len(states)
                states.append(after)
            flows += [(rate, known[after], here), (-rate, here, here)]
    values, to, origin = zip(*flows)
    balance = coo_array((values, (to, origin)), shape=(len(states), len(states))).tolil()
    balance[0, :] = 1.0
    share = spsolve(balance.tocsr(), np.eye(len(states))[0])
    return dict(zip(states, share.tolist()))
