"""Which part of a composite a moment falls into, and the path of the root through all of them.

Performances of a composite task: times at once, bodies joined when they are asked for.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from emulator.composite import transitions
from emulator.composite.joining import join_arrays
from emulator.composite.parts import PartSequence
from emulator.composite.transitions import Course, Offsets, Windows, seam_between, unhurried_s, windows_s
from emulator.motion import turn
from emulator.performances import Performances


def part_at(
    times_s: np.ndarray, stop_s: np.ndarray, part_s: np.ndarray
) -> Iterator[tuple[int, np.ndarray, np.ndarray, np.ndarray]]:
    """The moments (n, T) of each part that has any: (part, own seconds (n, M), their columns (n, M), which are meant).

    A moment at a join is of the part that begins. stop_s, part_s : (n, P) when each part ends, and how long it is.
    """
    which = (times_s[..., None] >= stop_s[:, None, :-1]).sum(axis=-1)
    for part in range(stop_s.shape[1]):
        inside = which == part
        most = int(inside.sum(axis=1).max(initial=0))
        if most:
            columns = np.argsort(~inside, axis=1, kind="stable")[:, :most]
            own_s = np.take_along_axis(times_s, columns, axis=1) - (stop_s - part_s)[:, part, None]
            held = np.take_along_axis(inside, columns, axis=1)
            yield part, np.clip(own_s, 0.0, part_s[:, part, None]), columns, held


@dataclass(frozen=True, eq=False)
class Placed:
    """Where the joined path of the root has each part: as its own path, put somewhere, and a little beside it.

    at   : (n, 4) per part: x, y, 0 in metres and the heading at which it begins
    more : (n, F, 4) per part, on even frames of its own time: what the joins and other bones add to its own path
    """

    at: tuple[np.ndarray, ...]
    more: tuple[np.ndarray, ...]

    def path(self, part: int, own: np.ndarray, share: np.ndarray) -> np.ndarray:
        """(n, T, 4) the joined path where a part's own (from 0) is ``own`` (n, T, 4), at shares (n, T) of its time."""
        more = self.more[part]
        rows, place = np.arange(len(more))[:, None], share * (more.shape[1] - 1)
        cell = np.minimum(place.astype(int), more.shape[1] - 2)
        left = (place - cell)[..., None]
        return put(own, self.at[part]) + (1 - left) * more[rows, cell] + left * more[rows, cell + 1]


def joined_path(block: CompositePerformances) -> Placed:
    """The path of the root through all parts, the joined postures standing on their feet."""
    frames = zip(block.parts, block.model.n_frames, block.part_s.T, strict=True)
    courses = [course_of(part, np.linspace(0, 1, n) * whole[:, None]) for part, n, whole in frames]
    met = [
        seam_between(courses[k], courses[k + 1], block.windows_s[k], block.turns[k]) for k in range(len(courses) - 1)
    ]
    whole = join_arrays(block.skeleton, courses, bone_length_m=block.bone_length_m, met=met)
    path = np.concatenate([whole.root_m, whole.yaw_rad[..., None]], axis=-1)
    ends = np.cumsum([0, *(n - 1 for n in block.model.n_frames)])
    own = [np.concatenate([c.root_m, c.yaw_rad[..., None]], axis=-1) for c in courses]
    joined = [path[:, start : stop + 1] for start, stop in pairwise(ends)]
    at = [part[:, 0] * np.array([1.0, 1.0, 0.0, 1.0]) for part in joined]
    more = [part - put(one, here) for part, one, here in zip(joined, own, at, strict=True)]
    return Placed(tuple(at), tuple(more))


def put(path: np.ndarray, at: np.ndarray) -> np.ndarray:
    """A path (n, T, 4) turned and shifted to begin at ``at`` (n, 4); put back by ``from_start``."""
    return np.concatenate([turn(path[..., :3], at[:, None, 3]), path[..., 3:]], axis=-1) + at[:, None]


