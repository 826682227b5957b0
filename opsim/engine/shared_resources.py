"""Tools and parts of a floor that are SimPy resources of somebody's own model, and shared with it.

A tool is asked for when a job of the floor waits for it, and goes back as soon as the job is done with it: who has
asked first is served first, on the floor or elsewhere. A store that is kept filled is filled out of a container.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import simpy

from opsim.engine import rules
from opsim.engine.floor.event_list import wake
from opsim.subjects.material.assembly import waited_for


class SharedTool:
    """One of a floor's tools, at most n of it, out of a SimPy Resource or Container.

    Where it is: ``held`` were granted and are free on the floor, in use there, or ``n_coming`` in this instant;
    ``asked`` are not granted yet.
    """

    def __init__(self, source: simpy.Resource | simpy.Container, rank: int, n: int):
        self.source, self.rank, self.n, self.n_coming = source, rank, n, 0
        self.held: list[Any] = []
        self.asked: list[Any] = []

    def ask(self, granted: Callable[[SharedTool], None]) -> None:
        """Ask for one more."""
        event = self.source.get(1) if isinstance(self.source, simpy.Container) else self.source.request()
        self.asked.append(event)

        def comes(_: Any) -> None:
            if event in self.asked:
                self.asked.remove(event)
                self.held.append(event)
                self.n_coming += 1
                granted(self)

        event.callbacks.append(comes)

    def take_back(self) -> None:
        """One that was asked for is wanted no more: whether it was granted in this very instant or not."""
        event = self.asked.pop()
        if event.triggered:
            self._return(event)
        else:
            event.cancel()

    def give_back(self) -> None:
        """One that was held goes back to where it came from."""
        self._return(self.held.pop())

    def _return(self, event: Any) -> None:
        if isinstance(self.source, simpy.Container):
            self.source.put(1)
        else:
            self.source.release(event)


class SharedParts:
    """Pieces of a product out of a SimPy Container, with which a source of kind base stock keeps a store filled."""

    def __init__(self, container: simpy.Container, product: int, source: int):
        self.container, self.product, self.source = container, product, source
        self.asked: list[Any] = []

    def ask(self, pieces: int, come: Callable[[SharedParts], None]) -> None:
        """Ask for the pieces of one more job."""
        event = self.container.get(pieces)
        self.asked.append(event)

        def comes(_: Any) -> None:
            if event in self.asked:
                self.asked.remove(event)
                come(self)

        event.callbacks.append(comes)

    def end(self) -> None:
        """Nothing is asked for any more; what was granted in this very instant goes back."""
        for event in self.asked:
            if event.triggered:
                self.container.put(event.amount)
            else:
                event.cancel()
        self.asked.clear()


class SharedResources:
    """The tools and parts of one floor that are shared, looked after whenever an instant is over.

    soon    : has something happen on the floor in this instant
    release : puts one more job of a product and a source, by rank, on the floor in this instant
    """

    def __init__(
        self,
        floor: Any,
        tools: Sequence[SharedTool],
        parts: Sequence[SharedParts],
        soon: Callable[[Callable[[], None]], None],
        release: Callable[[int, int], None],
    ):
        self._floor, self._tools, self._parts = floor, tools if floor.crib else (), parts
        self._ranks = {tool.rank for tool in self._tools}
        self._soon, self._release = soon, release
        for rank in self._ranks:
            floor.crib.free[rank], floor.crib.shared[rank] = 0, 1
        for part in parts:
            floor.sources[part.source].closed = 1  # it makes nothing by itself
        self.look()

    def look(self) -> None:
        """Ask for what is wanted, and give back what is not."""
        for tool in self._tools:
            self._settle(tool)
            self._match(tool, self._wanted(tool.rank))
        for part in self._parts:
            self._fill(part)

    def end(self) -> None:
        """The floor's run is over: all tools go back, and nothing is asked for any more."""
        for tool in self._tools:
            while tool.asked:
                tool.take_back()
            while tool.held:
                tool.give_back()
        for part in self._parts:
            part.end()

    def _wanted(self, rank: int) -> int:
        """How many of a tool should be free: for all who could have them and wait, and for the greediest who calls."""
        crib = self._floor.crib
        waiting = sum(_need(want, rank) for want in crib.waiting if self._only_shared_lack(want))
        return waiting + max((_need(want, rank) for want in crib.calling), default=0)

    def _only_shared_lack(self, want: Any) -> bool:
        """Whether the floor's own tools that are wanted are there: else nothing is kept from others meanwhile."""
        needs, free = want.needs, self._floor.crib.free
        pairs = ((needs[2 * i], needs[2 * i + 1]) for i in range(want.n_needs))
        return all(tool in self._ranks or free[tool] >= n for tool, n in pairs)

    def _settle(self, tool: SharedTool) -> None:
        """What jobs have given back goes back: whoever is next in line for it there has it, on the floor or not."""
        crib = self._floor.crib
        while crib.returned[tool.rank]:
            crib.returned[tool.rank] -= 1
            tool.give_back()

    def _match(self, tool: SharedTool, wanted: int) -> None:
        free = self._floor.crib.free
        known = int(free[tool.rank]) + tool.n_coming
        while known + len(tool.asked) > wanted and tool.asked:
            tool.take_back()
        while known > wanted and free[tool.rank] > 0:
            free[tool.rank] -= 1
            known -= 1
            tool.give_back()
        while known + len(tool.asked) < wanted and len(tool.held) + len(tool.asked) < tool.n:
            tool.ask(self._granted)

    def _granted(self, tool: SharedTool) -> None:
        def comes() -> None:
            tool.n_coming -= 1
            crib = self._floor.crib
            crib.free[tool.rank] += 1
            crib.changed = 1
            wake(self._floor)

        self._soon(comes)

    def _fill(self, part: SharedParts) -> None:
        """Ask for pieces as the source begins jobs: until its level is there, on its way, or asked for."""
        floor = self._floor
        lot, level = int(floor.products[part.product].lot), floor.sources[part.source].level
        pieces = self._pieces(part.product) + lot * len(part.asked)
        while rules.stock_wanted(pieces, waited_for(floor, part.product), level):
            part.ask(lot, lambda given: self._release(given.product, given.source))
            pieces += lot

    def _pieces(self, product: int) -> int:
        """Pieces of a product that lie in stores, or are on their way there."""
        shelf, n, job = self._floor.stock.shelves[product], 0, self._floor.first_job
        shelved = set(map(id, shelf.jobs))
        while job:
            if job.product == product and id(job) not in shelved:
                n += job.lot
            job = job.next_on_floor
        return int(shelf.units) + n


def _need(want: Any, tool: int) -> int:
    """How many of a tool somebody wants."""
    return sum(int(want.needs[2 * i + 1]) for i in range(want.n_needs) if want.needs[2 * i] == tool)
