"""The numbers that a run asks for: blocks of named streams, ahead of their time, kept until the run is over.

What replications before have asked for is drawn as a run begins, by a recipe; for what lacks, the engine calls.
"""

from __future__ import annotations

import ctypes
from collections import deque
from math import isqrt
from typing import Any

import numpy as np

from opsim.engine.fast_engine.interrupts import handled
from opsim.engine.fast_engine.luck.draws import BlockDraws
from opsim.engine.fast_engine.luck.whole import Whole
from opsim.engine.fast_engine.machine import Arena, Handle
from opsim.engine.fast_engine.machine.arena import MORE
from opsim.engine.fast_engine.machine.layouts import LAYOUTS, WORD
from opsim.engine.fast_engine.named import NAMED
from opsim.engine.fast_engine.parts import luck
from opsim.engine.fast_engine.recipe import Recipe, Wanted, is_dear, wanted
from opsim.engine.fast_engine.settle import NO_LUCK
from opsim.plan import Plan
from opsim.streams import BLOCK

MOST_AHEAD = 32
"""Blocks at once, of a stream that has not said how many it needs."""
ONE_IN = 8
"""As soon as one in so many streams had to be called for, a new recipe costs less than the calls."""
OF_LAST, DEAR_ONE_IN = 4, 32
"""A dear block too many costs four calls: so of those as many are drawn at once as each of the last replications has
wanted, then by one, or by a small share of what there is."""

_OF_PEOPLE = luck.DURATION, luck.HOLD
_AT = {name: field.at // WORD for name, field in LAYOUTS["Stream"].fields.items()}
_STREAM = ctypes.c_int64 * len(_AT)


def _with_spare(n_blocks: int) -> int:
    """Some more than was wanted at most so far: a block costs 1 us, one that lacks 20. Counts spread by their root."""
    return n_blocks + isqrt(max(n_blocks - 1, 0))


class Numbers:
    """Of one replication. ``failed`` : what a model raised when it was asked; the engine is told by ``floor.error``.

    needed : by stream, how many blocks any replication so far has asked for at most
    """

    def __init__(self, plan: Plan, arena: Arena, floor: Handle):
        self.plan, self.floor = plan, floor
        self.failed: BaseException | None = None
        self.needed: dict[int, int] = {}
        self.recipe, self._lacking = Recipe(), 0
        self._together: dict[int, Wanted] = {}
        self._streams: dict[int, Any] = {}
        self._asked: dict[int, int] = {}
        self._dear: dict[int, deque[int]] = {}
        self._words: dict[int, Any] = {}
        self._kept: list[Any] = []
        self._whole: dict[int, Whole] = {}
        self.callback = MORE(self._more)
        floor.more_luck = ctypes.cast(self.callback, ctypes.c_void_p).value
        self._table = np.zeros(2, np.int64)
        floor.drawn = self._table.ctypes.data

    @property
    def drawn(self) -> dict[int, int]:
        """By stream, how many blocks this replication has drawn."""
        return self.recipe.blocks | self._asked

    def begin(self, replication: int) -> None:
        """A replication begins: what is known to be wanted is drawn. NOTE: the floor is still the last one's here."""
        self._learn()
        for of_before in (self._asked, self._streams, self._words, self._kept, self._whole):
            of_before.clear()
        if self._lacking * ONE_IN > len(self.recipe.blocks):
            self.recipe, self._lacking = self._new_recipe(), 0
        table = self.recipe.table
        self._table[luck.TABLE], self._table[luck.MASK] = table.ctypes.data, len(table) - 1
        self.failed, self.draws = None, BlockDraws(self.plan, replication)
        self.recipe.draw(np.frombuffer(self.draws.begun, np.uint32))

    def _learn(self) -> None:
        """What the last replication has called for. What it wanted of that, its streams still say, if in order."""
        for stream, blocks in self._asked.items():
            following = self._words[stream][_AT["next"]]
            used = blocks if following < 0 else -(-following // BLOCK)
            if stream in self._dear:
                self._dear[stream].append(used)
            self.needed[stream] = max(used, self.needed.get(stream, 0))
            self._lacking += stream in self._together or self._joins(stream)

    def _joins(self, stream: int) -> bool:
        """A stream that was called for is drawn with others from now on, where it can be. People who are redrawn are
        others in each replication."""
        if stream >> 48 in _OF_PEOPLE and self.plan.workforce is None and self.plan.staffing == "redrawn":
            return False
        found = self._streams[stream]
        one = wanted(stream, found.words[len(self.draws.begun) // 4 :], found.drawn)
        if one is not None:
            self._together[stream] = one
        return one is not None

    def _new_recipe(self) -> Recipe:
        for stream, used in self.recipe.used().items():
            self.needed[stream] = max(used, self.needed[stream])
        return Recipe([(one, _with_spare(self.needed[stream])) for stream, one in self._together.items()])

    def _more(self, address: int, item: int) -> int:
        """Called by the engine: item ``item`` of a stream, and what follows, is wanted."""
        words = _STREAM.from_address(address)
        try:
            handled(self._fill, words, item // BLOCK)
        except BaseException as error:  # NOTE: nothing may be raised through compiled code
            self.failed, self.floor.error = error, NO_LUCK  # nothing is given: compiled code raises
        return 0

    def _fill(self, words: Any, block: int) -> None:
        """Blocks from one on; of a stream that is asked in no order, all up to that one."""
        number = words[_AT["id"]]
        self._words[number] = words
        if words[_AT["next"]] >= 0:
            stream = self._stream(number)
            self._give(words, stream.fill(block, self._ahead(number, block)), block * BLOCK)
            return
        whole = self._whole.setdefault(number, Whole())
        first = whole.n // BLOCK
        if block >= first:  # else another one of this stream has asked for it
            stream = self._stream(number)
            whole.add(stream.fill(first, max(block + 1 - first, self._ahead(number, first))))
        self._give(words, whole.numbers, 0)

    def _ahead(self, stream: int, block: int) -> int:
        """How many blocks from one on: what was needed so far, else one more than there were in this replication."""
        if stream in self._dear:
            ahead = max(min(self._dear[stream], default=0) - block, block // DEAR_ONE_IN + 1)
        else:
            needed = self.needed.get(stream, 0)
            more = block // ONE_IN + 1 if needed else min(block + 1, MOST_AHEAD)
            ahead = max(needed - block, more)
        self._asked[stream] = block + ahead
        return ahead

    def _stream(self, stream: int) -> Any:
        found = self._streams.get(stream)
        if found is None:
            ranks = stream >> 32 & 0xFFFF, stream >> 16 & 0xFFFF, stream & 0xFFFF
            found = self._streams[stream] = NAMED[stream >> 48](self.draws, self.plan, *ranks)
            if is_dear(found.drawn):
                self._dear.setdefault(stream, deque(maxlen=OF_LAST))
        return found

    def _give(self, words: Any, numbers: Any, first: int) -> None:
        """The engine finds them from item ``first`` on; of a hold three arrays."""
        columns = [
            np.ascontiguousarray(one, np.float64) for one in (numbers if isinstance(numbers, tuple) else [numbers])
        ]
        self._kept.append(columns)
        for name, column in zip(("data", "data_2", "data_3"), columns):
            words[_AT[name]] = column.__array_interface__["data"][0]
        words[_AT["first"]], words[_AT["end"]] = first, first + columns[0].size
