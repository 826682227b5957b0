"""Plan -> EventLog, one replication, by compiled code."""

from __future__ import annotations

from collections.abc import Callable
from threading import local

from opsim.engine.endless import endless_instant
from opsim.engine.fast_engine.build import Build
from opsim.engine.fast_engine.entry import close_floor, run_floor, start_floor
from opsim.engine.fast_engine.interrupts import Waiting, signals_wait
from opsim.engine.fast_engine.limits import refuse_plug_ins, refuse_too_many
from opsim.engine.fast_engine.loop import DONE, FAILED
from opsim.engine.fast_engine.machine import TABLE, complete, needed
from opsim.engine.fast_engine.numbers import Numbers
from opsim.engine.fast_engine.room import Columns
from opsim.log import EventLog, names_of
from opsim.one_thread import one_blas_thread
from opsim.plan import Plan

MOST_EVENTS = 1 << 17
"""Before signals are handled: 10 ms of a small floor, a second of one of thousands of stations."""


class Machine:
    """A plan's floor in memory, with all that runs it again and again: one for each thread."""

    def __init__(self, plan: Plan, told: Callable[[int, int], None] | None = None):
        refuse_plug_ins(plan)
        refuse_too_many(plan)
        self.plan, self.build = plan, Build(plan)
        self.floor = self.build.floor
        complete(needed(self.build.steps.values()), told)
        self.floor.table = TABLE.ctypes.data
        self.numbers = Numbers(plan, self.build.arena, self.floor)
        self.columns = Columns(self.build.arena, self.floor)
        self._names = names_of(plan)
        self.build.arena.freeze()

    def run(self, replication: int) -> EventLog:
        """One replication. Raises EndlessInstant, MemoryError, and whatever a model raises when it is asked for times.

        Ctrl-C and other signals are handled between events, or while numbers are drawn: what their handlers raise too.
        """
        with signals_wait() as waiting:
            try:
                return self._run(replication, waiting)
            except Exception:
                if self.numbers.failed is not None:
                    raise self.numbers.failed from None
                raise

    def _run(self, replication: int, waiting: Waiting) -> EventLog:
        at, self.numbers.failed = self.floor.address, None
        self.numbers.begin(replication)
        self.build.arena.restore()
        for one in self.build.answers:
            one.begin(self.numbers)
        self.columns.begin()
        start_floor(at)
        while (state := run_floor(at, MOST_EVENTS)) not in (DONE, FAILED) and self.numbers.failed is None:
            waiting.handle()
        self._raise_what_failed()
        if state == FAILED:
            raise endless_instant(self.plan, self.floor)
        close_floor(at)
        self._raise_what_failed()
        return EventLog(replication, self.plan.horizon_s, self.columns.end(), self._names.copy())

    def _raise_what_failed(self) -> None:
        if self.numbers.failed is not None:
            raise self.numbers.failed


class _Kept(local):
    """The machines of the last Plans that a thread has run."""

    def __init__(self) -> None:
        self.machines: list[Machine] = []


_KEPT = _Kept()
MOST_KEPT = 2
"""A sweep goes from Plan to Plan, and does not come back."""


def run_plan(plan: Plan, replication: int = 0) -> EventLog:
    """Run a Plan to its horizon (exclusive): the rows of ``floor.run_plan``, to the last bit.

    Draws use one BLAS thread, as there. Replications of one Plan (the same object) use its floor again. Raises
    NotImplementedError for what ``unsupported`` says.
    """
    with one_blas_thread():
        return machine_of(plan).run(replication)


def machine_of(plan: Plan) -> Machine:
    """The machine of a Plan in this thread."""
    kept = _KEPT.machines
    found = next((one for one in kept if one.plan is plan), None)
    if found is None:
        found = Machine(plan)
    kept[:] = [found, *(one for one in kept if one is not found)][:MOST_KEPT]
    return found
