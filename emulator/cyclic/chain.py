"""A hidden Markov chain with Gaussian emissions that likes to stay where it is: states of motion found without labels.

Source: Rabiner (1989), expectation-maximisation and Viterbi; staying is favoured by a Dirichlet prior on the rows of
transitions (the sticky part), worth ``PRIOR`` transitions a state.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

ROUNDS = 100
PRIOR = 20.0
SETTLED = 1e-5
"""Gain of log likelihood a frame below which the search ends."""


@dataclass(frozen=True, eq=False)
class Chain:
    """``mean`` (S, f), ``covariance`` (S, f, f), ``start`` (S,), ``move`` (S, S) and the log likelihood reached."""

    mean: np.ndarray
    covariance: np.ndarray
    start: np.ndarray
    move: np.ndarray
    log_likelihood: float

    @classmethod
    def fit(cls, sequences: Sequence[np.ndarray], first: Sequence[np.ndarray], dwell_frames: float) -> Chain:
        """By expectation-maximisation from a first guess of each frame's state.

        sequences    : features (T, f) each;  first : states (T,) from 0
        dwell_frames : how long a state is thought to last before the data are asked
        Raises ValueError where a state of the guess has no frames.
        """
        n_states = int(max(one.max() for one in first)) + 1
        x, state = np.concatenate(list(sequences)), np.concatenate(list(first))
        if len(np.unique(state)) < n_states or n_states < 2:
            raise ValueError(f"found {len(np.unique(state))} states in the first guess, expected {max(n_states, 2)}")
        stay = 1 - 1 / dwell_frames
        expected = np.where(np.eye(n_states, dtype=bool), stay, (1 - stay) / (n_states - 1))
        share = np.eye(n_states)[state]
        chain = cls(*_moments(x, share, x), np.full(n_states, 1 / n_states), expected, -np.inf)
        for _ in range(ROUNDS):
            better = chain._round(sequences, PRIOR * expected)
            settled = better.log_likelihood - chain.log_likelihood < SETTLED * len(x)
            chain = better
            if settled:
                break
        return chain

    def _round(self, sequences: Sequence[np.ndarray], prior: np.ndarray) -> Chain:
        from emulator.kernels.chain import smoothed

        pairs, shares, total = prior.copy(), [], 0.0
        for x in sequences:
            share = np.empty((len(x), len(self.mean)))
            total += smoothed(self.log_emission(x), self.start, self.move, share, pairs)
            shares.append(share)
        start = np.mean([share[0] for share in shares], axis=0) + 1e-3
        x = np.concatenate(list(sequences))
        mean, covariance = _moments(x, np.concatenate(shares), x)
        return Chain(mean, covariance, start / start.sum(), pairs / pairs.sum(axis=1, keepdims=True), total)

    def log_emission(self, x: np.ndarray) -> np.ndarray:
        """(T, S) log densities of the features (T, f) in each state."""
        gap = x[:, None, :] - self.mean
        solved = np.linalg.solve(self.covariance, np.moveaxis(gap, 0, -1))
        square = np.einsum("tsf,sft->ts", gap, solved)
        _, volume = np.linalg.slogdet(self.covariance)
        return np.ascontiguousarray(-0.5 * (square + volume + x.shape[1] * np.log(2 * np.pi)))

    def path(self, x: np.ndarray) -> np.ndarray:
        """(T,) the likeliest sequence of states."""
        from emulator.kernels.chain import likeliest_path

        path = np.empty(len(x), dtype=np.int64)
        likeliest_path(self.log_emission(x), np.log(self.start), np.log(self.move), path)
        return path


def _moments(x: np.ndarray, share: np.ndarray, every: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means (S, f), covariances (S, f, f) under shares (T, S); a hundredth of the whole spread keeps them regular."""
    weight = share / share.sum(axis=0)
    mean = weight.T @ x
    gap = x[:, None, :] - mean
    covariance = np.einsum("ts,tsf,tsg->sfg", weight, gap, gap)
    return mean, covariance + 0.01 * np.diag(every.var(axis=0) + 1e-12)
