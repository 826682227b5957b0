"""The memory of a floor seen from Python: where it is set up before a run, and looked at after it."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Iterator
from contextlib import suppress
from typing import Any

import numpy as np

from opsim.engine.fast_engine.machine.lists import CLASSES, DATA, FIRST, ROOM, N
from opsim.engine.fast_engine.machine.structs import LAYOUTS, WORD, Field

CHUNK = 1 << 18
_INT, _FLOAT = ctypes.c_int64, ctypes.c_double
MORE = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)


class Arena:
    """Chunks of memory, and the Memory struct that the engine takes more from.

    ``freeze`` keeps what was set up; ``restore`` has it again, at the same addresses, for the next run.
    """

    def __init__(self) -> None:
        self._chunks: list[np.ndarray] = []
        self._next = 0
        self._at = self._end = 0
        self._frozen: tuple[list[tuple[int, np.ndarray]], int, int, int] | None = None
        self._more = MORE(lambda _, n_bytes: self._give_more(n_bytes))
        self.memory = self.new("Memory")
        self.memory.more = ctypes.cast(self._more, ctypes.c_void_p).value
        self.memory.free = self.array("int", [0] * CLASSES)

    @property
    def n_bytes(self) -> int:
        """Of all chunks."""
        return sum(chunk.nbytes for chunk in self._chunks)

    def new(self, struct: str) -> Handle:
        """A struct, all of it 0."""
        return Handle(struct, self.take(LAYOUTS[struct].size), self)

    def array(self, of: str, values: Iterable[Any]) -> int:
        """Address of an array of numbers or structs."""
        words = list(values)
        at = self.take(max(1, len(words)) * WORD)
        for i, value in enumerate(words):
            _write(at + i * WORD, of, value)
        return at

    def take(self, n_bytes: int) -> int:
        """Address of so many bytes, all 0, at a multiple of 16."""
        n_bytes = -(-n_bytes // 16) * 16
        if self._at + n_bytes > self._end:
            self._open_chunk(n_bytes)
        at, self._at = self._at, self._at + n_bytes
        ctypes.memset(at, 0, n_bytes)
        return at

    def freeze(self) -> None:
        """Keep all that was set up. From now on memory is the engine's to take."""
        self.memory.at, self.memory.end = self._at, self._end
        used = [(chunk.ctypes.data, chunk.copy()) for chunk in self._chunks[: self._next]]
        self._frozen = used, self._next, self._at, self._end

    def restore(self) -> None:
        """All as it was when it was frozen."""
        assert self._frozen is not None
        used, self._next, self._at, self._end = self._frozen
        for at, copy in used:
            ctypes.memmove(at, copy.ctypes.data, copy.nbytes)

    def _open_chunk(self, n_bytes: int) -> None:
        """The next chunk with so much room: one that was there before, or a new one, twice as large as the last."""
        while self._next < len(self._chunks) and self._chunks[self._next].nbytes < n_bytes + 16:
            self._next += 1
        if self._next == len(self._chunks):
            larger = self._chunks[-1].nbytes * 2 if self._chunks else CHUNK
            self._chunks.append(np.zeros(max(min(larger, 64 * CHUNK), n_bytes + 16), dtype=np.uint8))
        chunk = self._chunks[self._next]
        self._next += 1
        self._at = -(-chunk.ctypes.data // 16) * 16
        self._end = chunk.ctypes.data + chunk.nbytes

    def _give_more(self, n_bytes: int) -> int:
        """Called by the engine, which takes from the new chunk then, or raises MemoryError where there is none."""
        with suppress(MemoryError):
            self._open_chunk(n_bytes)
            self.memory.at, self.memory.end = self._at, self._end
        return 0


class Handle:
    """A struct seen from Python: its fields are read and written by name. Lists and arrays are handles too."""

    __slots__ = ("_arena", "_struct", "address")

    def __init__(self, struct: str, address: int, arena: Arena):
        object.__setattr__(self, "_struct", struct)
        object.__setattr__(self, "address", address)
        object.__setattr__(self, "_arena", arena)

    def __getattr__(self, name: str) -> Any:
        field = self._field(name)
        at = self.address + field.at
        if field.kind == "list":
            return ListHandle(field.of, at, self._arena)
        if field.kind == "array":
            return ArrayHandle(field.of, _INT.from_address(at).value, self._arena)
        return _read(at, field.kind if field.kind != "ref" else field.of, self._arena)

    def __setattr__(self, name: str, value: Any) -> None:
        field = self._field(name)
        kind = {"ref": field.of, "array": "int"}.get(field.kind, field.kind)
        _write(self.address + field.at, kind, value)

    def __bool__(self) -> bool:
        return self.address != 0

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Handle) and other.address == self.address

    def __hash__(self) -> int:
        return hash(self.address)

    def __repr__(self) -> str:
        return f"<{self._struct} at {self.address:#x}>"

    def _field(self, name: str) -> Field:
        try:
            return LAYOUTS[self._struct].fields[name]
        except KeyError:
            raise AttributeError(f"{self._struct} has no {name!r}") from None


class ArrayHandle:
    """Words side by side."""

    def __init__(self, of: str, address: int, arena: Arena):
        self.of, self.address, self._arena = of, address, arena

    def __getitem__(self, item: int) -> Any:
        return _read(self.address + item * WORD, self.of, self._arena)

    def __setitem__(self, item: int, value: Any) -> None:
        _write(self.address + item * WORD, self.of, value)


class ListHandle:
    """A list inside a struct."""

    def __init__(self, of: str, address: int, arena: Arena):
        self.of, self.address, self._arena = of, address, arena

    def _word(self, number: int) -> Any:
        return _INT.from_address(self.address + number * WORD)

    def __len__(self) -> int:
        return self._word(N).value

    def __getitem__(self, item: int) -> Any:
        if not 0 <= item < len(self):
            raise IndexError(item)
        return _read(self._word(DATA).value + (self._word(FIRST).value + item) * WORD, self.of, self._arena)

    def __iter__(self) -> Iterator[Any]:
        return (self[i] for i in range(len(self)))

    def append(self, value: Any) -> None:
        self.insert(len(self), value)

    def extend(self, values: Iterable[Any]) -> None:
        """Put values behind the last."""
        self.fill([*self, *values])

    def insert(self, at: int, value: Any) -> None:
        """Put a value before the one that is now number ``at``."""
        values = list(self)
        values.insert(at, value)
        self.fill(values)

    def fill(self, values: Iterable[Any]) -> None:
        """Have these values and no others."""
        found = list(values)
        room = max(4, 1 << (len(found) - 1).bit_length()) if found else 0
        if room > self._word(ROOM).value:
            self._word(DATA).value = self._arena.take(room * WORD)
            self._word(ROOM).value = room
        self._word(FIRST).value, self._word(N).value = 0, len(found)
        for i, value in enumerate(found):
            _write(self._word(DATA).value + i * WORD, self.of, value)


def _read(at: int, kind: str, arena: Arena) -> Any:
    if kind == "float":
        return _FLOAT.from_address(at).value
    number = _INT.from_address(at).value
    return number if kind == "int" else Handle(kind, number, arena)


def _write(at: int, kind: str, value: Any) -> None:
    if kind == "float":
        _FLOAT.from_address(at).value = value
    elif value is None:
        _INT.from_address(at).value = 0
    else:
        _INT.from_address(at).value = value.address if isinstance(value, Handle) else int(value)
