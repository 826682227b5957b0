"""Plan -> EventLog, one replication, by the rules of the floor as CPython reads them, on a SimPy environment.

The floor's events are told to it as they come there, and an instant is settled after the last of them.
"""

from __future__ import annotations

from collections.abc import Generator
from heapq import heappop, heappush
from threading import local
from typing import Any

import simpy

from opsim.engine.draws import Draws
from opsim.engine.endless import endless_instant
from opsim.engine.floor.build import Build
from opsim.engine.floor.event_list import awaited_event
from opsim.engine.floor.settle import close, happen, settle, start
from opsim.log import EventLog, LogWriter, names_of
from opsim.plan import Plan
from opsim.plugins.registry import steps_blamed
from opsim.threads import one_blas_thread

AFTER_EVERYTHING = 2
"""SimPy's priorities are 0 (urgent) and 1 (normal): settle comes after both."""


class _AtEnd:
    """The event that settles an instant."""

    __slots__ = ("_defused", "callbacks")
    _ok, _value = True, None

    def __init__(self, call: Any):
        self.callbacks = [call]


def live_in(env: simpy.Environment, floor: Any) -> None:
    """From now on the floor's events are those of an environment."""

    def happens(event: Any) -> None:
        floor.env_now = env._now
        happen(floor, event)
        if floor.error:
            raise endless_instant(floor.plan, floor)

    def settles(_event: Any) -> None:
        floor.env_now = env._now
        settle(floor)
        if floor.error:
            raise endless_instant(floor.plan, floor)

    def settle_at_end() -> None:
        heappush(env._queue, (env._now, AFTER_EVERYTHING, next(env._eid), _AtEnd(settles)))  # type: ignore[arg-type, misc]

    floor.env, floor.told, floor.settle_at_end = env, (happens,), settle_at_end


def working_life(floor: Any, worker: Any) -> Generator[Any, Any, None]:
    """The SimPy process of a worker: spend the stretch of time he was given, report it, wait for the next."""
    while True:
        event = worker.stretch_over
        try:
            yield event
        except simpy.Interrupt:  # the stretch means nothing any more; another event is in its place
            continue
        worker.stretch_over = awaited_event()
        for happens in floor.told:
            happens(event)


def run_until(env: simpy.Environment, until_s: float) -> None:
    """Everything that happens before a time.

    NOTE: what ``env.run(until=...)`` does, with ``Environment.step`` written out: 5 % of a run.
    """
    queue = env._queue
    while queue and queue[0][0] < until_s:
        env._now, _, _, event = heappop(queue)
        callbacks, event.callbacks = event.callbacks, None  # type: ignore[assignment]
        for callback in callbacks:
            callback(event)
        if not event._ok and not hasattr(event, "_defused"):
            raise event._value


MOST_KEPT = 2
"""Floors of the last Plans that a thread has run: a sweep goes from Plan to Plan, and does not come back."""


class FloorOfPlan:
    """The floor of a Plan, set up once; each replication begins with it as it was then.

    running : whether a replication is under way on it
    """

    def __init__(self, plan: Plan):
        self.plan, self.build, self.running = plan, Build(plan), False
        self._names = names_of(plan)
        for worker in self.build.workers:
            worker.process = worker.stretch_over = None
            worker.name = plan.workers[worker.rank].name
        self.floor.plan = plan
        self.build.arena.freeze()

    @property
    def floor(self) -> Any:
        """The floor itself, see ``floor_state.Floor``."""
        return self.build.floor

    def open(self, env: simpy.Environment, replication: int = 0, *, processes: bool = True) -> None:
        """The floor lives in an environment from now on, and its workers are processes there, unless they need not."""
        floor = self.floor
        self.build.arena.restore()
        floor.draws, floor.rows, floor.log = Draws(self.plan, replication), [], LogWriter()
        floor.write = floor.log.rows.extend
        live_in(env, floor)
        for one in self.build.answers:
            one.begin(floor)
        for worker in self.build.workers:
            worker.process = worker.stretch_over = None
            if processes:
                worker.stretch_over = awaited_event()
                worker.process = env.process(working_life(floor, worker))
        start(floor)

    def close(self, replication: int = 0) -> EventLog:
        """Its rows, those that are open at the horizon closed there."""
        close(self.floor)
        return self.floor.log.close(replication, self.plan.horizon_s, self._names.copy())


class _Kept(local):
    def __init__(self) -> None:
        self.floors: list[FloorOfPlan] = []


_KEPT = _Kept()


def run_plan(plan: Plan, replication: int = 0, *, processes: bool = False) -> EventLog:
    """Run a Plan to its horizon (exclusive); rows that are open there are closed there, with their progress.

    Draws use one BLAS thread, so that the same seed gives the same bytes on any machine load and number of processes.
    processes : whether each worker is a SimPy process of its own: the rows are the same, it takes a little longer
    Raises EndlessInstant, and whatever a rule or a model raises.
    """
    with one_blas_thread():
        one = _floor_of(plan)
        if one.running:
            one = FloorOfPlan(plan)
        one.running = True
        try:
            env = simpy.Environment()
            one.open(env, replication, processes=processes)
            with steps_blamed(plan):
                run_until(env, plan.horizon_s)
            return one.close(replication)
        finally:
            one.running = False


def _floor_of(plan: Plan) -> FloorOfPlan:
    """The floor of a Plan in this thread: replications of one Plan (the same object) use it again."""
    kept = _KEPT.floors
    found = next((one for one in kept if one.plan is plan), None)
    if found is None:
        found = FloorOfPlan(plan)
    kept[:] = [found, *(one for one in kept if one is not found)][:MOST_KEPT]
    return found
