"""AMC: for each frame the values of each bone, a line a bone."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.acclaim import Acclaim
from emulator.recordings.text import finite, quoted, text_lines


@dataclass(frozen=True, eq=False)
class AmcValues:
    """``values`` (T, C) in the order of the skeleton's bones and freedoms; ``rate_hz`` None where none is said."""

    values: np.ndarray
    in_degrees: bool = True
    rate_hz: float | None = None


def read_amc_values(path: str | Path, skeleton: Acclaim) -> AmcValues:
    """All frames. Raises RecordingError with file, line, what was found and expected, at the first mistake."""
    return _Reader(Path(path), skeleton).read()


class _Reader:
    """A frame is filled bone by bone and joins the others once it is whole: memory follows what the file holds."""

    def __init__(self, path: Path, skeleton: Acclaim) -> None:
        self.path, self.line = path, 1
        self.in_degrees = True
        self.rate_hz: float | None = None
        self.places: dict[str, tuple[int, int]] = {}
        at = 0
        for bone in skeleton.bones:
            if bone.dof:
                self.places[bone.name] = (at, len(bone.dof))
            at += len(bone.dof)
        self.known = skeleton.names
        self.values = array("d")
        self.frame = [0.0] * at
        self.told: set[str] = set()
        self.number: int | None = None

    def read(self) -> AmcValues:
        for line, text in text_lines(self.path):
            self.line = line
            words = text.split()
            if not words or words[0].startswith("#"):
                continue
            if words[0].startswith(":"):
                self._directive(words)
            elif len(words) == 1 and words[0].isascii() and words[0].isdigit():
                self._next_frame(words[0])
            else:
                self._bone(words)
        if self.number is None:
            self._stop("found no frame, expected a line with its number")
        self._finish()
        if not self.frame:
            self._stop("found a skeleton without freedoms, expected those of the root at least")
        values = np.frombuffer(self.values, float).reshape(-1, len(self.frame))
        return AmcValues(values, self.in_degrees, self.rate_hz)

    def _directive(self, words: list[str]) -> None:
        key = words[0].upper()
        if key == ":RADIANS":
            self.in_degrees = False
        elif key == ":SAMPLES-PER-SECOND":
            rate = finite(words[1]) if len(words) == 2 else None
            if rate is None or rate <= 0:
                self._stop(f"found {quoted(' '.join(words[1:]))} samples a second, expected a positive number")
            self.rate_hz = rate

    def _next_frame(self, word: str) -> None:
        number = int(word) if len(word) < 19 else -1
        if self.number is not None:
            self._finish()
            if number != self.number + 1:
                self._stop(f"found frame {quoted(word)} after {self.number}, expected {self.number + 1}")
        self.number = number

    def _finish(self) -> None:
        """The frame that ends here has every bone."""
        if len(self.told) < len(self.places):
            missing = [name for name in self.places if name not in self.told]
            some = ", ".join(missing[:3]) + ", ..." * (len(missing) > 3)
            self._stop(f"found the end of frame {self.number} without {some}, expected all {len(self.places)} bones")
        self.values.extend(self.frame)
        self.told.clear()

    def _bone(self, words: list[str]) -> None:
        name = words[0]
        place = self.places.get(name)
        if self.number is None:
            self._stop(f"found {quoted(' '.join(words))}, expected a frame's number first")
        if place is None:
            self._stop(f"found {quoted(name)}, {self._expected(name)}")
            return
        if name in self.told:
            self._stop(f"found {quoted(name)} again in frame {self.number}, expected each bone once")
        at, count = place
        if len(words) != count + 1:
            self._stop(f"found {len(words) - 1} values of {quoted(name)}, expected {count}")
        self.frame[at : at + count] = self._numbers(words[1:])
        self.told.add(name)

    def _numbers(self, words: list[str]) -> Iterator[float]:
        for word in words:
            value = finite(word)
            if value is None:
                self._stop(f"found {quoted(word)}, expected a number")
            yield value or 0.0

    def _expected(self, name: str) -> str:
        if name in self.known:
            return "expected no values: the skeleton gives this bone no dof"
        near = get_close_matches(name, self.places, n=1)
        return f"did you mean {near[0]!r}?" if near else f"expected one of {', '.join(list(self.places)[:6])}, ..."

    def _stop(self, what: str) -> None:
        raise RecordingError(f"{self.path}:{self.line}: {what}")
