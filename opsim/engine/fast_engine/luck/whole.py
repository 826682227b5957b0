"""All numbers of a stream from its first on, for those who ask in no order."""

from __future__ import annotations

import numpy as np


class Whole:
    """n : so many numbers; in room that doubles, so that those before are seldom copied."""

    def __init__(self) -> None:
        self._room, self.n = np.empty(0), 0

    @property
    def numbers(self) -> np.ndarray:
        """(n,) NOTE: of the room at hand; whoever was given an earlier one keeps that."""
        return self._room[: self.n]

    def add(self, more: np.ndarray) -> None:
        """Numbers that follow."""
        n = self.n + more.size
        if n > self._room.size:
            room = np.empty(max(n, 2 * self._room.size))
            room[: self.n] = self.numbers
            self._room = room
        self._room[self.n : n] = more
        self.n = n
