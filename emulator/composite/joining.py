"""Many joins at once: courses of posture, heading and root path, one after the other, on feet that do not slide.

Postures and headings meet as in ``seams``. The root then rides on the lower foot of the new postures, with the slip and
the clearance that it had, and goes on from where the last course ended, heading where that one headed.

One motion after another: at a common posture, with continuous speed, durations adding up.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from emulator.composite import transitions
from emulator.composite.transitions import (
    BLEND_S,
    FASTEST_RAD_PER_S,
    Course,
    Seam,
    difference,
    seam_between,
    widest_gap_rad,
    windows_s,
)
from emulator.model.decoding import RootChannel
from emulator.motion import Motion, turn
from emulator.skeleton import Skeleton

__all__ = ["BLEND_S", "FASTEST_RAD_PER_S", "JoinError", "joined", "most_gap_rad", "posture_gap_rad"]


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
            directions = transitions.eased_turn(directions, seam.turn[side], to_seam_s, seam.window_s[side])
            yaw = transitions.eased_shift(yaw, seam.yaw[side], to_seam_s, seam.window_s[side])
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
    ends = [[transitions.end_of(p.root_m, p.time_s, last=last) for last in (False, True)] for p in placed]
    for k, seam in enumerate(met):
        before, after = transitions.shifts(ends[k][1], ends[k + 1][0])
        to_seam_s = placed[k].duration_s[:, None] - placed[k].time_s
        roots[k] = transitions.eased_shift(roots[k], before, to_seam_s, seam.window_s[0])
        roots[k + 1] = transitions.eased_shift(roots[k + 1], after, -placed[k + 1].time_s, seam.window_s[1])
    return roots


def _one(parts: Sequence[np.ndarray], keep: Sequence[slice]) -> np.ndarray:
    return np.concatenate([part[:, rows] for part, rows in zip(parts, keep, strict=True)], axis=1)


class JoinError(ValueError):
    """Motions that no join brings together."""


def joined(
    motions: Sequence[Motion], *, blend_s: float = BLEND_S, bone_length_m: np.ndarray | None = None, trial: str = ""
) -> Motion:
    """The motions one after another, as one body's.

    What differs at a seam (posture, heading's rate, height) is spread over ``blend_s`` before and after it, at most
    half a motion; outside nothing changes but place and heading. Durations add up, marks follow one another, speed is
    continuous, and feet on the floor stay there: the root follows them.

    bone_length_m : (B,) of the whole; None: the first motion's
    trial         : its name; "": those of the parts with "+" between. Covariates are those on which all agree
    Raises JoinError for no motions, mixed skeletons, or postures too far apart for the time (``most_gap_rad``): no
    transition is inserted, since durations would no longer add up.
    """
    motions = list(motions)
    _refuse(motions, blend_s)
    if len(motions) == 1 and bone_length_m is None:
        return motions[0]
    first = motions[0]
    bones_m = first.bone_length_m if bone_length_m is None else np.asarray(bone_length_m, float)
    whole = join_arrays(first.skeleton, [_course(m) for m in motions], bone_length_m=bones_m[None], blend_s=blend_s)
    start_s = np.concatenate([[0.0], np.cumsum([m.duration_s for m in motions])])
    return Motion(
        skeleton=first.skeleton,
        directions=whole.directions[0],
        time_s=whole.time_s[0],
        root_m=whole.root_m[0],
        yaw_rad=whole.yaw_rad[0],
        bone_length_m=bones_m,
        mark_s=np.concatenate([start + m.mark_s for start, m in zip(start_s[:-1], motions, strict=True)]),
        worker=first.worker,
        trial=trial or "+".join(m.trial for m in motions),
        covariates=_agreed(motions),
        start_m=first.start_m,
        start_yaw_rad=first.start_yaw_rad,
        stretch=None if whole.stretch is None else whole.stretch[0],
    )


def posture_gap_rad(before: Motion, after: Motion) -> float:
    """How far the end of one motion is from the start of the next: the angle of the bone that differs most."""
    return float(transitions.gap_rad(before.directions[-1], after.directions[0]))


def most_gap_rad(before: Motion, after: Motion, blend_s: float = BLEND_S) -> float:
    """The widest gap that ``joined`` closes: 1.92 rad (110 degrees) for 0.3 s on each side; see ``widest_gap_rad``."""
    seconds = float(np.min(windows_s(np.array(before.duration_s), np.array(after.duration_s), blend_s)))
    return min(widest_gap_rad(seconds), np.pi - 1e-6)


def _refuse(motions: Sequence[Motion], blend_s: float) -> None:
    """Raise JoinError with everything that is wrong."""
    if not motions:
        raise JoinError("joined: found no motions, expected one or more")
    if not 0 < blend_s < np.inf:
        raise JoinError(f"joined: blend_s: found {blend_s}, expected positive seconds")
    wrong = []
    for number, (before, after) in enumerate(pairwise(motions), start=1):
        seam = f"joined: seam {number} ({before.name} -> {after.name})"
        if after.skeleton != motions[0].skeleton:
            wrong.append(
                f"{seam}: found {difference(motions[0].skeleton, after.skeleton)}, expected one skeleton in all"
            )
        elif before.skeleton == after.skeleton:
            angle = transitions.sphere.angle(before.directions[-1], after.directions[0])
            most = most_gap_rad(before, after, blend_s)
            if angle.max() > most:
                joint = before.skeleton.bone_names[int(angle.argmax())]
                wrong.append(
                    f"{seam}: the bone to {joint} is {np.degrees(angle.max()):.0f} degrees away, expected at most "
                    f"{np.degrees(most):.0f} for the time there is; a longer blend_s, or a movement between"
                )
    if wrong:
        raise JoinError("\n".join(wrong))


def _course(motion: Motion) -> Course:
    return Course(
        motion.directions[None],
        motion.time_s[None],
        motion.root_m[None],
        motion.yaw_rad[None],
        motion.bone_length_m[None],
        None if motion.stretch is None else motion.stretch[None],
    )


def _agreed(motions: Sequence[Motion]) -> dict[str, object]:
    """The covariates that all have, with one value."""
    first, rest = motions[0].covariates, [m.covariates for m in motions[1:]]
    return {key: value for key, value in first.items() if all(key in c and c[key] == value for c in rest)}
