"""Room for the columns of a log: as much as the last run needed, and twice as much where that is not enough."""

from __future__ import annotations

import ctypes
from contextlib import suppress
from typing import Any

import numpy as np

from opsim.engine.fast_engine.columns import AT_ONCE, in_order
from opsim.engine.fast_engine.leases import lent
from opsim.engine.fast_engine.machine import Arena, Handle
from opsim.engine.fast_engine.machine.arena import MORE
from opsim.engine.fast_engine.machine.layouts import LAYOUTS
from opsim.engine.fast_engine.parts.rows import ROW_BYTES
from opsim.log import COLUMNS

FEWEST = (1 << 14) + 64
_KINDS = {name: np.dtype(kind) for name, kind in COLUMNS.items()}
_ENDS = np.cumsum([kind.itemsize for kind in _KINDS.values()])
ROOM_BYTES = int(_ENDS[-1])
"""Of one row in all columns."""
_STARTS = _ENDS - [kind.itemsize for kind in _KINDS.values()]
"""Bytes of a row in the columns before each."""


class Columns:
    """Of one floor, run after run: side by side in memory that is lent, whole pieces of 64 bytes each."""

    def __init__(self, arena: Arena, floor: Handle):
        self.floor, handle = floor, arena.new("Columns")
        assert list(LAYOUTS["Columns"].fields) == list(COLUMNS), "addresses are not in the order of the columns"
        words: Any = (ctypes.c_int64 * len(COLUMNS)).from_address(handle.address)
        self._words = np.frombuffer(words, np.int64)
        self._more = MORE(self._give_more)
        floor.more_rows = ctypes.cast(self._more, ctypes.c_void_p).value
        floor.columns = handle
        floor.row_first = floor.row_at = arena.take(AT_ONCE * ROW_BYTES)
        floor.row_end = floor.row_first + AT_ONCE * ROW_BYTES
        floor.row_order = arena.take(AT_ONCE * 8)
        self._n = self._room = FEWEST
        self._memory = np.empty(0, np.uint8)

    def begin(self) -> None:
        """A run begins: nothing is written yet."""
        self._take(self._n)

    def end(self) -> dict[str, np.ndarray]:
        """The columns that were written; they are the caller's from now on."""
        n = self.floor.n_rows
        self._n = max(FEWEST, n + n // 16)
        found, self._memory = self._written(n), np.empty(0, np.uint8)
        return in_order(found) if self.floor.unordered else found

    def _written(self, n: int) -> dict[str, np.ndarray]:
        """The first n rows."""
        starts = (self._room * _STARTS).tolist()
        return {name: np.ndarray(n, kind, self._memory, at) for (name, kind), at in zip(_KINDS.items(), starts)}

    def _give_more(self, _: int, n_rows: int) -> int:
        """Called by the engine: room for so many rows at least. It raises MemoryError where there is none."""
        with suppress(MemoryError):
            n = self.floor.n_rows
            before = self._written(n)
            self._take(max(2 * self._room, n_rows))
            for old, new in zip(before.values(), self._written(n).values()):
                new[:] = old
        return 0

    def _take(self, n_rows: int) -> None:
        """Room for so many rows or some more.

        NOTE: an odd number of pieces. Of an even one columns lie whole pages apart, which the fastest memory keeps in
        the same few places: that took 1 to 3 % of a run.
        """
        room = 64 * (-(-n_rows // 64) | 1)
        self._memory, self._room = lent(room * ROOM_BYTES), room
        np.add(room * _STARTS, self._memory.__array_interface__["data"][0], out=self._words)
        self.floor.room = room