def from_start(path: np.ndarray, start: np.ndarray) -> np.ndarray:
    """A path (n, T, 4) as seen from its start (n, 4), where x, y and heading are 0."""
    level = start * np.array([1.0, 1.0, 0.0, 1.0])
    moved = path - level[:, None]
    return np.concatenate([turn(moved[..., :3], -start[:, None, 3]), moved[..., 3:]], axis=-1)


def course_of(part: Any, times_s: np.ndarray) -> Course:
    """The course of performances at times (n, T), the first of them 0."""
    directions, path = np.asarray(part.directions(times_s=times_s)), own_path(part, times_s)
    path = from_start(path, path[:, 0])
    return Course(directions, times_s, path[..., :3], path[..., 3], np.asarray(part.bone_length_m))


def own_path(part: Any, times_s: np.ndarray) -> np.ndarray:
    """(n, T, 4) root in metres and heading in radians of performances at times (n, T).

    Those without a ``path`` tell it by their joints: the heading is the turn from their directions to the world's.
    """
    if hasattr(type(part), "path"):
        return np.asarray(part.path(times_s=times_s))
    directions, joints = np.asarray(part.directions(times_s=times_s)), np.asarray(part.positions_m(times_s=times_s))
    (x, y), (u, v) = (np.moveaxis(d, -1, 0)[:2] for d in (directions, part.skeleton.directions(joints)))
    yaw = np.unwrap(np.arctan2((x * v - y * u).sum(-1), (x * u + y * v).sum(-1)), axis=1)
    return np.concatenate([joints[:, :, part.skeleton.root], yaw[..., None]], axis=-1)


TOUCH_S = 1e-3
"""Rates at a join are those of the first and last so many seconds of a part."""
Ends = list[tuple[transitions.End, transitions.End]]
AT_ONCE = 16
"""Performances whose paths are made at a time."""


@dataclass(frozen=True, eq=False)
class CompositePerformances(Performances):
    """n performances; ``parts`` holds those of each part. Rows and slices are performances again, the same to 1e-10.

    All of one performance is one body: the bones are those of ``model.body_part``.
    """

    model: PartSequence
    parts: tuple[Any, ...]

    def __getitem__(self, index: int | slice | np.ndarray) -> CompositePerformances:
        return CompositePerformances(self.model, tuple(part[index] for part in self.parts))

    @cached_property
    def part_s(self) -> np.ndarray:
        """(n, P) seconds of each part."""
        return np.stack([np.asarray(part.duration_s) for part in self.parts], axis=1)

    @cached_property
    def duration_s(self) -> np.ndarray:  # type: ignore[override]
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
        gaps = [transitions.sphere.angle(before[1].value, after[0].value) for before, after in pairs]
        return np.stack(gaps, axis=1) if gaps else np.empty((len(self), 0, self.skeleton.n_bones))

    @cached_property
    def turns(self) -> list[Offsets]:
        """What the postures are turned by at each join."""
        ends = self._ends
        return [transitions.turns(ends[k][1], ends[k + 1][0]) for k in range(len(ends) - 1)]

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
                found = transitions.eased_turn(found, self.turns[k - 1][1], -own_s, self.windows_s[k - 1][1])
            if k < len(self.parts) - 1:
                to_seam_s = self.part_s[:, k, None] - own_s
                found = transitions.eased_turn(found, self.turns[k][0], to_seam_s, self.windows_s[k][0])
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
        own = super()._times(times_s, n_times)
        return np.clip(own, 0.0, self.duration_s[:, None])


def _ends_of(directions: np.ndarray, end_s: np.ndarray) -> tuple[transitions.End, transitions.End]:
    """First and last End of a part from its directions (n, 4 or more, B, 3) at end_s (n, 4)."""
    first, last = (
        transitions.end_of(directions[:, two], end_s[:, two], last=k == 1, unit=True)
        for k, two in enumerate((slice(0, 2), slice(2, 4)))
    )
    return first, last
