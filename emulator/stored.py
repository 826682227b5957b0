"""Records of arrays as a library holds them: a table of names and shapes says how each is written and read again."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

Shape = tuple[int | str, ...]
Table = Mapping[str, Shape]
"""Name of an array -> its shape: numbers, and letters that are one length in all arrays of a record."""


def packed(record: Any, table: Table, head: str) -> dict[str, np.ndarray]:
    """The record's arrays, each under its name with ``head`` before it."""
    return {f"{head}{name}": getattr(record, name) for name in table}


@dataclass(frozen=True)
class StoredArrays:
    """What a file says of one task: arrays by name, and the letters of shapes that are known.

    Everything in it is doubted: what makes no sense raises ValueError, what is not there KeyError.
    """

    task: str
    arrays: Mapping[str, np.ndarray]
    letters: dict[str, int]

    @classmethod
    def of(cls, task: str, arrays: Mapping[str, np.ndarray], **letters: int) -> StoredArrays:
        """Of all arrays of a library, named task/name, those of the task."""
        head = f"{task}/"
        own = {name.removeprefix(head): array for name, array in arrays.items() if name.startswith(head)}
        return cls(task, own, letters)

    def knowing(self, **letters: int) -> StoredArrays:
        """The same, with more letters known."""
        return replace(self, letters=self.letters | letters)

    def __contains__(self, name: str) -> bool:
        return name in self.arrays

    def array(self, name: str, *shape: int | str, low: float = -math.inf, high: float = math.inf) -> np.ndarray:
        """The array of this name; -1 and unknown letters take any length; its numbers lie from low to high."""
        return self.record({name: shape}, "", low, high)[name]

    def shares(self, name: str, *shape: int | str) -> np.ndarray:
        """The array of this name, of numbers from 0 to 1."""
        return self.array(name, *shape, low=0.0, high=1.0)

    def record(self, table: Table, head: str, low: float = -math.inf, high: float = math.inf) -> dict[str, np.ndarray]:
        """All arrays of a table, by their names without ``head``; lengths agree."""
        letters, found = dict(self.letters), {}
        for name, shape in table.items():
            one = found[name] = self.arrays[f"{head}{name}"]
            known = tuple(letters.get(part, -1) if isinstance(part, str) else part for part in shape)
            if one.ndim != len(known) or any(want not in (-1, have) for want, have in zip(known, one.shape)):
                raise ValueError(f"{self.task}/{head}{name} has shape {one.shape}, expected {known}")
            letters |= {part: length for part, length in zip(shape, one.shape) if isinstance(part, str)}
            if not np.all((one >= low) & (one <= high)):
                raise ValueError(f"{self.task}/{head}{name}: found a value outside {low:g} to {high:g}")
        return found

    def number(self, name: str, value: Any) -> float:
        """A finite number of the header."""
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            raise ValueError(f"{self.task}: {name}: found {value!r}, expected a number")
        return float(value)

    def positive(self, name: str, value: Any) -> float:
        """A positive number of the header."""
        number = self.number(name, value)
        if number <= 0:
            raise ValueError(f"{self.task}: {name}: found {number:g}, expected a positive number")
        return number
