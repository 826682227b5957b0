"""The paper's representations: postures (n, T, B, 3) on one clock as flat vectors, and back; and PWI, a law of its own.

PWI: at each time a Gaussian in the tangent space of that time's mean posture.

SIEM: every posture by one inverse exponential map, to the tangent space of a reference posture.

Transported velocity fields: shooting vectors from posture to posture, carried to one reference posture.

``start`` of all three are the tangent coordinates (..., 2B) of alpha(0) at the reference: only with it a field says one
sequence. A field is in radians per step, its integral in radians (the paper's less a factor 1 / (T - 1), a unit).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from emulator.geometry import sphere
from emulator.model.gaussian import LowRankNormal


@dataclass(frozen=True)
class Pointwise:
    """Tangent coordinates at time t are mean_t + z_t rows_t, with z_t (N,) standard normal.

    mean : (T, C); rows : (N, T, C) training deviations over sqrt(N - 1), so that rows_t' rows_t is the covariance
    shared : one z for all times, which makes draws as smooth as the training; else one for each, as in the paper
    Source: Chen, Park & Srivastava sec. 4.3.3, eq. 6, its covariance (there over N);
    its mean posture is that of ``SIEM.fit_moving``.
    """

    mean: np.ndarray
    rows: np.ndarray
    shared: bool

    @classmethod
    def fit(cls, coordinates: np.ndarray, shared: bool) -> Pointwise:
        """Fit to coordinates (N, T, C) at the moving mean."""
        mean = coordinates.mean(axis=0)
        return cls(mean, (coordinates - mean) / np.sqrt(len(coordinates) - 1), shared)

    def sample(
        self, n: int, rng: np.random.Generator, *, allow_unstable: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """n coordinates (n, T, C), and no start (n, 0)."""
        n_rows, n_times = self.rows.shape[:2]
        if self.shared:
            drawn = np.tensordot(rng.standard_normal((n, n_rows)), self.rows, 1)
        else:
            drawn = np.swapaxes(rng.standard_normal((n_times, n, n_rows)) @ np.swapaxes(self.rows, 0, 1), 0, 1)
        return self.mean + drawn, np.zeros((n, 0))

    def log_likelihood(self, coordinates: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Log density (...,) of coordinates (..., T, C) in the subspace of the training: at each time, or of all."""
        flat = (*coordinates.shape[:-2], -1)
        if self.shared:
            whole = LowRankNormal.of_rows(self.mean.ravel(), self.rows.reshape(len(self.rows), -1), 0.0)
            return whole.log_likelihood(coordinates.reshape(flat))
        values, vectors = np.linalg.eigh(np.einsum("ntc,ntd->tcd", self.rows, self.rows, optimize=True))
        kept = values > values[:, -1:] * 1e-10
        inside = np.einsum("...tc,tcd->...td", coordinates - self.mean, vectors)
        terms = np.where(
            kept, inside**2 / np.where(kept, values, 1.0) + np.log(2 * np.pi * np.where(kept, values, 1)), 0
        )
        return np.asarray(-0.5 * terms.sum(axis=(-1, -2)))


def coordinates(tangent: np.ndarray, plane: np.ndarray) -> np.ndarray:
    """Tangent vectors (..., B, 3) -> (..., 2B) in frames (..., B, 2, 3)."""
    pairs = np.stack([np.einsum("...bc,...bc->...b", tangent, plane[..., k, :]) for k in (0, 1)], axis=-1)
    return pairs.reshape(*pairs.shape[:-2], -1)


def vectors(flat: np.ndarray, plane: np.ndarray) -> np.ndarray:
    """Coordinates (..., 2B) in frames (..., B, 2, 3) -> tangent vectors (..., B, 3)."""
    pairs = flat.reshape(*flat.shape[:-1], -1, 2)
    return pairs[..., :1] * plane[..., 0, :] + pairs[..., 1:] * plane[..., 1, :]


def carried(plane: np.ndarray, base: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Frames (..., B, 2, 3) at ``base`` carried in parallel to ``target``, both (..., B, 3), in one hop."""
    return sphere.transport(base[..., None, :], target[..., None, :], plane)


def along(directions: np.ndarray, plane: np.ndarray) -> np.ndarray:
    """A frame (..., B, 2, 3) at the first posture carried from posture to posture: (n, T, B, 2, 3) of (n, T, B, 3).

    Raises ValueError where two successive postures are opposite.
    """
    frames = np.empty((*directions.shape[:-1], 2, 3))
    frames[:, 0] = plane
    for t in range(1, directions.shape[1]):
        frames[:, t] = carried(frames[:, t - 1], directions[:, t - 1], directions[:, t])
    return frames


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
        """At the mean posture of each time, the frame carried along in parallel.

        Source: Chen, Park & Srivastava eq. 6, its mean: element by element (``sphere.mean``), not by summed arcs.
        """
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
