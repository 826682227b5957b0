"""What cleaning found: repairs, what became of each take, and the recording as it was and as it is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from emulator.recordings.take import Recording, Take

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
