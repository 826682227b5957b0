"""Performances drawn from an emulator: times at once, postures when they are asked for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from emulator import sphere
from emulator.clean import turn
from emulator.skeleton import Skeleton

if TYPE_CHECKING:
    from emulator.model import MotionEmulator


@dataclass(frozen=True, eq=False)
class MotionPerformances:
    """n performances of a task.

    duration_s (n,) seconds; scores (n, K) joint coordinates; body_scale (n,) factor on every bone.
    ``performances[3]`` and slices are performances again, decoded to the same postures as in the block (to 1e-10).
    """

    model: MotionEmulator
    scores: np.ndarray
    duration_s: np.ndarray
    body_scale: np.ndarray

    def __len__(self) -> int:
        return len(self.duration_s)

    def __getitem__(self, index: int | slice | np.ndarray) -> MotionPerformances:
        rows = slice(index, index + 1 or None) if isinstance(index, (int, np.integer)) else index
        return MotionPerformances(self.model, self.scores[rows], self.duration_s[rows], self.body_scale[rows])

    @property
    def skeleton(self) -> Skeleton:
        return self.model.skeleton

    @cached_property
    def mark_s(self) -> np.ndarray:
        """(n, E) seconds at which the marks fall, increasing, inside the duration.

        NOTE: made when asked for; a simulation spends durations, and marks are half the cost of a draw.
        """
        return self.duration_s[:, None] * self.model.mark_share(self.scores)

    @property
    def bone_length_m(self) -> np.ndarray:
        """(n, B) metres."""
        return self.model.bone_length_m(self.scores) * self.body_scale[:, None]

    def directions(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(n, T, B, 3) unit directions without heading, at ``n_times`` even points of own time or at ``times_s``.

        times_s : (T,) or (n, T) seconds from the start of each performance; before its start and after its end the
                  first and last posture are held.
        """
        return _along(self.model.aligned_directions(self.scores), self._place(times_s, n_times))

    def root_m(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(n, T, 3) path of the root, metres, from x = y = 0, starting heading along x; times as ``directions``."""
        root, _ = self._path(self.model.aligned_directions(self.scores))
        return _linear(root, self._place(times_s, n_times))

    def positions_m(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(n, T, J, 3) joints in metres, z up, floor at 0, in the frame of ``root_m``; times as ``directions``."""
        aligned, place = self.model.aligned_directions(self.scores), self._place(times_s, n_times)
        root, yaw = (_linear(path, place) for path in self._path(aligned))
        world = turn(_along(aligned, place), yaw[..., None])
        return self.skeleton.positions(world, self.bone_length_m[:, None, :], root)

    def _path(self, aligned: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self.model.channel.inverse(self.model.root_channel(self.scores), aligned, self.bone_length_m)

    def _place(self, times_s: np.ndarray | None, n_times: int) -> np.ndarray:
        """(n, T) places on the common grid, in cells, of the times asked for."""
        own = np.linspace(0, 1, n_times) if times_s is None else np.asarray(times_s) / self.duration_s[:, None]
        cells = np.arange(float(self.model.n_times))
        own = np.broadcast_to(own, (len(self), np.shape(own)[-1]))
        return np.stack([np.interp(at, warp, cells) for at, warp in zip(own, self.model.warps(self.scores))])


def _cells(place: np.ndarray, n_times: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rows = np.arange(len(place))[:, None]
    cell = np.minimum(place.astype(int), n_times - 2)
    return rows, cell, place - cell


def _along(aligned: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Directions (n, T', B, 3) at places (n, T') along the geodesics of aligned (n, T, B, 3)."""
    rows, cell, share = _cells(place, aligned.shape[1])
    return sphere.between(aligned[rows, cell], aligned[rows, cell + 1], share[..., None])


def _linear(path: np.ndarray, place: np.ndarray) -> np.ndarray:
    rows, cell, share = _cells(place, path.shape[1])
    share = share.reshape(*share.shape, *[1] * (path.ndim - 2))
    return (1 - share) * path[rows, cell] + share * path[rows, cell + 1]
