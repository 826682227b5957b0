"""What can be aligned: sequences of unit directions, nowhere opposite to the next posture or to the mean of all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator import sphere

NEARLY_OPPOSITE_RAD = 0.1
"""Nearer than this to opposite, a tangent vector may point anywhere: refused. The nearest in recordings is 0.24."""


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
        turned = _opposite(sequence[1:], sequence[:-1])
        if len(turned):
            frame, bone = turned[0]
            raise ValueError(f"{where}: {labels.bone(bone)} turns about between frames {frame} and {frame + 1}")
    return sequences


def mean_posture(uniform: np.ndarray, labels: Labels = NUMBERS) -> np.ndarray:
    """Karcher mean (B, 3) of all postures (N, T, B, 3). Raises ValueError where a posture is nearly opposite to it."""
    middle = uniform.mean(axis=(0, 1))
    lost = np.flatnonzero(np.linalg.norm(middle, axis=-1) < 1e-6)
    if len(lost):
        raise ValueError(f"align: the directions of {labels.bone(lost[0])} cancel out: they have no mean direction")
    _refuse_opposite(uniform, sphere.normalise(middle), labels)
    reference = sphere.mean(uniform.reshape(-1, *uniform.shape[2:]))
    _refuse_opposite(uniform, reference, labels)
    return reference


def _refuse_opposite(uniform: np.ndarray, reference: np.ndarray, labels: Labels) -> None:
    opposite = _opposite(uniform, reference)
    if len(opposite) == 0:
        return
    number, time, bone = opposite[0]
    share, many = time / (uniform.shape[1] - 1), len(set(opposite[:, 0].tolist()))
    raise ValueError(
        f"align: sequence {labels.sequence(number)}: at {share:.0%} of its time {labels.bone(bone)} points opposite to "
        f"its mean direction over all ({many} of {len(uniform)} sequences have such postures); leave them out, or fit "
        "what differs in kind apart"
    )


def _opposite(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Where directions (..., 3) are nearly opposite: index rows."""
    return np.argwhere(np.einsum("...c,...c->...", one, other) < -np.cos(NEARLY_OPPOSITE_RAD))
