"""Room for the columns of a log: as much as the last run needed, and twice as much where that is not enough."""

from __future__ import annotations

import ctypes
from contextlib import suppress

import numpy as np

from opsim.engine.fast_engine.columns import AT_ONCE, in_order
from opsim.engine.fast_engine.leases import lent
from opsim.engine.fast_engine.machine import Arena, Handle
from opsim.engine.fast_engine.machine.arena import MORE
from opsim.engine.fast_engine.machine.layouts import LAYOUTS, WORD
from opsim.engine.fast_engine.parts.rows import ROW_BYTES
from opsim.log import COLUMNS

FEWEST = 1 << 14
_AT = {name: field.at // WORD for name, field in LAYOUTS["Columns"].fields.items()}


class Columns:
    """Of one floor, run after run."""

    def __init__(self, arena: Arena, floor: Handle):
        self.floor, handle = floor, arena.new("Columns")
        self._words = (ctypes.c_int64 * len(_AT)).from_address(handle.address)
        self._more = MORE(self._give_more)
        floor.more_rows = ctypes.cast(self._more, ctypes.c_void_p).value
        floor.columns = handle
        floor.row_first = floor.row_at = arena.take(AT_ONCE * ROW_BYTES)
        floor.row_end = floor.row_first + AT_ONCE * ROW_BYTES
        floor.row_order = arena.take(AT_ONCE * 8)
        self._n = FEWEST
        self._arrays: dict[str, np.ndarray] = {}

    def begin(self) -> None:
        """A run begins: nothing is written yet."""
        self._arrays = _arrays(self._n)
        self._say(self._n)

    def end(self) -> dict[str, np.ndarray]:
        """The columns that were written; they are the caller's from now on."""
        n = self.floor.n_rows
        self._n = max(FEWEST, n + n // 16)
        found = {name: column[:n] for name, column in self._arrays.items()}
        self._arrays = {}
        return in_order(found) if self.floor.unordered else found

    def _give_more(self, _: int, n_rows: int) -> int:
        """Called by the engine: room for so many rows at least. It raises MemoryError where there is none."""
        with suppress(MemoryError):
            room, n, before = max(2 * self.floor.room, n_rows), self.floor.n_rows, self._arrays
            self._arrays = _arrays(room)
            for name, column in before.items():
                self._arrays[name][:n] = column[:n]
            self._say(room)
        return 0

    def _say(self, room: int) -> None:
        for name, column in self._arrays.items():
            self._words[_AT[name]] = column.__array_interface__["data"][0]
        self.floor.room = room


def _arrays(n_rows: int) -> dict[str, np.ndarray]:
    """A column each, side by side in memory that is lent."""
    sizes = [-(-n_rows * np.dtype(kind).itemsize // 64) * 64 for kind in COLUMNS.values()]
    memory, at = lent(sum(sizes)), 0
    found: dict[str, np.ndarray] = {}
    for (name, kind), size in zip(COLUMNS.items(), sizes):
        found[name] = memory[at : at + size].view(kind)[:n_rows]
        at += size
    return found
