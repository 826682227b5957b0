"""The numbers that a run asks for: blocks of named streams, ahead of their time, kept until the run is over."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np

from opsim.engine.fast_engine.machine import Arena, Handle
from opsim.engine.fast_engine.machine.arena import MORE
from opsim.engine.fast_engine.parts import luck
from opsim.engine.simpy_engine.draws import Draws, _exponential, _performed, _ranks, _uniform
from opsim.plan import Plan
from opsim.streams import BLOCK

MOST_AHEAD = 32
"""Blocks at once."""


class Numbers:
    """Of one replication. ``failed`` : what a model raised when it was asked; the engine is told by ``floor.error``."""

    def __init__(self, plan: Plan, arena: Arena, floor: Handle):
        self.plan, self.arena, self.floor = plan, arena, floor
        self.replication = 0
        self.failed: BaseException | None = None
        self._drawn: dict[int, tuple[Callable, int]] = {}
        self._kept: list[np.ndarray] = []
        self._whole: dict[int, np.ndarray] = {}
        self.callback = MORE(self._more)
        floor.more_luck = ctypes.cast(self.callback, ctypes.c_void_p).value

    def begin(self, replication: int) -> None:
        """A replication begins: nothing is drawn yet."""
        self.replication, self.failed = replication, None
        self.draws = Draws(self.plan, replication)
        self._drawn.clear()
        self._kept.clear()
        self._whole.clear()

    def _more(self, address: int, item: int) -> int:
        """Called by the engine: item ``item`` of a stream, and what follows, is wanted."""
        stream = Handle("Stream", address, self.arena)
        try:
            self._fill(stream, item)
        except BaseException as error:
            self.failed = error
            self._fill_with(stream, np.ones(BLOCK), item)
        return 0

    def _fill(self, stream: Handle, item: int) -> None:
        block, ahead = self._drawn.get(stream.id) or (self._drawer(stream.id), 1)
        self._drawn[stream.id] = block, min(2 * ahead, MOST_AHEAD)
        if stream.next >= 0:  # one after the other
            first = item // BLOCK
            self._fill_with(stream, np.concatenate([block(first + i) for i in range(ahead)]), first * BLOCK)
            return
        known = self._whole.get(stream.id, np.empty(0))
        first = known.size // BLOCK
        last = max(item // BLOCK + 1, 2 * first)
        self._whole[stream.id] = whole = np.concatenate([known, *(block(i) for i in range(first, last))])
        stream.data, stream.first, stream.end = whole.ctypes.data, 0, whole.size

    def _fill_with(self, stream: Handle, numbers: np.ndarray, first: int) -> None:
        self._kept.append(numbers)
        stream.data, stream.first, stream.end = numbers.ctypes.data, first, first + numbers.size

    def _drawer(self, stream: int) -> Callable[[int], np.ndarray]:
        """How block after block of a stream is computed, as float64."""
        purpose, one, two, three = stream >> 48, stream >> 32 & 0xFFFF, stream >> 16 & 0xFFFF, stream & 0xFFFF
        items = self._items(purpose, one, two, three)
        return lambda number: np.asarray(items.block(number), dtype=np.float64)

    def _items(self, purpose: int, one: int, two: int, three: int) -> Any:
        plan, draws = self.plan, self.draws
        if purpose == luck.DURATION:
            return draws._of_worker(two, one)
        if purpose == luck.AUTOMATIC:
            name = ("automatic", plan.tasks[two].name, plan.stations[one].name)
            return draws._items(name, _performed(plan.tasks[two].model, None))
        if purpose == luck.GAP:
            source = plan.sources[one]
            gap = _exponential(source.every_s) if source.gap is None else _performed(source.gap, None)
            return draws._items(("interarrival", source.name), gap)
        if purpose == luck.MIX:
            from itertools import accumulate

            source = plan.sources[one]
            return draws._items(("mix", source.name), _ranks(list(accumulate(share for _, share in source.mix))[:-1]))
        if purpose in (luck.ROUTING, luck.YIELD, luck.QUALITY):
            word = {luck.ROUTING: "routing", luck.YIELD: "yield", luck.QUALITY: "quality"}[purpose]
            return draws._items((word, plan.operations[one], plan.sources[two].name, three), _uniform)
        if purpose == luck.START:
            return draws._items(("routing", "start", plan.sources[one].name, 0), _uniform)
        raise ValueError(f"no stream of purpose {purpose}")
