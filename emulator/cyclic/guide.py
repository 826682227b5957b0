"""What recorded beats are like: how many frames they take, and with which posture the next one begins."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator.cyclic.units import Unit

ROOM = 1.2
"""A draw may lie this much further out than any recording."""


@dataclass(frozen=True, eq=False)
class Guide:
    """anchors : (F, 3, D) usual latents at a beat of each foot (F = 1 where none steps): of 1, the control, its square

    log_frames : (2,) log frames of a beat: of 1 and the control; spread : of log frames about it, at most recorded
    apart : greatest recorded distance of a beat's first d latents from the usual ones
    low, high : (d,) least and greatest recorded latents of those that the dynamics move
    """

    anchors: np.ndarray
    log_frames: np.ndarray
    spread: float
    apart: float
    low: np.ndarray
    high: np.ndarray

    @classmethod
    def of(cls, beats: Sequence[Unit], moved: int) -> Guide:
        """Of all recorded beats, from one to the next; the dynamics move the first ``moved`` latents."""
        feet = sorted({beat.foot for beat in beats})
        anchors = np.stack([_anchor([beat for beat in beats if beat.foot == foot]) for foot in feet])
        control = np.array([beat.control for beat in beats])
        logs = np.log([beat.n_steps for beat in beats])
        powers = np.stack([control**0, control], axis=1)[:, : 1 + (np.ptp(control) > 1e-9)]
        fitted = np.linalg.lstsq(powers, logs, rcond=None)[0]
        frames = z = np.concatenate([beat.z[:, :moved] for beat in beats])
        wide = (ROOM - 1) * np.ptp(frames, axis=0)
        spread = float(np.abs(logs - powers @ fitted).max())
        bare = cls(anchors, np.append(fitted, [0.0])[:2], spread, 0.0, z.min(axis=0) - wide, z.max(axis=0) + wide)
        apart = [np.linalg.norm((beat.z[0] - bare.usual(beat.foot, beat.control))[:moved]) for beat in beats]
        return cls(bare.anchors, bare.log_frames, spread, float(max(apart)), bare.low, bare.high)

    def usual(self, foot: int, control: float) -> np.ndarray:
        """(D,) latents at a beat of this foot."""
        anchor = self.anchors[min(max(foot, 0), len(self.anchors) - 1)]
        return np.asarray(np.array([1.0, control, control**2]) @ anchor)

    def frames(self, control: float) -> float:
        """How many a beat takes."""
        return float(np.exp(self.log_frames @ np.array([1.0, control])))

    def lasts(self, frames: int, control: float) -> bool:
        """Whether a beat may take so many."""
        return bool(abs(np.log(frames / self.frames(control))) <= ROOM * self.spread)

    def allows(self, z: np.ndarray, foot: int, control: float) -> bool:
        """Whether a beat z (T, d), up to and with the first frame of the next one, is like a recorded one."""
        after = self.usual(1 - foot if foot >= 0 else foot, control)[: z.shape[1]]
        near = np.linalg.norm(z[-1] - after) <= ROOM * self.apart
        return bool(self.lasts(len(z) - 1, control) and near and np.all((z >= self.low) & (z <= self.high)))


def _anchor(beats: list[Unit]) -> np.ndarray:
    """(3, D) by least squares."""
    z, control = np.array([beat.z[0] for beat in beats]), np.array([beat.control for beat in beats])
    n_powers = min(3, len(np.unique(control)))
    powers = np.stack([control**0, control, control**2], axis=1)[:, :n_powers]
    fitted = np.linalg.lstsq(powers, z, rcond=None)[0]
    return np.vstack([fitted, np.zeros((3 - n_powers, z.shape[1]))])
