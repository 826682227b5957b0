"""What is told of a take and left as it is: how far the body turns, and where it stands still."""

from __future__ import annotations

import numpy as np

from emulator.clean import glitch, heading_rad
from emulator.cleaning.found import Repair
from emulator.cleaning.settings import CleaningSettings
from emulator.motion import Motion, motion_from_positions
from emulator.recordings.take import Take
from emulator.skeleton import Skeleton
from emulator.stillness import find, moves

LEAST_TURN_DEG = 45.0
STILL_M, AWAY_M_PER_RAD = 0.05, 1.0
"""A body whose pelvis stays within this has not moved; a radian of heading counts as a metre."""


def told(take: Take, settings: CleaningSettings) -> tuple[Repair, ...]:
    """Its turn in degrees (heading unwrapped: a full turn is 360), its pauses in seconds, that it is still."""
    motion = _motion(take)
    if motion is None:
        return ()
    return (*_turn(take, motion, settings), *_still(take, motion, settings), *_holds(take, motion, settings))


def impossible(take: Take) -> tuple[Repair, ...]:
    """That a joint is still faster than any body, by the rule by which a fit leaves repetitions out."""
    said = glitch(take.positions_m, take.rate_hz) if take.n_frames > 1 else "positions are missing"
    if not said:
        return ()
    speed = np.linalg.norm(np.diff(take.positions_m, axis=0), axis=-1) * take.rate_hz
    frame, joint = np.unravel_index(int(np.argmax(np.nan_to_num(speed, nan=-1.0))), speed.shape)
    worst = float(speed[frame, joint])
    frames = (int(frame), int(frame) + 1)
    return (Repair(take.name, "glitch", (take.names[joint],), *frames, worst, "m/s", said, False, True),)


def _motion(take: Take) -> Motion | None:
    """The take as a motion, where it is a body with hips."""
    if take.parents is None or not {"left_hip", "right_hip"} <= set(take.names) or take.n_frames < 2:
        return None
    skeleton = Skeleton(take.names, take.parents)
    try:
        heading_rad(skeleton, take.positions_m)
        return motion_from_positions(skeleton, take.positions_m, take.rate_hz, worker=take.worker, trial=take.trial)
    except ValueError:  # a bone without length, or somebody who lies on his side all the time
        return None


def _turn(take: Take, motion: Motion, settings: CleaningSettings) -> tuple[Repair, ...]:
    turn = float(np.degrees(motion.yaw_rad[-1]))
    if settings.heading == "off" or abs(turn) < LEAST_TURN_DEG:
        return ()
    words = f"turns by {turn:+.0f} deg from the first frame to the last; left as it is"
    return (Repair(take.name, "heading", (), 0, take.n_frames - 1, abs(turn), "deg", words, False),)


def _still(take: Take, motion: Motion, settings: CleaningSettings) -> tuple[Repair, ...]:
    """That nothing moves: no bone, and the body stays in its place and heading."""
    away = max(float(np.ptp(motion.root_m, axis=0).max()), float(np.ptp(motion.yaw_rad)) * AWAY_M_PER_RAD)
    if settings.holds == "off" or moves(motion) or away > STILL_M:
        return ()
    words = f"does not move for all of its {take.duration_s:.2f} s; left as it is"
    return (Repair(take.name, "still", (), 0, take.n_frames - 1, take.duration_s, "s", words, False),)


def _holds(take: Take, motion: Motion, settings: CleaningSettings) -> tuple[Repair, ...]:
    if settings.holds == "off":
        return ()
    return tuple(
        Repair(
            take.name, "hold", (), first, last, (last - first) / take.rate_hz, "s",
            f"stands still for {(last - first) / take.rate_hz:.2f} s; left as it is", False,
        )
        for first, last in find(motion)
    )  # fmt: skip
