"""Plan -> EventLog, one replication, by compiled code; what that needs before, and which Plans it does not run."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import partial
from threading import local

import numpy as np

from opsim.engine.endless import endless_instant
from opsim.engine.fast_engine.build import Build
from opsim.engine.fast_engine.event_list import is_last_of_instant, pop_event
from opsim.engine.fast_engine.floor_state import Floor
from opsim.engine.fast_engine.log_rows import Columns, flush_rows
from opsim.engine.fast_engine.machine import TABLE, Step, complete, here, line_of, step
from opsim.engine.fast_engine.machine.calling import Waiting, caller, signals_wait
from opsim.engine.fast_engine.machine.code_cache import folder, is_marked, mark
from opsim.engine.fast_engine.machine.table import lacking
from opsim.engine.fast_engine.numbers import Numbers
from opsim.engine.fast_engine.random_numbers import MOST_RANKS
from opsim.engine.fast_engine.settle import close, happen, settle, start
from opsim.engine.fast_engine.streams.blocks import is_trusted
from opsim.engine.fast_engine.streams.of_plan import luck_of
from opsim.engine.plugin_rules import plugin_rules
from opsim.log import EventLog, names_of
from opsim.plan import Plan
from opsim.threads import one_blas_thread

DONE, MORE, FAILED = range(3)


@step
def run_on(floor: Floor, most: int) -> int:
    """Everything that happens before the horizon, but so many events at most: DONE, MORE to come, or FAILED."""
    for _ in range(most):
        if floor.settle_pending and is_last_of_instant(floor):
            settle(floor)
        elif floor.heap_n == 0 or floor.heap_time[0] >= floor.horizon_s:
            return DONE
        else:
            floor.env_now = floor.heap_time[0]
            _happens(floor, pop_event(floor))
        if floor.error:
            return FAILED
    return MORE


_happens = here(happen)


def built(plan: Plan) -> Build:
    """The floor of a Plan with its loop, and somebody who puts rows into columns."""
    build = Build(plan)
    build.line(run_on)
    build.line(flush_rows)
    build.floor.flush_line = line_of(flush_rows)
    return build


_RANKED = ("workers", "tasks", "stations", "operations", "sources", "stops", "breakdowns")


def refuse_too_many(plan: Plan) -> None:
    """Raises NotImplementedError for a Plan with more of anything than ids can tell apart."""
    for what in _RANKED:
        n = len(getattr(plan, what))
        if n > MOST_RANKS:
            raise NotImplementedError(f"{n:,} {what}, where it tells {MOST_RANKS:,} apart")


def plug_ins_of(plan: Plan) -> list[str]:
    """Rules that only Python can follow, in words, each once."""
    return list(dict.fromkeys(map(str, plugin_rules(plan))))


def refuse_plug_ins(plan: Plan) -> None:
    """Raises NotImplementedError for a Plan with rules that only Python can follow."""
    if said := plug_ins_of(plan):
        raise NotImplementedError("; ".join(said))


start_floor = caller(start)
"""Everything that happens before the first instant, of the floor at an address."""
run_floor = caller(run_on)
"""So many events at most, see ``run_on``."""
close_floor = caller(close)
"""The rows that are open at the horizon."""


Told = Callable[[int, int], None]
STEPS_S, STEP_S, LUCK_S, EMULATED_S = 1.5, 0.03, 3.0, 3.0
"""About so many CPU seconds are compiled for any steps, for each that a floor's lines lead to, for what draws numbers,
and for emulators."""
LUCK, EMULATED = "luck", "emulated"
"""Noted on disk by these names when it was compiled. NOTE: to find out otherwise takes as long as to run it."""


def compiling_s(plan: Plan) -> float:
    """About how long ``ready`` compiles for a Plan, by the clock; 0: it is compiled, here or on disk."""
    n_steps = len(lacking(built(plan).steps.values()))
    cpu_s = STEPS_S + n_steps * STEP_S if n_steps else 0.0
    if _luck_is_new():
        cpu_s += LUCK_S
    if _emulated(plan) and not is_marked(EMULATED):
        cpu_s += EMULATED_S
    return cpu_s


def is_kept() -> bool:
    """Whether there is a place on disk for what is compiled."""
    return folder() is not None


def ready(plan: Plan, told: Told | None = None) -> None:
    """Compile what a Plan needs and is not compiled yet; ``told(done, total)`` says how far it is."""
    emulated = [] if is_marked(EMULATED) else _emulated(plan)
    ready_for(built(plan).steps.values(), told, [partial(_draw, plan, emulated)] if emulated else [])


def ready_for(steps: Iterable[Step], told: Told | None = None, more: Iterable[Callable[[], object]] = ()) -> None:
    """The same for some steps, for what draws numbers, and for more."""
    wanted = list(steps)
    jobs = list(more)
    if _luck_is_new():
        jobs.insert(0, _compile_luck)
    if lacking(wanted):
        jobs.insert(0, partial(complete, wanted))
    for done, job in enumerate(jobs):
        if told is not None:
            told(done, len(jobs))
        job()
    if told is not None and jobs:
        told(len(jobs), len(jobs))
    complete(wanted)  # where they were on disk: other processes may begin with what this one has


def _luck_is_new() -> bool:
    return not is_marked(LUCK) and not is_trusted.cache_info().currsize


def _compile_luck() -> None:
    """All that draws numbers, by the look at it that a first run takes anyway."""
    is_trusted()
    mark(LUCK)


def _emulated(plan: Plan) -> list[int]:
    """A task of each kind of the emulator's models, by rank: of others nothing is compiled."""
    kinds = {type(task.model): rank for rank, task in enumerate(plan.tasks) if plan.workers}
    return [rank for kind, rank in kinds.items() if kind.__module__.startswith("emulator.")]


def _draw(plan: Plan, tasks: Iterable[int]) -> None:
    """Performances of some tasks. NOTE: what a model has to say against it is raised by the run, where it belongs."""
    luck, workforce = luck_of(plan), plan.workforce_of(0)
    with suppress(Exception):
        for task in tasks:
            luck.of_worker(task, 0, workforce)(np.zeros(6, np.uint32), 0, 1)
        mark(EMULATED)


MOST_EVENTS = 1 << 17
"""Before signals are handled: 10 ms of a small floor, a second of one of thousands of stations."""


class Machine:
    """A plan's floor in memory, with all that runs it again and again: one for each thread."""

    def __init__(self, plan: Plan, told: Callable[[int, int], None] | None = None):
        refuse_plug_ins(plan)
        refuse_too_many(plan)
        self.plan, self.build = plan, built(plan)
        self.floor = self.build.floor
        complete(self.build.steps.values(), told)
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
