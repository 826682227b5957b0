"""The HIERARCHY of a BVH file: joints, offsets and channels out of words, all mistakes with their lines."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path

from emulator.recordings.text import RecordingError, finite, quoted

CHANNELS = ("Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation")
_CHANNEL = {name.lower(): name for name in CHANNELS}
MOST_JOINTS = 2000
"""A face has hundreds; more is a damaged or hostile file."""
MOST_WORDS = 50 * MOST_JOINTS
MOST_CHANNELS = len(CHANNELS)
MOST_TOLD = 20
_WORDS = ("ROOT", "JOINT", "END", "OFFSET", "CHANNELS", "{", "}", "MOTION")
Word = tuple[str, int]


@dataclass
class Joint:
    """A joint while it is read; ``channels`` and ``offset`` are None until the file says them."""

    name: str
    line: int
    parent: int
    is_end: bool = False
    offset: tuple[float, ...] | None = None
    channels: tuple[str, ...] | None = None


@dataclass
class HierarchyReader:
    """Words in, joints out. Nesting is a list, not recursion, so that depth costs nothing."""

    path: Path
    words: list[Word]
    at: int = 0
    joints: list[Joint] = field(default_factory=list)
    mistakes: list[tuple[int, str]] = field(default_factory=list)

    def read(self) -> list[Joint]:
        """All joints and end sites, parents first. Raises RecordingError with every mistake that was found."""
        self._keyword("HIERARCHY")
        self._open(self._keyword("ROOT"), parent=-1)
        within = [0]
        while within:
            self._inside(within)
        self._whole()
        self._end_of_hierarchy()
        if self.mistakes:
            self._refuse()
        return self.joints

    def _inside(self, within: list[int]) -> None:
        """One statement of the innermost joint."""
        word, line = self._next("'}' of joint " + quoted(self.joints[within[-1]].name))
        known = word.upper()
        if known == "}":
            within.pop()
        elif known in ("JOINT", "END"):
            self._open(line, parent=within[-1], is_end=known == "END")
            within.append(len(self.joints) - 1)
        elif known == "OFFSET":
            self._offset(self.joints[within[-1]], line)
        elif known == "CHANNELS":
            self._channels(self.joints[within[-1]], line)
        else:
            near = get_close_matches(known, ("JOINT", "OFFSET", "CHANNELS"), n=1)
            hint = f"; did you mean {near[0]}?" if near else ""
            self._stop(line, f"found {quoted(word)}, expected OFFSET, CHANNELS, JOINT, End Site or '}}'{hint}")

    def _open(self, line: int, parent: int, is_end: bool = False) -> None:
        words: list[str] = []
        while (found := self._next("'{'"))[0] != "{":
            if found[0] == "}" or found[0].upper() in ("OFFSET", "CHANNELS") or len(words) > 20:
                self._stop(found[1], f"found {quoted(found[0])}, expected '{{'")
            words.append(found[0])
        name = " ".join(words)
        if is_end and (not words or words[0].upper() != "SITE"):
            self._wrong(line, f"found {quoted('End ' + name)}, expected 'End Site'")
        if not is_end and not name:
            self._wrong(line, "found a joint without a name")
        if len(self.joints) >= MOST_JOINTS:
            self._stop(line, f"found more than {MOST_JOINTS:,} joints, expected a body")
        self.joints.append(Joint(name, line, parent, is_end))

    def _offset(self, joint: Joint, line: int) -> None:
        if joint.offset is not None:
            self._wrong(line, f"found a second OFFSET of {quoted(joint.name)}, expected one")
        values = [self._number(*self._next("three numbers")) for _ in range(3)]
        joint.offset = tuple(values)

    def _number(self, word: str, line: int) -> float:
        value = finite(word)
        if value is None:
            if word.upper() in _WORDS:
                self._stop(line, f"found {quoted(word)}, expected three numbers after OFFSET")
            self._wrong(line, f"OFFSET: found {quoted(word)}, expected a number")
        return value or 0.0

    def _channels(self, joint: Joint, line: int) -> None:
        said, _ = self._next("a number of channels")
        words: list[str] = []
        while self._is_channel(line) and len(words) < 100:
            words.append(self._next("channels")[0])
        if joint.channels is not None:
            self._wrong(line, f"found second CHANNELS of {quoted(joint.name)}, expected one")
        if joint.is_end:
            self._wrong(line, "found CHANNELS in an End Site, expected OFFSET only")
        if said != str(len(words)) or len(words) > MOST_CHANNELS:
            expected = f"0 to {MOST_CHANNELS}" if said == str(len(words)) else quoted(said)
            self._wrong(line, f"found {len(words)} channels of {quoted(joint.name)}, expected {expected}")
        joint.channels = tuple(self._channel(word, line) for word in words)
        moved = [word.lower() for word in words if word.lower() in _CHANNEL and word.lower().endswith("position")]
        if len(set(moved)) < len(moved):
            self._wrong(line, f"found a position channel of {quoted(joint.name)} twice")

    def _is_channel(self, line: int) -> bool:
        """Whether the next word is one, or stands where one belongs."""
        if self.at >= len(self.words):
            return False
        word, its_line = self.words[self.at]
        return word.lower() in _CHANNEL or (its_line == line and word.upper() not in _WORDS)

    def _channel(self, word: str, line: int) -> str:
        known = _CHANNEL.get(word.lower())
        if known is None:
            near = get_close_matches(word.lower(), _CHANNEL, n=1)
            hint = f"; did you mean {_CHANNEL[near[0]]}?" if near else f"; known: {', '.join(CHANNELS)}"
            self._wrong(line, f"found channel {quoted(word)}{hint}")
        return known or CHANNELS[0]

    def _whole(self) -> None:
        """Every joint has an OFFSET and a name of its own, and something moves."""
        first: dict[str, int] = {}
        for joint in self.joints:
            if joint.offset is None:
                self._wrong(joint.line, f"found no OFFSET of {quoted(joint.name)}, expected one")
            if not joint.is_end and joint.name in first:
                where = f"line {first[joint.name]} has one"
                self._wrong(joint.line, f"found joint {quoted(joint.name)} again, expected each name once ({where})")
            first.setdefault(joint.name, joint.line)
        if not any(joint.channels for joint in self.joints):
            self._wrong(1, "found no CHANNELS, expected those of ROOT at least")

    def _end_of_hierarchy(self) -> None:
        if self.at < len(self.words):
            word, line = self.words[self.at]
            what = "a second ROOT" if word.upper() == "ROOT" else quoted(word)
            self._wrong(line, f"found {what} after the hierarchy, expected MOTION")

    def _keyword(self, expected: str) -> int:
        word, line = self._next(expected)
        if word.upper() != expected:
            self._stop(line, f"found {quoted(word)}, expected {expected}")
        return line

    def _next(self, expected: str) -> Word:
        if self.at >= len(self.words):
            self._stop(self.words[-1][1] if self.words else 1, f"found the end of the hierarchy, expected {expected}")
        self.at += 1
        return self.words[self.at - 1]

    def _wrong(self, line: int, what: str) -> None:
        self.mistakes.append((line, what))
        if len(self.mistakes) >= MOST_TOLD:
            self._refuse()

    def _stop(self, line: int, what: str) -> None:
        """A mistake after which nothing can be told apart."""
        self._wrong(line, what)
        self._refuse()

    def _refuse(self) -> None:
        told = sorted(self.mistakes, key=lambda mistake: mistake[0])
        raise RecordingError("\n".join(f"{self.path}:{line}: {what}" for line, what in told))


def words_of(text: str) -> Iterator[Word]:
    """Words with their lines; braces stand alone however they are written."""
    for number, line in enumerate(text.split("\n"), 1):
        for word in line.replace("{", " { ").replace("}", " } ").split():
            yield word, number
