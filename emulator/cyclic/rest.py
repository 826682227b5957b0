"""The finer part of a posture, beyond the components that the dynamics move: foretold from these and the speed.

Source: a Gaussian process from latents to poses, as in the dynamical models of Wang, Fleet & Hertzmann (2008).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator.cyclic.hyper import Hyper, kernel


@dataclass(frozen=True, eq=False)
class Finer:
    """Mean of y (n, r) at inputs x (n, p): kernel(x, points / length) @ weight; exact sums of its M points.

    points (M, p), length (p,), weight (M, r), mean (r,)
    """

    points: np.ndarray
    length: np.ndarray
    weight: np.ndarray
    mean: np.ndarray

    @classmethod
    def fit(cls, x: Sequence[np.ndarray], y: Sequence[np.ndarray], at_most: int = 220) -> Finer:
        """From all frames of the takes, seen through evenly thinned points, which alone give the hyper-parameters."""
        from emulator.cyclic.gp import GaussianProcess

        inputs, outputs = np.concatenate(list(x)), np.concatenate(list(y))
        mean = outputs.mean(axis=0)
        few = np.unique(np.linspace(0, len(inputs) - 1, at_most).round().astype(int))
        hyper = GaussianProcess.fit(inputs[few], outputs[few] - mean).hyper
        points = inputs[few]
        across = kernel(points, inputs, hyper)
        inner = hyper.noise**2 * kernel(points, points, hyper) + across @ across.T
        inner.flat[:: len(points) + 1] += 1e-8 * np.trace(inner) / len(points)
        weight = np.linalg.solve(inner, across @ (outputs - mean)) * hyper.signal**2
        return cls(points, hyper.length, weight, mean)

    @property
    def n_outputs(self) -> int:
        return len(self.mean)

    def at(self, x: np.ndarray) -> np.ndarray:
        """(m, r) at x (m, p)."""
        if self.n_outputs == 0:
            return np.zeros((len(x), 0))
        return np.asarray(kernel(x, self.points, Hyper(self.length, 1.0, 1.0)) @ self.weight + self.mean)


def nothing_finer(n_inputs: int) -> Finer:
    """Where the dynamics move all components."""
    return Finer(np.zeros((0, n_inputs)), np.ones(n_inputs), np.zeros((0, 0)), np.zeros(0))
