"""Workers of a cyclic task: how each moves, steps and is built; a new one is a blend of the recorded ones."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np


@dataclass(frozen=True, eq=False)
class CyclicWorker:
    """One worker, or n of them. z (..., d): where the worker's latents lie beside everybody's; log_step (...): own step
    at a speed over the usual (log), or own time of a cycle; bone_length_m (..., B); pace: as fast as asked of the body.
    """

    z: np.ndarray
    log_step: np.ndarray
    bone_length_m: np.ndarray
    name: str = ""
    pace: float = 1.0


@dataclass(frozen=True, eq=False)
class Crew:
    """The W recorded workers: offsets (W, d) of latents, log_step (W,), bone_length_m (W, B)."""

    names: tuple[str, ...]
    offsets: np.ndarray
    log_step: np.ndarray
    bone_length_m: np.ndarray

    def known(self, task: str, name: str) -> CyclicWorker:
        """A recorded worker. Raises ValueError for an unknown name, with the nearest."""
        if name not in self.names:
            near = get_close_matches(str(name), self.names, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(self.names)}"
            raise ValueError(f"{task}: no worker {name!r}; {hint}")
        i = self.names.index(name)
        return CyclicWorker(self.offsets[i], self.log_step[i], self.bone_length_m[i], name)

    def drawn(self, n: int, rng: np.random.Generator) -> CyclicWorker:
        """n new workers: a Gaussian with the recorded workers' mean and covariance, all of it in one draw."""
        weight = rng.standard_normal((n, len(self.names))) / np.sqrt(max(len(self.names) - 1, 1))
        return self.blended(weight)

    @property
    def typical(self) -> CyclicWorker:
        """The mean of the recorded workers."""
        one = self.blended(np.zeros((1, len(self.names))))
        return CyclicWorker(one.z[0], one.log_step[0], one.bone_length_m[0])

    def blended(self, weight: np.ndarray) -> CyclicWorker:
        """n workers at the mean plus ``weight`` (n, W) times each recorded one's deviation from it."""
        mean = self.offsets.mean(axis=0), self.log_step.mean(), np.log(self.bone_length_m).mean(axis=0)
        return CyclicWorker(
            mean[0] + weight @ (self.offsets - mean[0]),
            mean[1] + weight @ (self.log_step - mean[1]),
            np.exp(mean[2] + weight @ (np.log(self.bone_length_m) - mean[2])),
        )
