"""Named streams of random numbers, drawn in blocks of 64.

Item i of a stream is row i mod 64 of block i // 64, and block b has a generator of its own, found by name. So any
item can be had again later and alone, blocks may be drawn ahead, and adding a worker moves nobody else's luck.
"""

from collections.abc import Callable, Iterator, Sequence
from hashlib import blake2b
from itertools import count
from numbers import Integral
from typing import Any

import numpy as np

BLOCK = 64


def stream(seed: int, replication: int, *name: str | int) -> np.random.Generator:
    """The generator of one named thing, e.g. ``stream(7, 0, "duration", "lift", "ana", 0)``.

    Each part of the name enters the key as its 8-byte blake2b hash (two words of 32 bits).
    Making one costs about 10 us: ask for a block, not for an item.
    """
    return _generator(_key(seed, replication, name))


def _generator(words: bytes) -> np.random.Generator:
    """The generator of ``SeedSequence(seed, spawn_key=(replication, *hashes))``.

    NOTE: numpy puts the words of a seed (with zeros, if there are fewer than four) and of a spawn key in one row.
    Handed over as that row, they make the same generator in 40 % of the time.
    """
    row: Any = np.frombuffer(words, np.uint32)
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence(row)))


def _key(seed: int, replication: int, name: Sequence[str | int]) -> bytes:
    return _words(seed, 4) + _words(replication, 1) + b"".join(map(_hashed, name))


def _words(number: int, fewest: int) -> bytes:
    """A whole number as words of 32 bits, the lowest first. Raises ValueError for what is no whole number from 0."""
    if not isinstance(number, Integral) or number < 0:
        raise ValueError(f"a seed or a replication: found {number!r}, expected a whole number from 0")
    number = int(number)
    n_words = max(fewest, -(-number.bit_length() // 32))
    return np.frombuffer(number.to_bytes(4 * n_words, "little"), "<u4").astype(np.uint32).tobytes()


def _hashed(part: str | int) -> bytes:
    return np.frombuffer(blake2b(str(part).encode(), digest_size=8).digest(), "<u4").astype(np.uint32).tobytes()


class Items:
    """Item after item of one stream, through whole blocks.

    ``draw(rng, block_number)`` computes block ``block_number`` whole and returns its 64 rows.
    """

    __slots__ = ("_block", "_draw", "_first", "_key")

    def __init__(
        self,
        seed: int,
        replication: int,
        name: Sequence[str | int],
        draw: Callable[[np.random.Generator, int], Sequence[Any]],
    ):
        self._draw = draw
        self._key = _key(seed, replication, name)
        self._first = -BLOCK
        self._block: Sequence[Any] = ()

    def __getitem__(self, item: int) -> Any:
        row = item - self._first
        if not 0 <= row < BLOCK:
            number, row = divmod(item, BLOCK)
            self._block = self.block(number)
            self._first = number * BLOCK
        return self._block[row]

    def __iter__(self) -> Iterator[Any]:
        """Items 0, 1, 2, ... without end. NOTE: three times as fast as asking for each."""
        for number in count():
            yield from self.block(number)

    def block(self, number: int) -> Sequence[Any]:
        """The 64 items of one block."""
        return self._draw(_generator(self._key + _hashed(number)), number)


class Scattered:
    """Items of one stream that are asked for in no order, such as by job number: the last blocks are kept."""

    __slots__ = ("_blocks", "_items")
    KEPT = 64

    def __init__(self, items: Items):
        self._items = items
        self._blocks: dict[int, Sequence[Any]] = {}

    def __getitem__(self, item: int) -> Any:
        number, row = divmod(item, BLOCK)
        block = self._blocks.get(number)
        if block is None:
            block = self._blocks[number] = self._items.block(number)
            if len(self._blocks) > self.KEPT:
                del self._blocks[min(self._blocks)]
        return block[row]
