"""Named columns of numbers as one run of bytes, and back.

Little-endian, every column at a multiple of 8 bytes, in byte planes: the lowest byte of every number first, then the
next lowest. Neighbours are alike in their high bytes, so that the whole packs a quarter smaller.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

DTYPES = ("f8", "f4", "u4", "i4", "u2", "i2", "u1", "i1")
Table = dict[str, list]
"""name -> [dtype, offset in bytes, count]"""


class Columns:
    """Columns, one after the other."""

    def __init__(self) -> None:
        self.table: Table = {}
        self._parts: list[bytes] = []
        self._size = 0

    def add(self, name: str, dtype: str, values: np.ndarray) -> str:
        """One more, laid flat; its name. Raises ValueError for a name that is there, or a number that does not fit."""
        if name in self.table:
            raise ValueError(f"column {name}: it is there already")
        values = np.asarray(values).ravel()
        if dtype[0] in "iu" and values.size:
            room = np.iinfo(dtype)
            if not (room.min <= values.min() and values.max() <= room.max):
                raise ValueError(f"column {name}: {values.min():g} to {values.max():g} do not fit into {dtype}")
        packed = values.astype(f"<{dtype}")
        planes = packed.view(np.uint8).reshape(-1, packed.itemsize).T.tobytes()
        self.table[name] = [dtype, self._size, int(values.size)]
        padded = planes + bytes(-len(planes) % 8)
        self._parts.append(padded)
        self._size += len(padded)
        return name

    def close(self) -> bytes:
        """All of them."""
        return b"".join(self._parts)


def unpacked_columns(table: Mapping[str, list], data: bytes) -> dict[str, np.ndarray]:
    """The columns of a table, by name."""
    return {name: unpacked_column(data, *entry) for name, entry in table.items()}


def unpacked_column(data: bytes, dtype: str, offset: int, count: int) -> np.ndarray:
    """(count,) numbers of one column."""
    size = int(dtype[1])
    planes = np.frombuffer(data, np.uint8, count * size, offset).reshape(size, count)
    return np.ascontiguousarray(planes.T).reshape(-1).view(f"<{dtype}")
