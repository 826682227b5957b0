"""Many joins at once: courses of posture, heading and root path, one after the other, on feet that do not slide.

Postures and headings meet as in ``seams``. The root then rides on the lower foot of the new postures, with the slip and
the clearance that it had, and goes on from where the last course ended, heading where that one headed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from emulator import seams
from emulator.clean import turn
from emulator.courses import BLEND_S, Course, Seam, seam_between, windows_s
from emulator.root import RootChannel
from emulator.skeleton import Skeleton


def join_arrays(
    skeleton: Skeleton,
    courses: Sequence[Course],
    *,
    bone_length_m: np.ndarray | None = None,
    blend_s: float = BLEND_S,
    met: Sequence[Seam] | None = None,
) -> Course:
    """The courses one after the other: durations add up, and the shared frame of a seam stands once.

    bone_length_m : (n, B) of the whole; None: those of the first
    blend_s       : seconds on each side of every seam, at most half of a course
    met           : the seams, where they are known already
    Outside the blends nothing changes but place and heading; where bones are others, the path follows them.
    """
    bones_m = courses[0].bone_length_m if bone_length_m is None else bone_length_m
    if met is None:
        met = [seam_between(a, b, windows_s(a.duration_s, b.duration_s, blend_s)) for a, b in pairwise(courses)]
    sides = zip([None, *met], [*met, None], strict=True)
    parts = [ridden(skeleton, course, *side, bones_m) for course, side in zip(courses, sides, strict=True)]
    return _chained(parts, met)


def blended(course: Course, start: Seam | None, stop: Seam | None) -> Course:
    """The course with its postures and headings brought to the seams at its start and its end."""
    directions, yaw = course.directions, course.yaw_rad[..., None]
    sides = ((start, 1, -course.time_s), (stop, 0, course.duration_s[:, None] - course.time_s))
    for seam, side, to_seam_s in sides:
        if seam is not None:
            directions = seams.eased_turn(directions, seam.turn[side], to_seam_s, seam.window_s[side])
            yaw = seams.eased_shift(yaw, seam.yaw[side], to_seam_s, seam.window_s[side])
    return replace(course, directions=directions, yaw_rad=yaw[..., 0])


def ridden(
    skeleton: Skeleton, course: Course, start: Seam | None, stop: Seam | None, bone_length_m: np.ndarray
) -> Course:
    """The blended course on bones (n, B): its root rides on its feet, with the slip and clearance of its own."""
    channel = RootChannel(skeleton)
    new = replace(blended(course, start, stop), bone_length_m=bone_length_m)
    (way, floor), (new_way, new_floor) = (channel.ride(c.directions, _length_m(c), c.yaw_rad) for c in (course, new))
    larger = (channel.leg_m(bone_length_m) / channel.leg_m(course.bone_length_m))[:, None, None]
    left = course.root_m - np.concatenate([way, floor[..., None]], axis=-1)
    root = np.concatenate([new_way, new_floor[..., None]], axis=-1) + larger * left
    root[..., :2] -= root[:, :1, :2]
    return replace(new, root_m=root)


def _length_m(course: Course) -> np.ndarray:
    own = course.bone_length_m[:, None]
    return own if course.stretch is None else own * course.stretch


def _chained(parts: Sequence[Course], met: Sequence[Seam]) -> Course:
    """Each course in the frame of the first, from where the last ended; height and speed of the root continuous."""
    placed = [parts[0]]
    for part in parts[1:]:
        placed.append(placed_after(part, placed[-1].root_m[:, -1], placed[-1].yaw_rad[:, -1]))
    eased = smooth_roots(placed, met)
    start_s = np.cumsum([np.zeros_like(parts[0].duration_s), *(p.duration_s for p in parts[:-1])], axis=0)
    keep = [slice(None) if k == 0 else slice(1, None) for k in range(len(parts))]
    stretch = None
    if any(part.stretch is not None for part in parts):
        ones = [np.ones(p.directions.shape[:3]) if p.stretch is None else p.stretch for p in parts]
        stretch = np.concatenate([s[:, k] for s, k in zip(ones, keep, strict=True)], axis=1)
    return Course(
        directions=_one([p.directions for p in placed], keep),
        time_s=_one([p.time_s + s[:, None] for p, s in zip(placed, start_s, strict=True)], keep),
        root_m=_one(eased, keep),
        yaw_rad=_one([p.yaw_rad for p in placed], keep),
        bone_length_m=parts[0].bone_length_m,
        stretch=stretch,
    )


def placed_after(part: Course, root_m: np.ndarray, yaw_rad: np.ndarray) -> Course:
    """The course turned and shifted to begin at ``root_m`` (n, 3), looking along ``yaw_rad`` (n,); heights stay."""
    here = np.concatenate([root_m[:, :2], np.zeros((len(root_m), 1))], axis=1)
    return replace(
        part, root_m=turn(part.root_m, yaw_rad[:, None]) + here[:, None], yaw_rad=part.yaw_rad + yaw_rad[:, None]
    )


def smooth_roots(placed: Sequence[Course], met: Sequence[Seam]) -> list[np.ndarray]:
    """Root paths with the height and the speed continuous at each seam; the horizontal place is so already."""
    roots = [part.root_m for part in placed]
    ends = [[seams.end_of(p.root_m, p.time_s, last=last) for last in (False, True)] for p in placed]
    for k, seam in enumerate(met):
        before, after = seams.shifts(ends[k][1], ends[k + 1][0])
        to_seam_s = placed[k].duration_s[:, None] - placed[k].time_s
        roots[k] = seams.eased_shift(roots[k], before, to_seam_s, seam.window_s[0])
        roots[k + 1] = seams.eased_shift(roots[k + 1], after, -placed[k + 1].time_s, seam.window_s[1])
    return roots


def _one(parts: Sequence[np.ndarray], keep: Sequence[slice]) -> np.ndarray:
    return np.concatenate([part[:, rows] for part, rows in zip(parts, keep, strict=True)], axis=1)
