"""Recordings on their common clock: repaired, their pauses cut out, aligned with warps that the pace can say."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.align import align, resample
from emulator.alignable import Labels
from emulator.fit_settings import FitSettings, Progress
from emulator.holds import Hold, cut
from emulator.motion import Motion, MotionSet
from emulator.repair import repaired
from emulator.root import RootChannel
from emulator.warp import clr, from_clr


@dataclass(frozen=True, eq=False)
class Registered:
    """whole : the repetitions, repaired; moving : the same without their pauses, which ``holds`` keeps

    warps : (N, T) common clock -> own unit time of moving; directions : (N, T, B, 3) postures on the common clock
    """

    whole: MotionSet
    moving: MotionSet
    holds: tuple[tuple[Hold, ...], ...]
    warps: np.ndarray
    directions: np.ndarray

    def subset(self, mask: np.ndarray) -> Registered:
        """The repetitions of a mask (N,), on the same clock."""
        at = np.flatnonzero(mask)
        holds = tuple(self.holds[i] for i in at)
        return Registered(self.whole.subset(at), self.moving.subset(at), holds, self.warps[at], self.directions[at])

    def channels(self) -> np.ndarray:
        """Side channels of the root on the common clock, (N, T * 4), with the feet where they were recorded."""
        channel = RootChannel(self.moving.skeleton)
        rows = []
        for motion, gamma, posture in zip(self.moving.motions, self.warps, self.directions):
            root, yaw, stretch = _on_clock(motion, gamma)
            rows.append(channel.forward(posture, motion.bone_length_m, root, yaw, stretch).ravel())
        return np.stack(rows)

    def mark_clock(self, warps: np.ndarray) -> np.ndarray:
        """When the marks came on the common clock, (N, E), by these warps (N, T)."""
        clock = np.linspace(0, 1, warps.shape[1])
        rows = [np.interp(at, gamma, clock) for at, gamma in zip(_mark_share(self.moving), warps)]
        return np.stack(rows).reshape(len(self.moving), -1)


def registered(motions: MotionSet, settings: FitSettings, progress: Progress) -> Registered:
    """Motions aligned to their common template on ``n_times`` points."""
    whole = repaired(motions)
    moving, holds = cut(whole)
    found = _aligned_warps(moving, settings, progress)
    warps = from_clr(clr(found, settings.n_knots), settings.n_times)  # what the pace coordinates can say exactly
    directions = np.stack([resample(m.directions, gamma) for m, gamma in zip(moving.motions, warps)])
    return Registered(whole, moving, holds, warps, directions)


def _aligned_warps(motions: MotionSet, settings: FitSettings, progress: Progress) -> np.ndarray:
    labels = Labels([motion.name for motion in motions.motions], motions.skeleton.bone_names)
    marks = np.clip(_mark_share(motions), 0.0, 1.0)
    marked = {"marks": marks, "mark_strength": settings.landmarks} if settings.landmarks else {}
    directions = [motion.directions for motion in motions.motions]
    return align(directions, n_times=settings.n_times, labels=labels, progress=progress, **marked).warps


def _mark_share(motions: MotionSet) -> np.ndarray:
    """(N, E) when the marks came, as a share of the own duration."""
    return motions.mark_s / motions.duration_s[:, None]


def _on_clock(motion: Motion, gamma: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Path (T, 3), heading (T,) and stretch (T, B), if it has one, of a motion at the common clock's times."""
    at = gamma * motion.duration_s

    def then(columns: np.ndarray) -> np.ndarray:
        return np.stack([np.interp(at, motion.time_s, column) for column in columns.T], axis=1)

    stretch = None if motion.stretch is None else then(motion.stretch)
    return then(motion.root_m), np.interp(at, motion.time_s, motion.yaw_rad), stretch
