"""A file that only grows, a whole line at a time."""

from __future__ import annotations

import os
import time
from pathlib import Path

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
