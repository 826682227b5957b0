"""Flattening: posture sequences on a product of spheres <-> sequences in one flat space, forward and back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator import sphere
from emulator.alignable import base_points


@dataclass(frozen=True)
class SIEM:
    """Single inverse exponential map: every posture to the tangent space of one reference posture.

    reference : (B, 3) unit vectors; the element-wise Karcher mean of all training postures, so that no posture
    comes near the opposite point, where the map has no inverse; where one does, a point beside the mean.
    Source: Chen, Park & Srivastava, definition 3; see ``alignable.base_points``.
    """

    reference: np.ndarray

    @classmethod
    def fit(cls, directions: np.ndarray) -> SIEM:
        """The map at the base points of directions (..., B, 3)."""
        return cls(base_points(directions)[1])

    @property
    def n_channels(self) -> int:
        """Coordinates of a posture: two a bone."""
        return 2 * len(self.reference)

    def forward(self, directions: np.ndarray) -> np.ndarray:
        """Directions (..., B, 3) -> tangent coordinates (..., 2B), radians.

        Raises ValueError where a bone points opposite to its reference.
        """
        return sphere.log_coordinates(self.reference, directions).reshape(*directions.shape[:-2], self.n_channels)

    def inverse(self, coordinates: np.ndarray) -> np.ndarray:
        """Tangent coordinates (..., 2B) -> directions (..., B, 3)."""
        pairs = coordinates.reshape(*coordinates.shape[:-1], len(self.reference), 2)
        plane = sphere.basis(self.reference)
        tangent = pairs[..., :1] * plane[:, 0] + pairs[..., 1:] * plane[:, 1]  # einsum: the same bits, 2.5 times slower
        return sphere.exp(np.broadcast_to(self.reference, tangent.shape), tangent)
