"""Flattening: posture sequences on a product of spheres <-> sequences in one flat space, forward and back.

A sequence of postures between its points: each bone along the geodesic from one posture to the next.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import factorial, sin

import numpy as np

from emulator.geometry import sphere
from emulator.geometry.base_points import base_points


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
    def n_bones(self) -> int:
        """B."""
        return len(self.reference)

    @property
    def n_channels(self) -> int:
        """Coordinates of a posture: two a bone."""
        return 2 * self.n_bones

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


@dataclass(frozen=True)
class Extrinsic:
    """The sphere in the room it lies in: a bone's unit vector is its three coordinates, and the way back is to unit
    length.

    No place of the sphere is far from another one as the tangent space of one posture has it: there the thigh of a
    squat or the hand of a throw, 2.5 rad from the mean, moves five times as fast as on the sphere, and what is added to
    it jerks. A mean of recordings here is their extrinsic mean.
    Source: Bhattacharya & Patrangenaru (2003), sec. 3; n_bones : B
    """

    n_bones: int

    @classmethod
    def fit(cls, directions: np.ndarray) -> Extrinsic:
        """The map for directions (..., B, 3); it depends on nothing else of them."""
        return cls(directions.shape[-2])

    @property
    def n_channels(self) -> int:
        """Coordinates of a posture: three a bone."""
        return 3 * self.n_bones

    def forward(self, directions: np.ndarray) -> np.ndarray:
        """Directions (..., B, 3) -> coordinates (..., 3B)."""
        return directions.reshape(*directions.shape[:-2], self.n_channels)

    def inverse(self, coordinates: np.ndarray) -> np.ndarray:
        """Coordinates (..., 3B) -> directions (..., B, 3). Vectors shorter than 1e-9 stay as short."""
        vectors = coordinates.reshape(*coordinates.shape[:-1], self.n_bones, 3)
        length = np.sqrt(np.einsum("...c,...c->...", vectors, vectors))[..., None]
        return np.asarray(vectors / np.maximum(length, SHORTEST))


Flattening = SIEM | Extrinsic
SHORTEST = 1e-9

LARGEST_STEP_RAD = 0.3
"""The series hold to 1e-13 for bones that turn less than this between two points of a sequence."""
LARGEST_CHORD_SQUARE = 4 * sin(LARGEST_STEP_RAD / 2) ** 2


def along(sequence: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Postures (S, B, 3) of a sequence (T, B, 3) at places (S,) in cells, from 0 to T - 1.

    By series where no bone turns more than 0.3 rad in a cell that is used, else by ``along_numpy``.
    Raises ValueError where two successive postures are opposite.
    """
    from emulator.kernels.sphere import along as fill

    n_times, n_bones = sequence.shape[:2]
    points = np.ascontiguousarray(sequence, dtype=float).reshape(n_times, 3 * n_bones)
    out = np.empty((len(place), 3 * n_bones))
    if fill(points, place, series(), LARGEST_CHORD_SQUARE, np.empty((2, 8)), out):
        return along_numpy(sequence, place)
    return out.reshape(-1, n_bones, 3)


def resample(directions: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Postures (S, B, 3) of a sequence (T, B, 3), uniform over [0, 1], at the moments ``at`` (S,), along geodesics.

    Raises ValueError where two successive postures are opposite.
    """
    directions = np.asarray(directions, float)
    return along(directions, np.clip(np.asarray(at, float), 0.0, 1.0) * (len(directions) - 1))


def along_numpy(sequence: np.ndarray, place: np.ndarray) -> np.ndarray:
    """The same as ``along`` without compiled code: the definition."""
    low = np.minimum(place.astype(int), len(sequence) - 2)
    return sphere.between(sequence[low], sequence[low + 1], (place - low)[:, None])


@lru_cache(maxsize=1)
def series() -> np.ndarray:
    """(7, 2) factors a, b: sin(u d) / sin(d) = sum of c_i chord^2i with c_0 = u and c_i = c_(i-1) (a_i u^2 + b_i)."""
    i = np.arange(1.0, 8.0)
    return np.stack([-0.5 / (i * (2 * i + 1)), 0.5 * i / (2 * i + 1)], axis=1)


@lru_cache(maxsize=1)
def inverse_sine() -> np.ndarray:
    """(8,) coefficients of angle / sin(angle) in the squared chord."""
    return np.array([factorial(n) ** 2 / factorial(2 * n + 1) for n in range(8)])
