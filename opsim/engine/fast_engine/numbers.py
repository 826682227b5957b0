"""The numbers that a run asks for: blocks of named streams, ahead of their time, kept until the run is over.

What replications before have asked for is drawn as a run begins, by a recipe: one call for the states of all
generators, then one for each kind of numbers. The engine finds them in a table, by their streams, see
``random_numbers.more_numbers``; for what lacks, it calls.
"""

from __future__ import annotations

import ctypes
from collections import deque
from collections.abc import Callable, Sequence
from math import isqrt
from typing import Any, NamedTuple

import numpy as np

from opsim.engine.fast_engine import random_numbers
from opsim.engine.fast_engine.floor_state import NO_LUCK
from opsim.engine.fast_engine.machine import Arena, Handle
from opsim.engine.fast_engine.machine.arena import MORE
from opsim.engine.fast_engine.machine.calling import handled
from opsim.engine.fast_engine.machine.structs import LAYOUTS, WORD
from opsim.engine.fast_engine.random_numbers import DATA, DATA_2, DATA_3, END, ID, USED, WIDTH, place_of
from opsim.engine.fast_engine.streams.blocks import HeldAtShares, NoLuck, OfAKind, is_trusted
from opsim.engine.fast_engine.streams.generators import ManyBlocks
from opsim.engine.fast_engine.streams.of_plan import BlockDraws, Whole
from opsim.engine.fast_engine.streams.seeds import BLOCK_HASHES, states_of
from opsim.plan import Plan
from opsim.streams import BLOCK

Named = Callable[[BlockDraws, Plan, int, int, int], Any]


def _chance(word: str) -> Named:
    """Of (operation, source, visit)."""
    return lambda draws, plan, operation, source, visit: draws.chances(
        (word, plan.operations[operation], plan.sources[source].name, visit)
    )


def _hold(plan: Plan, task: int) -> Any:
    """The hold of a task that has one."""
    return plan.tasks[task].hold


NAMED: dict[int, Named] = {
    random_numbers.DURATION: lambda draws, _plan, worker, task, _: draws.durations(task, worker),
    random_numbers.AUTOMATIC: lambda draws, _plan, station, task, _: draws.automatic_runs(task, station),
    random_numbers.HOLD: lambda draws, plan, worker, task, _: draws.durations_with(_hold(plan, task), task, worker),
    random_numbers.HOLD_RUN: lambda draws, plan, station, task, _: draws.runs_with(_hold(plan, task), task, station),
    random_numbers.GAP: lambda draws, _plan, source, *_: draws.gaps(source),
    random_numbers.MIX: lambda draws, _plan, source, *_: draws.products(source),
    random_numbers.REPAIR: lambda draws, plan, stop, *_: draws.repairs(plan.stops[stop]),
    random_numbers.UPTIME: lambda draws, plan, stop, *_: draws.uptimes(plan.breakdowns[stop]),
    random_numbers.ROUTING: _chance("routing"),
    random_numbers.YIELD: _chance("yield"),
    random_numbers.QUALITY: _chance("quality"),
    random_numbers.START: lambda draws, _plan, source, *_: draws.ways("start", 0, source),
    random_numbers.ABSENCE: lambda draws, plan, worker, *_: draws.chances(("absence", plan.workers[worker].name)),
}
"""By purpose, the stream of up to three ranks."""


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


MOST_AHEAD = 32
"""Blocks at once, of a stream that has not said how many it needs."""
ONE_IN = 8
"""As soon as one in so many streams had to be called for, a new recipe costs less than the calls."""
OF_LAST, DEAR_ONE_IN = 4, 32
"""A dear block too many costs four calls: so of those as many are drawn at once as each of the last replications has
wanted, then by one, or by a small share of what there is."""

_OF_PEOPLE = random_numbers.DURATION, random_numbers.HOLD
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
        self._table[random_numbers.TABLE], self._table[random_numbers.MASK] = table.ctypes.data, len(table) - 1
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
