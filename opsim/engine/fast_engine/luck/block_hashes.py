"""The hashes of block numbers, as they enter the keys of blocks: one table for all streams of a process."""

from __future__ import annotations

from threading import Lock

import numpy as np

from opsim.streams import _hashed

MOST_KEPT = 1 << 20
"""Of 64 items each. Blocks beyond are hashed each time they are asked for."""
_FIRST = 256


class BlockHashes:
    """A table that grows to twice its length where it ends; far beyond its end, blocks are hashed without it.

    NOTE: it is replaced whole, so who reads needs no lock.
    """

    def __init__(self) -> None:
        self._rows = np.empty((0, 2), np.uint32)
        self._lock = Lock()

    def of(self, first: int, n: int) -> np.ndarray:
        """(n, 2) uint32, C-contiguous: the hashes of blocks ``first`` and after."""
        rows = self._rows
        if first + n > len(rows):
            if first > 2 * max(len(rows), _FIRST) or first + n > MOST_KEPT:
                return _rows(first, first + n)
            rows = self._grown(first + n)
        return rows[first : first + n]

    def _grown(self, n: int) -> np.ndarray:
        with self._lock:
            known = self._rows
            if n > len(known):
                least = max(_FIRST, 1 << (n - 1).bit_length())
                self._rows = np.concatenate([known, _rows(len(known), least)])
            return self._rows


def _rows(first: int, end: int) -> np.ndarray:
    words = b"".join(map(_hashed, range(first, end)))
    return np.frombuffer(words, np.uint32).reshape(-1, 2).copy()


BLOCK_HASHES = BlockHashes()
