"""The latent space of poses: principal components of unit directions, and the way back to unit directions.

Source: Remillard & Kry (2010), sec. 2 (z = f(q), three components kept 90 % of the variation). Beyond the paper: q is
unit directions instead of joint angles (Chen, Park & Srivastava, sec. 3.1), and the root's travel and height are
foretold from z, linearly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator.cyclic.pose import Poses

TRAVEL_WEIGHT = 1e-3
"""So little that travel and height do not form the components: their loadings are then their regression on z.

With a weight of 0.3 they did, and where a pause ends the latent jumped: pauses were kept worse, walking no better.
"""


@dataclass(frozen=True, eq=False)
class PoseLatent:
    """z (..., d) = (q - mean) basis / scale, with q (..., D) a pose laid flat; columns of ``basis`` are orthonormal."""

    mean: np.ndarray
    basis: np.ndarray
    scale: float
    energy: np.ndarray
    """(D,) share of the variance that the first 1, 2, ... components keep."""

    @classmethod
    def fit(cls, sequences: Sequence[Poses], *, components: int | float = 0.9) -> PoseLatent:
        """Principal components of all frames together: a number of them, or as many as keep this share of the energy.

        Raises ValueError for a share outside (0, 1], a number beyond what there is, and poses that never change.
        """
        q = np.concatenate([flattened(poses) for poses in sequences])
        mean = q.mean(axis=0)
        _, spread, rows = np.linalg.svd(q - mean, full_matrices=False)
        if spread[0] <= 1e-9 * np.sqrt(len(q)):
            raise ValueError("the poses never change; there is no motion to model")
        energy = np.minimum(np.cumsum(spread**2) / np.sum(spread**2), 1.0)
        kept = _number(components, energy)
        signs = np.sign(rows[np.arange(kept), np.abs(rows[:kept]).argmax(axis=1)])
        return cls(mean, (rows[:kept] * signs[:, None]).T, float(spread[0] / np.sqrt(len(q))), energy)

    @property
    def n_components(self) -> int:
        return int(self.basis.shape[1])

    def forward(self, poses: Poses) -> np.ndarray:
        """(..., T, d) latents, in spreads of the first component."""
        return (flattened(poses) - self.mean) @ self.basis / self.scale

    def inverse(self, z: np.ndarray) -> Poses:
        """The poses of latents (..., T, d), their directions of unit length again."""
        return unflattened(self.flat(z))

    def flat(self, z: np.ndarray) -> np.ndarray:
        """(..., T, D) the poses of latents laid flat, see ``flattened``, their directions not yet of unit length."""
        return np.asarray(np.asarray(z, float) @ (self.basis.T * self.scale) + self.mean)

    def first(self, components: int) -> PoseLatent:
        """The same space with its first components only."""
        return PoseLatent(self.mean, self.basis[:, :components], self.scale, self.energy)

    def arrays(self) -> dict[str, np.ndarray]:
        """What a file keeps of it."""
        return {"mean": self.mean, "basis": self.basis, "scale": np.array(self.scale), "energy": self.energy}

    @classmethod
    def from_arrays(cls, arrays: dict[str, np.ndarray]) -> PoseLatent:
        return cls(arrays["mean"], arrays["basis"], float(arrays["scale"]), arrays["energy"])


def flattened(poses: Poses) -> np.ndarray:
    """(..., T, D) with D = 3 B + 4: directions, then travel and height with little weight."""
    lead = poses.directions.shape[:-2]
    beside = np.concatenate([poses.travel, poses.height[..., None]], axis=-1)
    return np.concatenate([poses.directions.reshape(*lead, -1), TRAVEL_WEIGHT * beside], axis=-1)


def unflattened(q: np.ndarray) -> Poses:
    """The way back, with directions made unit again."""
    directions = q[..., :-4].reshape(*q.shape[:-1], -1, 3)
    length = np.linalg.norm(directions, axis=-1, keepdims=True)
    return Poses(directions / np.maximum(length, 1e-12), q[..., -4:-1] / TRAVEL_WEIGHT, q[..., -1] / TRAVEL_WEIGHT)


def _number(components: int | float, energy: np.ndarray) -> int:
    if isinstance(components, float) and not 0 < components <= 1:
        raise ValueError(f"a share of the energy lies in (0, 1], found {components:g}")
    if isinstance(components, float):
        return int(np.searchsorted(energy, components - 1e-12) + 1)
    if not 1 <= components <= len(energy):
        raise ValueError(f"between 1 and {len(energy)} components are possible, found {components}")
    return int(components)
