"""What no model can be fitted to: repetitions with mistakes that nothing mends, all named at once."""

from __future__ import annotations

import numpy as np

from emulator.motion import Motion, MotionSet

FEWEST_FRAMES = 4
"""A movement of fewer frames is only its ends."""
_MOST = 10


def refuse_unsound(motions: MotionSet) -> None:
    """Raises ValueError that names every repetition with a mistake: missing numbers, too few frames, wrong marks."""
    wrong = [f"{motions.task}: {m.name}: {why}" for m in motions.motions for why in _mistakes(m, motions.mark_names)]
    if wrong:
        more = [f"{motions.task}: and {len(wrong) - _MOST} more"] if len(wrong) > _MOST else []
        raise ValueError("\n".join([*wrong[:_MOST], *more]))


def _mistakes(motion: Motion, mark_names: tuple[str, ...]) -> list[str]:
    bones = motion.skeleton.bone_names
    wrong = []
    if len(motion.time_s) < FEWEST_FRAMES:
        wrong.append(f"found {len(motion.time_s)} frames, expected {FEWEST_FRAMES} or more")
    square = np.einsum("tbc,tbc->tb", motion.directions, motion.directions)
    for frame, bone in np.argwhere(~(np.abs(square - 1.0) <= 2e-6))[:1]:
        if np.isfinite(square[frame, bone]):
            wrong.append(f"the direction of {bones[bone]} at frame {frame} has another length than 1")
        else:
            wrong.append(f"the direction of {bones[bone]} is no number at frame {frame}")
    for name in ("root_m", "yaw_rad", "time_s"):
        values = np.asarray(getattr(motion, name)).reshape(len(motion.time_s), -1)
        if not np.all(np.isfinite(values)):
            wrong.append(f"{name} is no number at frame {int(np.argwhere(~np.isfinite(values))[0, 0])}")
    for bone in np.flatnonzero(~(np.isfinite(motion.bone_length_m) & (motion.bone_length_m > 0))):
        wrong.append(f"the bone to {bones[bone]} has length {motion.bone_length_m[bone]:g} m, expected a positive one")
    return wrong + _mark_mistakes(motion, mark_names)


def _mark_mistakes(motion: Motion, mark_names: tuple[str, ...]) -> list[str]:
    outside = [
        f"mark {name} at {at:g} s, expected 0 to {motion.duration_s:g} s"
        for name, at in zip(mark_names, motion.mark_s)
        if not 0 <= at <= motion.duration_s * (1 + 1e-9)
    ]
    if outside or not np.any(np.diff(motion.mark_s) < 0):
        return outside
    return [f"marks {', '.join(mark_names)} at {', '.join(f'{at:g}' for at in motion.mark_s)} s: out of order"]
