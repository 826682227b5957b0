"""Performances drawn from an emulator: times at once, postures when they are asked for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator import decode
from emulator.dwell_times import moving_share
from emulator.skeleton import Skeleton

if TYPE_CHECKING:
    from emulator.model import MotionEmulator

AT_ONCE = 16
"""Performances whose paths are made at a time."""
Floats = type[np.floating] | np.dtype


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

    def to_frame(self) -> Any:
        """A pandas DataFrame, a row each: duration and marks. Raises ImportError where pandas is absent."""
        from emulator.frames import performances_frame

        return performances_frame(self)

    def _repr_html_(self) -> str:
        from emulator.shown.motions import performances_html

        return performances_html(self)

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

    def directions(
        self, times_s: np.ndarray | None = None, n_times: int = 101, dtype: Floats = np.float64
    ) -> np.ndarray:
        """(n, T, B, 3) unit directions without heading, at ``n_times`` even points of own time or at ``times_s``.

        times_s : (T,) or (n, T) seconds from the start of each performance; before its start and after its end the
                  first and last posture are held.
        dtype   : of the answer and of its computation; float32 takes half the time and memory, and agrees to 1e-6
        """
        return self._directions(self._place(times_s, n_times), dtype)

    def root_m(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(n, T, 3) path of the root, metres, from x = y = 0, starting heading along x; times as ``directions``."""
        return self.path(times_s, n_times)[..., :3]

    def path(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(n, T, 4) ``root_m`` and the heading in radians; times as ``directions``."""
        place = self._place(times_s, n_times)
        path = np.empty((*place.shape, 4))
        for rows in self._blocks():
            some = self[rows]
            path[rows] = _linear(some._path(some._on_clock(place[rows, :0])[0]), place[rows])
        return path

    def positions_m(
        self, times_s: np.ndarray | None = None, n_times: int = 101, dtype: Floats = np.float64
    ) -> np.ndarray:
        """(n, T, J, 3) joints in metres, z up, floor at 0, in the frame of ``root_m``; times, dtype as ``directions``.

        float32 only saves memory: the path of the root needs float64.
        """
        from emulator.kernels.body import stand_all

        place = self._place(times_s, n_times)
        positions = np.empty((*place.shape, self.skeleton.n_joints, 3), dtype)
        for rows in self._blocks():
            some, lengths = self[rows], self.bone_length_m[rows]
            aligned, along = some._on_clock(place[rows])
            flat = along.reshape(*along.shape[:2], -1)
            stand_all(flat, lengths, self.skeleton.chain, some._path(aligned), place[rows], positions[rows])
        return positions

    def _directions(self, place: np.ndarray, dtype: Floats = np.float64) -> np.ndarray:
        model = self.model
        posture = model.scale.raw(self.scores, "posture")
        return decode.directions(model.posture, model.flatten, posture, place, np.dtype(dtype))

    def _on_clock(self, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Directions (n, T, B, 3) at the points of the common clock and (n, S, B, 3) at places (n, S), made as one."""
        clock = np.broadcast_to(np.arange(float(self.model.n_times)), (len(self), self.model.n_times))
        both = self._directions(np.concatenate([clock, place], axis=1))
        return np.ascontiguousarray(both[:, : self.model.n_times]), np.ascontiguousarray(both[:, self.model.n_times :])

    def _path(self, aligned: np.ndarray) -> np.ndarray:
        """(n, T, 4) on the common clock: x, y, z of the root in metres and its heading in radians."""
        root, yaw = self.model.channel.inverse(self.model.root_channel(self.scores), aligned, self.bone_length_m)
        return np.concatenate([root, yaw[..., None]], axis=-1)

    def _blocks(self) -> Iterator[slice]:
        """A few performances at a time: what is computed on the way is several times larger than the answer."""
        return (slice(start, start + AT_ONCE) for start in range(0, len(self), AT_ONCE))

    def _place(self, times_s: np.ndarray | None, n_times: int) -> np.ndarray:
        """(n, T) places on the common grid, in cells, of the times asked for."""
        own = np.linspace(0, 1, n_times) if times_s is None else np.asarray(times_s) / self.duration_s[:, None]
        own = np.broadcast_to(own, (len(self), np.shape(own)[-1]))
        if len(self.model.dwells):
            own = moving_share(self.model, self.scores, own)
        return decode.places(self.model.warps(self.scores), own)


def _linear(path: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Values (n, T', ...) of path (n, T, ...) at places (n, T'), linear between."""
    rows, cell = np.arange(len(place))[:, None], np.minimum(place.astype(int), path.shape[1] - 2)
    share = (place - cell).reshape(*place.shape, *[1] * (path.ndim - 2))
    return (1 - share) * path[rows, cell] + share * path[rows, cell + 1]
