"""What cleaning found: repairs, what became of each take, and the recording as it was and as it is.

What is told of a take and left as it is: how far the body turns, and where it stands still.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from emulator.cleaning.settings import CleaningSettings
from emulator.geometry.pauses import find, moves
from emulator.motion import Motion, glitch, heading_rad, motion_from_positions
from emulator.recordings.take import Recording, Take
from emulator.skeleton import Skeleton

KINDS = {
    "swap": "two joints exchanged",
    "glitch": "a jump that no body can do",
    "jump": "a joint leaves and comes back",
    "slip": "a joint steps and does not come back",
    "gap": "not seen",
    "cut": "frames cut off",
    "bone": "a bone breathes",
    "offset": "an angle is offset",
    "angle": "an angle that no joint can do",
    "noise": "low-pass",
    "hold": "stands still",
    "heading": "turns",
    "still": "does not move",
}
"""Kinds of repairs, in the order of the work, in words."""
_NO_FAULT = ("hold", "heading")
BREATHES_PERCENT = 5.0
"""A take is told of if the length of a bone has this standard deviation; less is common in optical recordings."""


@dataclass(frozen=True)
class Repair:
    """One thing found in one take.

    take                    : the take's name
    kind                    : one of ``KINDS``
    joints                  : the joints it is about; none where it is the whole body
    first_frame, last_frame : in the take as it was read, both within
    size, unit              : how much, such as 0.12 m or 31 deg
    words                   : what was found and what was done about it
    mended                  : whether anything was changed; else it is only told
    bad                     : whether the take is bad for it: a fault that was left
    shortens                : whether frames are gone that were seen or lie within the movement
    """

    take: str
    kind: str
    joints: tuple[str, ...]
    first_frame: int
    last_frame: int
    size: float
    unit: str
    words: str
    mended: bool = True
    bad: bool = False
    shortens: bool = False

    @property
    def found(self) -> str:
        """The words without what was done about it."""
        return self.words.rpartition("; ")[0] or self.words

    def __str__(self) -> str:
        frames = (
            f"frame {self.first_frame}"
            if self.first_frame == self.last_frame
            else f"frames {self.first_frame} to {self.last_frame}"
        )
        return f"{self.take}: {frames}: {' and '.join(self.joints) or 'body'}: {self.words}"


@dataclass(frozen=True, eq=False)
class Cleaned:
    """A cleaned recording.

    recording : the takes that are left
    repairs   : everything found, take by take in the order of the recording
    before    : the recording as it was read
    left_out  : (take, why) of those that cannot be used
    """

    recording: Recording
    repairs: tuple[Repair, ...]
    before: Recording
    left_out: tuple[tuple[str, str], ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """What the takes that were read are called here."""
        return take_names(self.before)

    def of(self, take: str) -> tuple[Repair, ...]:
        """What was found in the take of this name."""
        return tuple(repair for repair in self.repairs if repair.take == take)

    def first_frame(self, take: str) -> int:
        """Where what is left of a take begins in the take that was read."""
        cuts = [repair.last_frame + 1 for repair in self.of(take) if repair.kind == "cut" and repair.first_frame == 0]
        return max(cuts, default=0)

    def pairs(self) -> Iterator[tuple[str, Take, Take]]:
        """Name, take before and take after, of those that are left."""
        left = [each for each in zip(self.names, self.before.takes) if each[0] not in dict(self.left_out)]
        for (name, before), after in zip(left, self.recording.takes, strict=True):
            yield name, before, after

    def verdict(self, take: str) -> str:
        """What became of it, the worst first: "left out", "bad" (a fault was left), "shortened", "repaired", "told"
        (something odd, not mended) or "good"; also "shortened, told" and "repaired, told".
        """
        return "left out" if take in dict(self.left_out) else verdict_of(self.of(take))


def take_names(recording: Recording) -> tuple[str, ...]:
    """The name of each take; where several have one name, the later ones with a number."""
    seen: dict[str, int] = {}
    names = []
    for take in recording.takes:
        seen[take.name] = seen.get(take.name, 0) + 1
        names.append(take.name if seen[take.name] == 1 else f"{take.name} ({seen[take.name]})")
    return tuple(names)


def verdict_of(repairs: Sequence[Repair]) -> str:
    """What is to be said of a take in which this was found. Pauses and turns are no faults."""
    if any(repair.bad for repair in repairs):
        return "bad"
    said = ["told"] if any(is_odd(repair) for repair in repairs) else []
    if any(repair.shortens for repair in repairs):
        said = ["shortened", *said]
    elif any(repair.mended and repair.kind not in _NO_FAULT for repair in repairs):
        said = ["repaired", *said]
    return ", ".join(said) or "good"


def is_odd(repair: Repair) -> bool:
    """Whether it was left and is something a body does not do: no pause, turn, or bone that breathes a little."""
    if repair.mended or repair.kind in _NO_FAULT:
        return False
    return repair.kind != "bone" or repair.size >= BREATHES_PERCENT


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
