"""The lines of a journal: JSON lists that end with their own checksum, so that a damaged one is known as such.

A file that only grows, a whole line at a time.

Answers kept in files as they come: whatever ends the process, what is written stays and is read again.

A line an answer, ``[point, replication, workforce, set, values, check]``, and before the first answer of a kind a line
with its figures, ``[set, [[kpi, subject, part, unit], ...], check]``. In memory there is only where each answer stands.
"""

from __future__ import annotations

import json
import math
import os
import time
from collections.abc import Container, Iterable, Iterator, Sequence
from hashlib import blake2b
from pathlib import Path
from typing import IO, Any
from zlib import crc32

from opsim.files import whole_file
from opsim.results import Key
from opsim.study.jobs.job import Answer, keys_in

CHECK = len(', "01234567"]')


class Damaged(ValueError):
    """A line that is not what was written."""


def to_line(values: Sequence[Any]) -> bytes:
    """A list of plain values as one line; floats exactly, by ``repr``."""
    body = json.dumps(list(values), ensure_ascii=False, allow_nan=False)[:-1].encode()
    return body + b', "%08x"]\n' % crc32(body)


def from_line(line: bytes) -> list[Any]:
    """What was written. Raises Damaged, for a line without its end too."""
    body = line[: -CHECK - 1]
    if line[len(body) :] != b', "%08x"]\n' % crc32(body):
        raise Damaged("not a line of a journal")
    values: list[Any] = json.loads(body + b"]")
    return values


def plain_number(value: float) -> float | str | None:
    """A float for JSON: nan is null, an infinite one is text."""
    if math.isfinite(value):
        return float(value)
    return None if math.isnan(value) else str(float(value))


def number(plain: float | str | None) -> float:
    """The float again."""
    return math.nan if plain is None else float(plain)


FSYNC_EVERY_S = 1.0


class Appended:
    """A file to whose end lines are added; about once a second all of them are on the disk."""

    def __init__(self, path: Path, end: int):
        """end : what stands behind it (a line that was not finished) is cut off. Raises OSError."""
        self.path, self.end = path, end
        self._file = os.open(path, os.O_RDWR | getattr(os, "O_BINARY", 0))
        os.ftruncate(self._file, end)
        self._synced_s = time.monotonic()

    def add(self, line: bytes) -> int:
        """The offset at which the line begins. Raises OSError, and then the file is as it was before."""
        begin = self.end
        try:
            os.lseek(self._file, begin, os.SEEK_SET)
            written = 0
            while written < len(line):
                written += os.write(self._file, line[written:])
            self.end = begin + len(line)
            self._sync_sometimes()
        except OSError as error:
            self._cut(begin)
            raise OSError(error.errno, error.strerror, str(self.path)) from error
        return begin

    def close(self) -> None:
        """All lines on the disk, and the file let go."""
        if self._file < 0:
            return
        try:
            os.fsync(self._file)
        finally:
            os.close(self._file)
            self._file = -1

    def _sync_sometimes(self) -> None:
        if time.monotonic() - self._synced_s >= FSYNC_EVERY_S:
            os.fsync(self._file)
            self._synced_s = time.monotonic()

    def _cut(self, end: int) -> None:
        self.end = end
        os.ftruncate(self._file, end)


Address = tuple[str, int, int]
"""(what decides the answers of a point, replication, workforce or -1)"""


