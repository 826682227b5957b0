"""SIEM: every posture by one inverse exponential map, to the tangent space of a reference posture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator import sphere
from emulator.schemes.frames import along, vectors


@dataclass(frozen=True)
class SIEM:
    """The single inverse exponential map; its start (n, 0) says nothing, since nothing is lost.

    reference : (B, 3) one posture for all times, or (T, B, 3) one for each
    plane     : (..., B, 2, 3) orthonormal tangent frames at the reference, smooth in time
    Source: Chen, Park & Srivastava, definition 3.
    """

    reference: np.ndarray
    plane: np.ndarray

    @classmethod
    def fit(cls, directions: np.ndarray) -> SIEM:
        """At the Karcher mean of all postures of directions (N, T, B, 3), from which no posture lies far."""
        return cls._at(sphere.mean(directions.reshape(-1, *directions.shape[-2:])))

    @classmethod
    def fit_first(cls, directions: np.ndarray) -> SIEM:
        """At the mean first posture. Late postures may come near the opposite point, where the map has no inverse."""
        return cls._at(sphere.mean(directions[:, 0]))

    @classmethod
    def fit_moving(cls, directions: np.ndarray) -> SIEM:
        """At the mean posture of each time (eq. 6, element by element), the frame carried along in parallel."""
        course = sphere.mean(directions)
        return cls(course, along(course[None], sphere.basis(course[0]))[0])

    @classmethod
    def _at(cls, reference: np.ndarray) -> SIEM:
        return cls(reference, sphere.basis(reference))

    def forward(self, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Directions (..., T, B, 3) -> tangent coordinates (..., T, 2B), radians, and no start (..., 0).

        Raises ValueError where a bone points opposite to its reference, or times do not fit a moving reference.
        """
        if self.reference.ndim == 3 and directions.shape[-3] != len(self.reference):
            raise ValueError(f"SIEM: found {directions.shape[-3]} times, the moving mean has {len(self.reference)}")
        pairs = sphere.log_coordinates(self.reference, directions, self.plane)
        return pairs.reshape(*pairs.shape[:-2], -1), np.zeros((*directions.shape[:-3], 0))

    def inverse(self, flat: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Tangent coordinates (..., T, 2B) -> directions (..., T, B, 3); ``start`` is not looked at."""
        tangent = vectors(flat, self.plane)
        return sphere.exp(np.broadcast_to(self.reference, tangent.shape), tangent)
