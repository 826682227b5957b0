"""Performances of a composite task: times at once, bodies joined when they are asked for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator import seams
from emulator.clean import turn
from emulator.composite_frames import Placed, from_start, joined_path, own_path, part_at
from emulator.courses import Offsets, Windows, unhurried_s, windows_s
from emulator.skeleton import Skeleton

if TYPE_CHECKING:
    from emulator.composite import CompositeEmulator

TOUCH_S = 1e-3
"""Rates at a join are those of the first and last so many seconds of a part."""
Ends = list[tuple[seams.End, seams.End]]
AT_ONCE = 16
"""Performances whose paths are made at a time."""


@dataclass(frozen=True, eq=False)
class CompositePerformances:
    """n performances; ``parts`` holds those of each part. Rows and slices are performances again, the same to 1e-10.

    All of one performance is one body: the bones are those of ``model.body_part``.
    """

    model: CompositeEmulator
    parts: tuple[Any, ...]

    def __len__(self) -> int:
        return len(self.duration_s)

    def __getitem__(self, index: int | slice | np.ndarray) -> CompositePerformances:
        return CompositePerformances(self.model, tuple(part[index] for part in self.parts))

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
    def part_s(self) -> np.ndarray:
        """(n, P) seconds of each part."""
        return np.stack([np.asarray(part.duration_s) for part in self.parts], axis=1)

    @cached_property
    def duration_s(self) -> np.ndarray:
        """(n,) seconds: the sum over the parts."""
        return np.asarray(self.stop_s[:, -1])

    @cached_property
    def stop_s(self) -> np.ndarray:
        """(n, P) seconds from the start at which each part ends."""
        return np.cumsum(self.part_s, axis=1)

    @property
    def mark_s(self) -> np.ndarray:
        """(n, E) seconds of the marks of all parts, from the start of the whole."""
        start_s = self.stop_s - self.part_s
        return np.concatenate([np.asarray(p.mark_s) + start_s[:, k, None] for k, p in enumerate(self.parts)], axis=1)

    @property
    def scores(self) -> np.ndarray:
        """(n, K) the parts' coefficients, side by side."""
        return np.concatenate([part.scores for part in self.parts], axis=1)

    @property
    def bone_length_m(self) -> np.ndarray:
        """(n, B) metres."""
        return np.asarray(self.parts[self.model.body_part].bone_length_m)

    def directions(self, times_s: np.ndarray | None = None, n_times: int = 101, dtype: Any = np.float64) -> np.ndarray:
        """(n, T, B, 3) unit directions without heading, at ``n_times`` even points or at ``times_s`` (T,) or (n, T).

        Before the start and after the end the first and last posture are held.
        """
        return self._directions(self._times(times_s, n_times), dtype)

    def root_m(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(n, T, 3) path of the root, metres, from x = y = 0, starting heading along x; times as ``directions``."""
        return self.path(times_s, n_times)[..., :3]

    def path(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(n, T, 4) ``root_m`` and the heading in radians; times as ``directions``."""
        times = self._times(times_s, n_times)
        blocks = range(0, len(self), AT_ONCE)
        paths = [self[k : k + AT_ONCE]._path(times[k : k + AT_ONCE]) for k in blocks]
        return np.concatenate(paths) if paths else np.empty((*times.shape, 4))

    def positions_m(self, times_s: np.ndarray | None = None, n_times: int = 101, dtype: Any = np.float64) -> np.ndarray:
        """(n, T, J, 3) joints in metres, z up, floor at 0, in the frame of ``root_m``; times as ``directions``."""
        times = self._times(times_s, n_times)
        out = np.empty((*times.shape, self.skeleton.n_joints, 3), dtype)
        for start in range(0, len(self), AT_ONCE):
            rows = slice(start, start + AT_ONCE)
            some = self[rows]
            path, directions = some._path(times[rows]), some._directions(times[rows], np.float64)
            world = turn(directions, path[..., 3:])
            out[rows] = self.skeleton.positions(world, some.bone_length_m[:, None], path[..., :3])
        return out

    def gaps_rad(self) -> np.ndarray:
        """(n, P - 1, B) how far each bone's directions are apart at each join."""
        pairs = zip(self._ends, self._ends[1:], strict=False)
        gaps = [seams.sphere.angle(before[1].value, after[0].value) for before, after in pairs]
        return np.stack(gaps, axis=1) if gaps else np.empty((len(self), 0, self.skeleton.n_bones))

    @cached_property
    def turns(self) -> list[Offsets]:
        """What the postures are turned by at each join."""
        ends = self._ends
        return [seams.turns(ends[k][1], ends[k + 1][0]) for k in range(len(ends) - 1)]

    @cached_property
    def windows_s(self) -> list[Windows]:
        """(n,) seconds before and after each join in which they are turned."""
        gap = self.gaps_rad().max(axis=-1)
        return [
            windows_s(self.part_s[:, k], self.part_s[:, k + 1], unhurried_s(gap[:, k], self.model.blend_s))
            for k in range(len(self.parts) - 1)
        ]

    @cached_property
    def _ends(self) -> Ends:
        """The first and the last posture of each part, and how fast they change there."""
        return self._decoded({})[1]

    def _directions(self, times: np.ndarray, dtype: Any) -> np.ndarray:
        asked = {k: some for k, *some in part_at(times, self.stop_s, self.part_s)}
        decoded, self.__dict__["_ends"] = self._decoded({k: own_s for k, (own_s, _, _) in asked.items()})
        out = np.empty((*times.shape, self.skeleton.n_bones, 3), dtype)
        for k, (own_s, columns, held) in asked.items():
            found = decoded[k]
            if k > 0:
                found = seams.eased_turn(found, self.turns[k - 1][1], -own_s, self.windows_s[k - 1][1])
            if k < len(self.parts) - 1:
                to_seam_s = self.part_s[:, k, None] - own_s
                found = seams.eased_turn(found, self.turns[k][0], to_seam_s, self.windows_s[k][0])
            rows = np.broadcast_to(np.arange(len(times))[:, None], columns.shape)
            out[rows[held], columns[held]] = found[held]
        return out

    def _decoded(self, asked: dict[int, np.ndarray]) -> tuple[dict[int, np.ndarray], Ends]:
        """Directions of parts at own times (n, M), by part, and the ends of all: one call a part, as a call is dear."""
        found, ends = {}, self.__dict__.get("_ends") or [None] * len(self.parts)
        for k, part in enumerate(self.parts):
            end_s = self._end_s(k) if ends[k] is None else np.empty((len(self), 0))
            own_s = np.concatenate([end_s, asked[k]], axis=1) if k in asked else end_s
            if own_s.shape[1]:
                directions = part.directions(times_s=own_s)
                found[k] = directions[:, end_s.shape[1] :]
                ends[k] = ends[k] or _ends_of(directions, end_s)
        return found, ends

    def _end_s(self, part: int) -> np.ndarray:
        """(n, 4) the moments of a part from which its ends are known."""
        whole_s = self.part_s[:, part]
        touch_s = np.minimum(TOUCH_S, whole_s / 100)
        return np.stack([0 * whole_s, touch_s, whole_s - touch_s, whole_s], axis=1)

    def _path(self, times: np.ndarray) -> np.ndarray:
        out = np.empty((*times.shape, 4))
        rows = np.arange(len(times))[:, None]
        for k, own_s, columns, held in part_at(times, self.stop_s, self.part_s):
            from_0 = np.concatenate([np.zeros((len(own_s), 1)), own_s], axis=1)
            own = own_path(self.parts[k], from_0)
            own = from_start(own[:, 1:], own[:, 0])
            found = self._placed.path(k, own, own_s / self.part_s[:, k, None])
            out[np.broadcast_to(rows, columns.shape)[held], columns[held]] = found[held]
        return out

    @cached_property
    def _placed(self) -> Placed:
        """Where the parts are on the floor."""
        return joined_path(self)

    def _times(self, times_s: np.ndarray | None, n_times: int) -> np.ndarray:
        own = np.linspace(0, 1, n_times) * self.duration_s[:, None] if times_s is None else np.asarray(times_s, float)
        own = np.broadcast_to(own, (len(self), np.shape(own)[-1]))
        return np.clip(own, 0.0, self.duration_s[:, None])


def _ends_of(directions: np.ndarray, end_s: np.ndarray) -> tuple[seams.End, seams.End]:
    """First and last End of a part from its directions (n, 4 or more, B, 3) at end_s (n, 4)."""
    first, last = (
        seams.end_of(directions[:, two], end_s[:, two], last=k == 1, unit=True)
        for k, two in enumerate((slice(0, 2), slice(2, 4)))
    )
    return first, last