class Journal:
    """The answers in any number of files, to one of which this process may add.

    damaged : lines that cannot be read, as ``file:line``; their answers count as not there
    twice   : where another answer to the same job stands than in an earlier file
    """

    def __init__(self, files: Iterable[Path] = (), own: Path | None = None):
        """files : read as they are now. own : made or cut behind its last whole line, and gone on with. Raises OSError.

        Damaged lines of ``own`` are taken out.

        NOTE: nobody else may write to ``own``; see opsim/study/results_folder.py.
        """
        self.damaged: list[str] = []
        self.twice: list[str] = []
        self._places: dict[str, dict[tuple[int, int], tuple[int, int, list[Key]]]] = {}
        self._files: list[IO[bytes]] = []
        self._sets: dict[str, list[Key]] = {}
        self._said: set[str] = set()
        self._own: Appended | None = None
        try:
            for path in files:
                self._read_file(path)
            if own is not None:
                own.parent.mkdir(parents=True, exist_ok=True)
                own.touch()
                self._own = Appended(own, self._read_mended(own))
                self._said = self._in_file
                self._files.append(own.open("rb"))  # anew: what was read ahead may just have been cut off
                self._files.pop(-2).close()
        except BaseException:
            self.close()
            raise

    def __contains__(self, address: Address) -> bool:
        return address[1:] in self._places.get(address[0], ())

    def __iter__(self) -> Iterator[Address]:
        return ((point, *rest) for point, places in self._places.items() for rest in places)

    def __len__(self) -> int:
        return sum(map(len, self._places.values()))

    def add(self, address: Address, answer: Answer) -> None:
        """Keep an answer: it is in the file when this returns. Raises OSError; the file is then as it was before."""
        if self._own is None:
            raise ValueError("a journal without a file of its own")
        name = blake2b(answer.figures.encode(), digest_size=6).hexdigest()
        if name not in self._said:
            self._sets.setdefault(name, keys_in(answer.figures))
            self._own.add(to_line([name, json.loads(answer.figures)]))
            self._said.add(name)
        at = self._own.add(to_line([*address, name, [plain_number(value) for value in answer.values]]))
        self._places.setdefault(address[0], {})[address[1:]] = len(self._files) - 1, at, self._sets[name]

    def keys(self, address: Address) -> list[Key]:
        """The figures of an answer that is there; one list for all that have the same, not to be changed."""
        return self._places[address[0]][address[1:]][2]

    def values(self, address: Address) -> list[float]:
        """The numbers of an answer that is there, in the order of its keys. Raises OSError."""
        file, at, _ = self._places[address[0]][address[1:]]
        self._files[file].seek(at)
        return [number(value) for value in from_line(self._files[file].readline())[4]]

    def close(self) -> None:
        """All answers on the disk, and the files let go."""
        if self._own is not None:
            self._own.close()
            self._own = None
        for file in self._files:
            file.close()
        self._files.clear()

    def _read_mended(self, own: Path) -> int:
        """As ``_read_file``; lines that are not what was written are told this once, and taken out of the file.

        What cannot be taken out, as on a full disk, is told again the next time.
        """
        twice = list(self.twice)
        end = self._read_file(own)
        if not self._broken:
            return end
        try:
            with whole_file(own) as mended, mended.open("wb") as file:
                file.writelines(_whole_lines(own, end, self._broken))
        except OSError:
            return end
        self._files.pop().close()
        number_of_own, damaged, self.twice = len(self._files), self.damaged, twice
        for point, places in self._places.items():
            self._places[point] = {job: place for job, place in places.items() if place[0] != number_of_own}
        end = self._read_file(own)
        self.damaged = damaged
        return end

    def _read_file(self, path: Path) -> int:
        """Learn where the answers of a file stand; the offset behind its last whole line."""
        file = path.open("rb")
        self._files.append(file)
        self._in_file: set[str] = set()
        self._broken: set[int] = set()
        offset, unknown = 0, []
        for line_number, line in enumerate(iter(file.readline, b""), 1):
            if not line.endswith(b"\n"):
                break  # torn: who wrote it was killed, or is at it now
            if (of_unknown := self._learn(line, f"{path}:{line_number}", offset)) is not None:
                unknown.append(of_unknown)
            offset += len(line)
        for place, name, address, at in unknown:
            self._place(place, name, address, at)
        return offset

    def _learn(self, line: bytes, place: str, at: int) -> tuple[str, str, Address, int] | None:
        """Learn from one line; returned is an answer whose figures did not come before it."""
        try:
            said = from_line(line)
            if len(said) == 2:
                self._sets.setdefault(said[0], keys_in(json.dumps(said[1])))
                self._in_file.add(said[0])
                return None
            point, replication, workforce, name, _ = said
        except ValueError as error:
            self.damaged.append(place)
            if isinstance(error, Damaged):
                self._broken.add(at)
            return None
        if name not in self._sets:
            return place, name, (point, replication, workforce), at
        self._place(place, name, (point, replication, workforce), at)
        return None

    def _place(self, place: str, name: str, address: Address, at: int) -> None:
        if name not in self._sets:
            self.damaged.append(place)
            return
        before = self._raw(address) if address in self else None
        self._places.setdefault(address[0], {})[address[1:]] = len(self._files) - 1, at, self._sets[name]
        if before is not None and before != self._raw(address):
            self.twice.append(place)

    def _raw(self, address: Address) -> tuple[list[Key], list[float | str | None]]:
        """An answer as it is written, to be compared."""
        file, at, keys = self._places[address[0]][address[1:]]
        here = self._files[file].tell()
        self._files[file].seek(at)
        values = from_line(self._files[file].readline())[4]
        self._files[file].seek(here)
        return keys, values


def _whole_lines(path: Path, end: int, broken: Container[int]) -> Iterator[bytes]:
    """The lines of a file up to an offset without those that begin at some."""
    offset = 0
    with path.open("rb") as file:
        while offset < end:
            line = file.readline()
            if offset not in broken:
                yield line
            offset += len(line)
