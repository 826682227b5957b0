"""All numbers that are known to be wanted, drawn as a replication begins: one call for the states of all generators,
then one for each kind of numbers. The engine finds them in a table, by their streams; see ``luck.more_numbers``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from opsim.engine.fast_engine.luck.block_hashes import BLOCK_HASHES
from opsim.engine.fast_engine.luck.kinds import HeldAtShares, NoLuck, OfAKind
from opsim.engine.fast_engine.luck.many_blocks import ManyBlocks
from opsim.engine.fast_engine.luck.seeds import states_of
from opsim.engine.fast_engine.luck.trust import is_trusted
from opsim.engine.fast_engine.parts.luck import DATA, DATA_2, DATA_3, END, ID, USED, WIDTH, place_of
from opsim.streams import BLOCK


class Wanted(NamedTuple):
    """A stream that can be drawn with others. name : the words of its key that follow those of the replication

    held : from which to which share of its performances a tool is held, if one is
    """

    stream: int
    name: np.ndarray
    drawn: Any
    held: tuple[float, ...] = ()


def wanted(stream: int, name: np.ndarray, drawn: Any) -> Wanted | None:
    """A stream as a recipe can draw it, None where it has to be drawn alone."""
    held: tuple[float, ...] = ()
    if isinstance(drawn, HeldAtShares):
        drawn, held = drawn.drawn, (drawn.start, drawn.end)
    if not isinstance(drawn, (OfAKind, NoLuck)) or not is_trusted():
        return None
    return Wanted(stream, name, drawn, held)


def is_dear(drawn: Any) -> bool:
    """Whether a model is asked for each block of a stream: some 50 us of an emulator, where a call costs 20."""
    return not isinstance(drawn.drawn if isinstance(drawn, HeldAtShares) else drawn, (OfAKind, NoLuck))


class Recipe:
    """Of some streams, each of so many blocks, for any replication of a Plan.

    table : (places, WIDTH) int64, read by the engine; blocks : by stream, how many
    """

    def __init__(self, streams: Sequence[tuple[Wanted, int]] = ()):
        self.blocks = {one.stream: n for one, n in streams}
        self.table, self._places = _places(list(self.blocks))
        self.table[list(self._places.values()), END] = [BLOCK * n for n in self.blocks.values()]
        self._always: list[np.ndarray] = []
        self._now: list[np.ndarray] = []
        kinds: dict[Any, list[Wanted]] = {}
        for one, n in streams:
            self._put_moments(one, n)
            if isinstance(one.drawn, OfAKind):
                kinds.setdefault(one.drawn.kind, []).append(one)
            else:
                self._put(one.stream, DATA, one.drawn(one.name, 0, n))
        self._kinds = [_Kind(alike, self.blocks, self._places) for alike in kinds.values()]
        self._take_names([one for alike in kinds.values() for one in alike])

    def draw(self, begun: np.ndarray) -> None:
        """All numbers of a replication; ``begun`` : uint32, the words that the keys of its streams begin with."""
        if self._kinds:
            states = states_of(begun, self._names, self._ends, self._n_blocks, self._hashes)
            self._now, first = [], 0
            for kind in self._kinds:
                self._now.append(kind.draw(states[first : first + kind.n_blocks], self.table))
                first += kind.n_blocks

    def used(self) -> dict[int, int]:
        """By stream, how many blocks any replication so far has asked for at most."""
        items = self.table[list(self._places.values()), USED].tolist()
        return {stream: n // BLOCK for stream, n in zip(self._places, items)}

    def _take_names(self, lucky: list[Wanted]) -> None:
        """What all states are made of, in the order of the kinds."""
        self._names = np.concatenate([np.empty(0, np.uint32), *(one.name for one in lucky)])
        self._ends = np.cumsum([one.name.size for one in lucky], dtype=np.int64)
        self._n_blocks = np.array([self.blocks[one.stream] for one in lucky], np.int64)
        self._hashes = BLOCK_HASHES.of(0, int(max(self._n_blocks, default=0)))

    def _put_moments(self, one: Wanted, n_blocks: int) -> None:
        for column, share in zip((DATA_2, DATA_3), one.held):
            self._put(one.stream, column, np.full(n_blocks * BLOCK, share))

    def _put(self, stream: int, column: int, numbers: np.ndarray) -> None:
        """Numbers that are the same in all replications."""
        self._always.append(np.ascontiguousarray(numbers, np.float64))
        self.table[self._places[stream], column] = self._always[-1].ctypes.data


class _Kind:
    """Streams that are drawn in one call."""

    def __init__(self, alike: list[Wanted], n_blocks: dict[int, int], places: dict[int, int]):
        sizes = BLOCK * np.array([n_blocks[one.stream] for one in alike])
        self.n_blocks = int(sizes.sum()) // BLOCK
        self._draw, self._places = alike[0].drawn.draw, np.array([places[one.stream] for one in alike])
        self._at = np.dtype(np.float64).itemsize * (np.cumsum(sizes) - sizes)
        self._numbers = [_each(column, sizes) for column in zip(*(one.drawn.numbers for one in alike))]

    def draw(self, states: np.ndarray, table: np.ndarray) -> np.ndarray:
        """(n_blocks * 64,) numbers, which the table leads to from now on."""
        drawn = self._draw(self.n_blocks * BLOCK, ManyBlocks.in_states(states), *self._numbers)
        numbers = np.ascontiguousarray(drawn, np.float64)
        table[self._places, DATA] = self._at + numbers.ctypes.data
        return numbers


def _each(column: tuple[float, ...], sizes: np.ndarray) -> Any:
    """A number of each stream for each of its items; the number itself where all have the same."""
    return column[0] if len(set(column)) == 1 else np.repeat(np.array(column), sizes)


def _places(streams: list[int]) -> tuple[np.ndarray, dict[int, int]]:
    """A table at least half empty, and the place of each stream in it."""
    mask = max(2, 1 << (2 * len(streams)).bit_length()) - 1
    table, places, taken = np.zeros((mask + 1, WIDTH), np.int64), dict[int, int](), set[int]()
    for stream in streams:
        at = place_of(stream, mask)
        while at in taken:
            at = (at + 1) & mask
        taken.add(at)
        places[stream] = at
    table[list(places.values()), ID] = streams
    return table, places
