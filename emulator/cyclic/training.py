"""What switching dynamics are trained on: steps of sequences, thinned, and what of a step is foretold."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from emulator.cyclic.gp import THINNED, GaussianProcess

FEWEST = 8
"""A state needs so many steps to be modelled."""


def target(x: np.ndarray, after: np.ndarray, keeps: bool) -> np.ndarray:
    """What a process foretells: the increment of z or the next z; x (n, p) begins with z (n, d)."""
    return after - x[:, : after.shape[1]] if keeps else after


def keeps_of(
    x: np.ndarray, after: np.ndarray, chosen: Sequence[np.ndarray]
) -> tuple[bool, tuple[GaussianProcess, ...]]:
    """Whether increments are likelier than next values, asked of THINNED points a state; all processes, best first."""
    few = [thinned(at, THINNED) for at in chosen]
    tried = [[GaussianProcess.fit(x[at], target(x[at], after[at], keeps)) for at in few] for keeps in (True, False)]
    by_increment, by_next = (sum(one.log_likelihood for one in processes) for processes in tried)
    keeps = by_increment >= by_next
    return keeps, (*tried[not keeps], *tried[keeps])


def thinned(numbers: np.ndarray, at_most: int) -> np.ndarray:
    """At most ``at_most`` of the numbers, evenly."""
    return numbers[np.unique(np.linspace(0, len(numbers) - 1, at_most).round().astype(int))]


def check(sequences: Sequence[np.ndarray], states: Sequence[np.ndarray], controls: Sequence[np.ndarray]) -> None:
    """Raises ValueError with all that is wrong."""
    lengths = [(len(z), len(state), len(c)) for z, state, c in zip(sequences, states, controls)]
    wrong = [
        f"sequence {i}: {a} latents, {b} states, {c} controls" for i, (a, b, c) in enumerate(lengths) if not a == b == c
    ]
    if not len(sequences) == len(states) == len(controls) or not sequences:
        wrong.append(f"found {len(sequences)} sequences, {len(states)} rows of states, {len(controls)} of controls")
    if not wrong:
        every = np.concatenate([one[:-1] for one in states])
        few = {int(one): int(np.sum(every == one)) for one in np.unique(every) if np.sum(every == one) < FEWEST}
        wrong = [f"state {one} has {n} steps, {FEWEST} are needed; merge it with a neighbour" for one, n in few.items()]
    if wrong:
        raise ValueError("; ".join(wrong))
