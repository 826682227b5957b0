"""Which part of a composite a moment falls into, and the path of the root through all of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator.clean import turn
from emulator.courses import Course, seam_between
from emulator.join_arrays import join_arrays

if TYPE_CHECKING:
    from emulator.composite_performances import CompositePerformances

FRAMES_HZ = 50.0
_FEWEST, _MOST = 24, 4000


def n_frames(mean_s: float) -> int:
    """Frames on which the path of a part is made: the same for every performance, so that each is what it is alone."""
    return int(np.clip(np.ceil(mean_s * FRAMES_HZ), _FEWEST, _MOST)) + 1


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
