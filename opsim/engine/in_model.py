"""A floor as a part of somebody's own SimPy model: its clock there, jobs that are asked for, its log so far.

What human effects do to one worker, without anything else on a floor: for models that are not ours.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from heapq import heappush
from math import inf, nextafter
from types import SimpleNamespace
from typing import Any

import numpy as np
import simpy

from opsim.clock import TICKS_PER_S
from opsim.engine.floor.build import Build
from opsim.engine.floor.event_list import new_event
from opsim.engine.floor.flow import new_job
from opsim.engine.floor.machine import STRUCTS
from opsim.engine.floor.run import AFTER_EVERYTHING, run_until
from opsim.engine.floor.settle import close
from opsim.engine.rules import ARRIVAL
from opsim.log import ORDER, EventLog, LogWriter, pack_row, row
from opsim.plan import Plan
from opsim.subjects.human.human_state import level
from opsim.subjects.people.worker import human_drawn, stops, works
from opsim.subjects.release.plan import INSIDE, SCHEDULE
from opsim.subjects.routes.routing import want_in

FIRST, APART = 2**40, 2**32
"""Jobs that are asked for have numbers of their own in their source: the draws of all other jobs stay as they are."""
_ROW_BYTES = len(pack_row(*row(0, 0.0, 0.0)))


def source_for(plan: Plan, product: int) -> int:
    """The rank of the source whose jobs those of a product are that are asked for; -1 where none makes it.

    The first in natural order that makes it; one with a schedule, or whose jobs come of others, only where there is no
    other.
    """
    able = [rank for rank, one in enumerate(plan.sources) if any(made == product for made, _ in one.mix)]
    return min(able, key=lambda rank: (plan.sources[rank].kind in (INSIDE, SCHEDULE), rank), default=-1)


def ask_for(floor: Any, product: int, rank: int, n: int, created: Callable[[Any], None], at_s: float) -> None:
    """One more job of a product, the n-th that a source of a rank is asked for, comes at a time of the floor's clock.

    created : is told the job, as it comes
    """
    source, number = floor.sources[rank], FIRST + APART * rank + n

    def comes(floor: Any, _event: Any) -> None:
        n_released = source.n_released
        job = new_job(floor, source, product, number, -1, -1)
        source.n_released = n_released
        created(job)
        want_in(floor, job, floor.now)

    happens_at(floor, at_s, comes, rank, number)


def happens_at(floor: Any, at_s: float, line: Callable[[Any, Any], None], rank: int = 0, number: int = 0) -> None:
    """Something from outside happens on the floor at a time of its clock, as an arrival of this rank and number."""

    def reported(event: Any) -> None:
        floor.env_now = floor.env.now
        floor.report_line(floor, event)

    event = new_event(floor)
    event.line, event.alive, event.kind, event.rank, event.number = line, 1, ARRIVAL, rank, number
    event.callbacks = (reported,)
    heappush(floor.env._queue, (at_s, 1, next(floor.env._eid), event))


def watch(floor: Any, came: Callable[[Any], None], left: Callable[[Any, int, int], None]) -> None:
    """Have each job told as it comes, and as it leaves, with the kind and the cause of the row that says so."""

    def leaves(floor: Any, _subject: Any, job: Any) -> None:
        # NOTE: the row is the last one written, and kind and cause are its first and its last byte.
        left(job, floor.log.rows[-_ROW_BYTES], floor.log.rows[-1])

    floor.created.insert(0, _hook(lambda _floor, _subject, job: came(job)))
    floor.left_floor.insert(0, _hook(leaves))


def _hook(line: Any) -> Any:
    made = STRUCTS["Hook"]()
    made.line = line
    return made


class _Instant:
    """The event of the outer environment by which an instant of the own one comes."""

    __slots__ = ("_defused", "at_s", "callbacks")
    _ok, _value = True, None

    def __init__(self, at_s: float, call: Callable[[_Instant], None]):
        self.at_s, self.callbacks = at_s, [call]


class Inside:
    """Runs an environment of its own, ``own``, inside another, ``outer``, from the outer clock's time on until its end.

    An instant comes after everything else that the outer environment has at that time.
    start_s : the outer clock's time at which the own clock is at 0
    over    : called once, as the own clock comes to ``horizon_s``; passed : called as an instant is over
    """

    def __init__(
        self, outer: simpy.Environment, horizon_s: float, over: Callable[[], None], passed: Callable[[], None]
    ):
        self.own, self.outer, self.start_s, self.horizon_s = simpy.Environment(), outer, float(outer.now), horizon_s
        self.failed = False
        self._over, self._passed, self._planned = over, passed, set[float]()

    @property
    def now_s(self) -> float:
        """The own clock, on the grid of time; where it failed, or at the horizon, it stands still."""
        last_s = self.own.now
        if self.failed:
            return last_s
        passed_s = round((self.outer.now - self.start_s) * TICKS_PER_S) / TICKS_PER_S
        return min(max(last_s, passed_s), self.horizon_s)

    def outer_s(self, own_s: float) -> float:
        """What the outer clock shows at a time of the own one."""
        return self.start_s + own_s

    def look_ahead(self) -> None:
        """Have the next instant come, or the horizon, unless that is planned already.

        NOTE: as ``Environment.schedule`` does it, for a time that is known to the bit.
        """
        queue = self.own._queue
        at_s = queue[0][0] if queue else inf
        if at_s >= self.horizon_s:
            at_s = self.horizon_s
        if at_s in self._planned:
            return
        self._planned.add(at_s)
        due_s, event = max(self.start_s + at_s, self.outer.now), _Instant(at_s, self._comes)
        heappush(self.outer._queue, (due_s, AFTER_EVERYTHING, next(self.outer._eid), event))  # type: ignore[arg-type, misc]

    def _comes(self, event: _Instant) -> None:
        at_s = event.at_s
        self._planned.discard(at_s)
        if self.failed:
            return
        if at_s >= self.horizon_s:
            self._over()
            return
        try:
            run_until(self.own, nextafter(at_s, inf))
        except BaseException:
            self.failed = True
            raise
        self._passed()
        self.look_ahead()


def log_so_far(floor: Any, replication: int, now_s: float, names: dict[str, tuple[str, ...]]) -> EventLog:
    """The log as if the horizon were now, in seconds of the floor's clock; the floor is as it was, and goes on."""
    writer, kept = LogWriter(), (floor.now, floor.horizon_s, floor.write, floor.rows)
    writer.rows.extend(floor.log.rows)
    since_s = [(job, job.since_s) for job in _jobs(floor)]  # a wait for tools that is written ends for the job, too
    floor.horizon_s, floor.write, floor.rows = now_s, writer.rows.extend, list(floor.rows)
    try:
        close(floor)
    finally:
        floor.now, floor.horizon_s, floor.write, floor.rows = kept
        for job, was_s in since_s:
            job.since_s = was_s
    return _until(writer.close(replication, now_s, names))


