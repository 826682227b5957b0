"""One motion after another: at a common posture, with continuous speed, durations adding up."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from emulator import seams
from emulator.courses import BLEND_S, FASTEST_RAD_PER_S, Course, difference, widest_gap_rad, windows_s
from emulator.join_arrays import join_arrays
from emulator.motion import Motion

__all__ = ["BLEND_S", "FASTEST_RAD_PER_S", "JoinError", "joined", "most_gap_rad", "posture_gap_rad"]


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
    return float(seams.gap_rad(before.directions[-1], after.directions[0]))


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
            angle = seams.sphere.angle(before.directions[-1], after.directions[0])
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
