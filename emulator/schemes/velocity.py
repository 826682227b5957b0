"""Transported velocity fields: shooting vectors from posture to posture, carried to one reference posture.

``start`` of all three are the tangent coordinates (..., 2B) of alpha(0) at the reference: only with it a field says one
sequence. A field is in radians per step, its integral in radians (the paper's less a factor 1 / (T - 1), a unit).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from emulator import sphere
from emulator.schemes.frames import along, carried, coordinates, vectors


@dataclass(frozen=True)
class _Field:
    """A field at ``reference`` (B, 3), the Karcher mean of all training postures."""

    reference: np.ndarray

    @classmethod
    def fit(cls, directions: np.ndarray) -> Self:
        """At the mean posture of directions (N, T, B, 3)."""
        return cls(sphere.mean(directions.reshape(-1, *directions.shape[-2:])))

    def _start(self, directions: np.ndarray) -> np.ndarray:
        pairs = sphere.log_coordinates(self.reference, directions[..., 0, :, :])
        return pairs.reshape(*pairs.shape[:-2], -1)

    def _first(self, start: np.ndarray) -> np.ndarray:
        tangent = vectors(start, sphere.basis(self.reference))
        return sphere.exp(np.broadcast_to(self.reference, tangent.shape), tangent)


@dataclass(frozen=True)
class STVF(_Field):
    """Single-hop: each shooting vector goes to the reference posture along the geodesic from where it starts.

    Source: Chen, Park & Srivastava, definition 1.
    """

    def forward(self, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Directions (..., T, B, 3) -> field (..., T - 1, 2B) and start (..., 2B).

        Raises ValueError where a posture is opposite to the next one or to the reference.
        """
        here = directions[..., :-1, :, :]
        shooting = sphere.log(here, directions[..., 1:, :, :])
        at_reference = sphere.transport(here, np.broadcast_to(self.reference, here.shape), shooting)
        return coordinates(at_reference, sphere.basis(self.reference)), self._start(directions)

    def inverse(self, flat: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Field (..., T - 1, 2B) and start (..., 2B) -> directions (..., T, B, 3), step by step."""
        steps = np.moveaxis(vectors(flat, sphere.basis(self.reference)), -3, 0)
        path = [self._first(start)]
        reference = np.broadcast_to(self.reference, path[0].shape)
        for step in steps:
            path.append(sphere.exp(path[-1], sphere.transport(reference, path[-1], step)))
        return np.stack(path, axis=-3)


@dataclass(frozen=True)
class ISTVF(STVF):
    """The running sum of the single-hop field: positions, smooth where velocities are sparse and noisy.

    Source: Chen, Park & Srivastava, definition 2.
    """

    def forward(self, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Directions (..., T, B, 3) -> integrated field (..., T - 1, 2B) and start (..., 2B). Raises as ``STVF``."""
        field, start = super().forward(directions)
        return np.cumsum(field, axis=-2), start

    def inverse(self, flat: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Integrated field (..., T - 1, 2B) and start (..., 2B) -> directions (..., T, B, 3)."""
        return super().inverse(np.diff(flat, axis=-2, prepend=0.0), start)


@dataclass(frozen=True)
class MTVF(_Field):
    """Multi-hop: each shooting vector goes back through all earlier postures to alpha(0), and then to the reference.

    Carrying a frame from the reference along the sequence and taking coordinates in it is the same, hop for hop, by T
    hops in place of T (T + 1) / 2. Source: Chen, Park & Srivastava sec. 4.1; Zhang et al. (2015); Deng et al. (2021).
    """

    def forward(self, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Directions (..., T, B, 3) -> field (..., T - 1, 2B) and start (..., 2B). Raises as ``STVF``."""
        sequences = directions.reshape(-1, *directions.shape[-3:])
        shooting = sphere.log(sequences[:, :-1], sequences[:, 1:])
        field = coordinates(shooting, along(sequences[:, :-1], self._frame(sequences[:, 0])))
        return field.reshape(*directions.shape[:-3], *field.shape[1:]), self._start(directions)

    def inverse(self, flat: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Field (..., T - 1, 2B) and start (..., 2B) -> directions (..., T, B, 3), hops through what is rebuilt."""
        path = [self._first(start)]
        frame = self._frame(path[0])
        for step in np.moveaxis(flat, -2, 0):
            path.append(sphere.exp(path[-1], vectors(step, frame)))
            frame = carried(frame, path[-2], path[-1])
        return np.stack(path, axis=-3)

    def inverse_by_one_hop(self, flat: np.ndarray, start: np.ndarray) -> np.ndarray:
        """The same by one hop from the reference to each posture, as the paper prints it for S-TVF: no inverse of this.

        Kept to show figure 5: the two ways to the reference turn a vector by the area between them, and the error
        grows along the sequence to tenths of a radian. By the hops themselves it stays at 1e-14, even with arccos.
        """
        return STVF(self.reference).inverse(flat, start)

    def _frame(self, first: np.ndarray) -> np.ndarray:
        plane = sphere.basis(self.reference)
        return carried(plane, np.broadcast_to(self.reference, first.shape), first)
