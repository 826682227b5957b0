"""What can be aligned: sequences of unit directions, nowhere opposite to the next posture; and each bone's base point.

A tangent vector at a base point may point anywhere where the posture is opposite to it. So the base of a bone is the
Karcher mean of its directions; where the opposite point of that comes near one of them, a point beside the mean.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator.geometry import sphere

NEARLY_OPPOSITE_RAD = 0.1
"""Nearer than this to opposite, a tangent vector may point anywhere."""
LEAST_ROOM_RAD, ROOM_RAD = 0.25, 0.5
"""Where a posture is nearer to the opposite point of the mean than the first, another base keeps it off by the second.
With 0.1, 0.3, 0.5, 1 and all the room there is, the tangent vectors of the left hand in 20 lunges move 1.33, 1.24,
1.10, 1.06 and 1.15 times as fast as the hand, and are 0.51, 0.55, 0.66, 1.04 and 1.43 rad long (root mean squares)."""
_SEARCH = ((np.pi, 4000), (0.1, 300), (0.01, 300))
"""Half angles of the caps that are searched, one within the other, and how many points are tried in each."""
_AT_ONCE = 500


@dataclass(frozen=True)
class Labels:
    """Names for messages: of each sequence and of each bone; numbers where there are none."""

    sequences: Sequence[str] = ()
    bones: Sequence[str] = ()

    def sequence(self, number: int) -> str:
        return f"{number} ({self.sequences[number]})" if self.sequences else str(number)

    def bone(self, number: int) -> str:
        return f"the bone to {self.bones[number]}" if self.bones else f"bone {number}"


NUMBERS = Labels()


def checked(directions: Sequence[np.ndarray], labels: Labels = NUMBERS) -> list[np.ndarray]:
    """The sequences (T_i, B, 3) as floats. Raises ValueError that tells the sequence where one cannot be aligned."""
    sequences = [np.asarray(sequence, float) for sequence in directions]
    if not sequences:
        raise ValueError("align: no sequence given")
    for number, sequence in enumerate(sequences):
        where = f"align: sequence {labels.sequence(number)}"
        if sequence.ndim != 3 or sequence.shape[1:] != sequences[0].shape[1:] or len(sequence) < 2:
            expected = f"(T, {sequences[0].shape[1] if sequences[0].ndim == 3 else 'B'}, 3) with T >= 2"
            raise ValueError(f"{where} must be {expected}, found {sequence.shape}")
        if not np.allclose(np.linalg.norm(sequence, axis=-1), 1.0, atol=1e-6):
            raise ValueError(f"{where} is not made of unit vectors")
        turned = opposite(sequence[1:], sequence[:-1])
        if len(turned):
            frame, bone = turned[0]
            raise ValueError(f"{where}: {labels.bone(bone)} turns about between frames {frame} and {frame + 1}")
    return sequences


def mean_posture(uniform: np.ndarray, labels: Labels = NUMBERS) -> np.ndarray:
    """Base (B, 3) of all postures (N, T, B, 3), see ``base_points``.

    Raises ValueError where a bone points so many ways that some posture is opposite to every base.
    """
    reference = base_points(uniform)[1]
    at = np.argwhere(np.einsum("ntbc,bc->ntb", uniform, reference) < -np.cos(10 * sphere.OPPOSITE_RAD))
    if len(at):
        number, time, bone = at[0]
        raise ValueError(
            f"align: sequence {labels.sequence(number)}: at {time / (uniform.shape[1] - 1):.0%} of its time "
            f"{labels.bone(bone)} points opposite to its base, and it has no other: it points everywhere"
        )
    return reference


def base_points(postures: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of each bone of postures (..., B, 3) the mean direction and the base of its tangent plane, both (B, 3).

    mean : the Karcher mean; where a posture is nearly opposite to the sum of all, and would draw it any way, the
           direction of the sum, and where they cancel out the first posture
    base : the mean where its opposite point is ``LEAST_ROOM_RAD`` away from all postures, else the nearest point to it
           whose opposite is ``ROOM_RAD`` away, else the point whose opposite is farthest from all postures
    """
    points = np.reshape(postures, (-1, *np.shape(postures)[-2:]))
    middle = points.mean(axis=0)
    size = np.linalg.norm(middle, axis=-1, keepdims=True)
    mean = np.where(size > 1e-6, middle / np.maximum(size, 1e-6), points[0])
    narrow = room_rad(points, mean) > NEARLY_OPPOSITE_RAD
    if narrow.any():
        mean[narrow] = sphere.mean(points[:, narrow])
    base = mean.copy()
    for bone in np.flatnonzero(room_rad(points, mean) < LEAST_ROOM_RAD):
        base[bone] = _with_room(points[:, bone], mean[bone])
    return mean, base


def room_rad(points: np.ndarray, base: np.ndarray) -> np.ndarray:
    """How far (B,) all points (P, B, 3) stay from the opposite point of each base (B, 3)."""
    return np.arccos(np.clip(-np.einsum("pbc,bc->pb", points, base).min(axis=0), -1.0, 1.0))


def opposite(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Where directions (..., 3) are nearly opposite: index rows."""
    return np.argwhere(np.einsum("...c,...c->...", one, other) < -np.cos(NEARLY_OPPOSITE_RAD))


def _with_room(points: np.ndarray, mean: np.ndarray) -> np.ndarray:
    """The point (3,) nearest to the mean whose opposite is ``ROOM_RAD`` from all points (P, 3), or the roomiest."""
    best = mean
    for half_angle, n in _SEARCH:
        tried = np.concatenate([best[None], _cap(best, half_angle, n)])
        parts = (points[i : i + _AT_ONCE] for i in range(0, len(points), _AT_ONCE))
        lowest = np.min([(part @ tried.T).min(axis=0) for part in parts], axis=0)
        enough = lowest >= -np.cos(ROOM_RAD)
        best = tried[np.where(enough, tried @ mean, -2.0).argmax() if enough.any() else lowest.argmax()]
    return np.asarray(best)


def _cap(centre: np.ndarray, half_angle: float, n: int) -> np.ndarray:
    """n points (n, 3) spread evenly over the cap about centre (3,) (Fibonacci's spiral)."""
    i = np.arange(n) + 0.5
    height = 1.0 - (1.0 - np.cos(half_angle)) * i / n
    turn, out = np.pi * (1.0 + np.sqrt(5.0)) * i, np.sqrt(1.0 - height**2)
    first, second = sphere.basis(centre)
    across = np.cos(turn)[:, None] * first + np.sin(turn)[:, None] * second
    return np.asarray(height[:, None] * centre + out[:, None] * across)