def _jobs(floor: Any) -> Iterator[Any]:
    job = floor.first_job
    while job is not None:
        yield job
        job = job.next_on_floor


def _until(log: EventLog) -> EventLog:
    """Nothing after the log's end: hours in which stations are closed are known ahead, and written whole."""
    ends_s, at_s = log["end_s"], log.horizon_s
    if not np.any(ends_s > at_s):
        return log
    kept = log.where((ends_s <= at_s) | (log["start_s"] < at_s))
    columns = {**kept.columns, "end_s": np.minimum(kept["end_s"], at_s)}
    order = np.lexsort([columns[name] for name in reversed(ORDER)])
    return EventLog(log.replication, at_s, columns, log.names).where(order)


class HumanSide:
    """Of the only worker of a floor on which nothing happens by itself."""

    def __init__(self, build: Build):
        self._floor: Any = build.floor
        self._worker: Any = build.workers[0]

    def level(self, now: float) -> float:
        """How tired he is, 0 (fresh, or where nobody tires) to 1."""
        self._floor.now = now
        return float(level(self._floor, self._worker.human))

    def drawn(self, now: float, task: int, k: int, drawn_s: float) -> tuple[float, float]:
        """Seconds of his k-th performance of a task, which begins now; and the shift that postures follow."""
        self._floor.now = now
        time_s = human_drawn(self._floor, None, self._worker, task, k, drawn_s)
        return time_s, self._worker.pace_shift

    def works(self, now: float, task: int, k: int, until_s: float, done: float) -> None:
        """He works on his k-th of a task from now, ``done`` of which is done, until then if nothing comes between."""
        self._floor.now = now
        works(self._floor, self._worker, task, until_s, done, k)

    def stops(self, now: float) -> None:
        """He is broken off."""
        self._floor.now = now
        stops(self._floor, self._worker)


def human_side_of(plan: Plan, workforce: int, now: float) -> HumanSide:
    """Of a plan with one worker and human effects, from now on."""
    build = Build(replace(plan, rule="nearest", idle="stay", start_s=plan.human.start_s))
    build.floor.draws = SimpleNamespace(workforce=workforce)
    for one in build.answers:
        one.begin(build.floor)
    human = build.workers[0].human
    human.at_s = now
    if plan.human.fatigue is not None:
        human.state.at_s = now
    return HumanSide(build)
