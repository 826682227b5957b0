"""The numbers that a run asks for: blocks of named streams, ahead of their time, kept until the run is over."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np

from opsim.engine.fast_engine.luck.draws import BlockDraws
from opsim.engine.fast_engine.machine import Arena, Handle
from opsim.engine.fast_engine.machine.arena import MORE
from opsim.engine.fast_engine.parts import luck
from opsim.engine.fast_engine.settle import NO_LUCK
from opsim.plan import Plan
from opsim.streams import BLOCK

MOST_AHEAD = 32
"""Blocks at once, of a stream that has not said how many it needs."""
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
    luck.DURATION: lambda draws, _plan, worker, task, _: draws.durations(task, worker),
    luck.AUTOMATIC: lambda draws, _plan, station, task, _: draws.automatic_runs(task, station),
    luck.HOLD: lambda draws, plan, worker, task, _: draws.durations_with(_hold(plan, task), task, worker),
    luck.HOLD_RUN: lambda draws, plan, station, task, _: draws.runs_with(_hold(plan, task), task, station),
    luck.GAP: lambda draws, _plan, source, *_: draws.gaps(source),
    luck.MIX: lambda draws, _plan, source, *_: draws.products(source),
    luck.REPAIR: lambda draws, plan, stop, *_: draws.repairs(plan.stops[stop]),
    luck.UPTIME: lambda draws, plan, stop, *_: draws.uptimes(plan.breakdowns[stop]),
    luck.ROUTING: _chance("routing"),
    luck.YIELD: _chance("yield"),
    luck.QUALITY: _chance("quality"),
    luck.START: lambda draws, _plan, source, *_: draws.ways("start", 0, source),
    luck.ABSENCE: lambda draws, plan, worker, *_: draws.chances(("absence", plan.workers[worker].name)),
}
"""By purpose, the stream of up to three ranks."""


class Numbers:
    """Of one replication. ``failed`` : what a model raised when it was asked; the engine is told by ``floor.error``.

    needed : by stream, how many blocks the replication before has asked for: as many are drawn at once in the next
    """

    def __init__(self, plan: Plan, arena: Arena, floor: Handle):
        self.plan, self.arena, self.floor = plan, arena, floor
        self.failed: BaseException | None = None
        self.needed: dict[int, int] = {}
        self._streams: dict[int, Any] = {}
        self._asked: dict[int, int] = {}
        self._kept: list[Any] = []
        self._whole: dict[int, np.ndarray] = {}
        self.callback = MORE(self._more)
        floor.more_luck = ctypes.cast(self.callback, ctypes.c_void_p).value

    def begin(self, replication: int) -> None:
        """A replication begins: nothing is drawn yet."""
        self.failed, self.draws = None, BlockDraws(self.plan, replication)
        self.needed |= self._asked
        for of_before in (self._streams, self._asked, self._kept, self._whole):
            of_before.clear()

    def _more(self, address: int, item: int) -> int:
        """Called by the engine: item ``item`` of a stream, and what follows, is wanted."""
        stream = Handle("Stream", address, self.arena)
        try:
            self._fill(stream, item // BLOCK)
        except BaseException as error:  # NOTE: nothing may be raised through compiled code
            self.failed, self.floor.error = error, NO_LUCK
            self._give(stream, (np.ones(BLOCK),) * 3, item)
        return 0

    def _fill(self, stream: Handle, block: int) -> None:
        """Blocks from one on; of a stream that is asked in no order, all up to that one."""
        number = stream.id
        if stream.next >= 0:
            self._give(stream, self._stream(number).fill(block, self._ahead(number, block)), block * BLOCK)
            return
        known = self._whole.get(number)
        first = 0 if known is None else known.size // BLOCK
        more = self._stream(number).fill(first, max(block + 1 - first, self._ahead(number, first)))
        whole = self._whole[number] = more if known is None else np.concatenate([known, more])
        self._give(stream, whole, 0)

    def _ahead(self, stream: int, block: int) -> int:
        """How many blocks from one on: what was needed the last time, else one more than there were so far."""
        ahead = max(self.needed.get(stream, 0) - block, min(block + 1, MOST_AHEAD))
        self._asked[stream] = block + ahead
        return ahead

    def _stream(self, stream: int) -> Any:
        found = self._streams.get(stream)
        if found is None:
            ranks = stream >> 32 & 0xFFFF, stream >> 16 & 0xFFFF, stream & 0xFFFF
            found = self._streams[stream] = NAMED[stream >> 48](self.draws, self.plan, *ranks)
        return found

    def _give(self, stream: Handle, numbers: Any, first: int) -> None:
        """The engine finds them from item ``first`` on; of a hold three arrays."""
        columns = [
            np.ascontiguousarray(one, np.float64) for one in (numbers if isinstance(numbers, tuple) else [numbers])
        ]
        self._kept.append(columns)
        for name, column in zip(("data", "data_2", "data_3"), columns):
            setattr(stream, name, column.ctypes.data)
        stream.first, stream.end = first, first + columns[0].size
