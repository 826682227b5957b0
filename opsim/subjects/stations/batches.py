"""Stations that serve batches.

Batches: several jobs take one server together, and its tasks are done once for all of them.
"""

from __future__ import annotations

from math import inf
from typing import Any

from opsim.engine import rules
from opsim.engine.floor.event_list import INF
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.flow import ask_after
from opsim.engine.floor.keys import comes_before, keep_key
from opsim.engine.floor.log_rows import job_now
from opsim.engine.floor.machine import NOTHING, Array, List, cast, drop, fresh, inlined, line_of, step, struct
from opsim.engine.floor.records import Seat
from opsim.engine.floor.state import Event, Job, Station
from opsim.engine.rules import CALENDAR
from opsim.log import BATCH, HELD, QUEUE
from opsim.subjects.routes.routing import alarm, stir
from opsim.subjects.stations.station import seat, see_seated


@struct
class Oven:
    """overdue : whether one of the jobs in the queue may have waited long enough; class_of : (P,)

    line : the jobs in the order of the queue; classes : of those, as they come first; n_of, since_s : (C,) of each, how
    many wait, and since when the first does; together : the next batch
    """

    station: Station
    size: int
    most_wait_s: float
    class_of: Array[int]
    overdue: int
    line: List[Job]
    classes: List[int]
    n_of: Array[int]
    since_s: Array[float]
    together: List[Job]


ORDER = 0
"""Among what is asked when an operation is done."""
_batch_begins = inlined(rules.batch_begins)
_as_oven, _new_seat = cast(Oven), fresh(Seat)


@step
def serve(floor: Floor, station: Station) -> None:
    """Begin batches as long as there are servers and jobs for them, and the station is up; the others wait on."""
    oven = station.oven
    _welcome(floor, oven)
    while station.free_servers and not station.down and _find_next(floor, oven):
        _begin(floor, oven)
    cause = BATCH if station.free_servers else 0
    for job in station.queue:
        if job.cause != cause and job.kind == QUEUE:
            job_now(floor, job, QUEUE, cause)


@step
def serve_overdue(floor: Floor, oven: Oven) -> bool:
    """Begin what has waited long enough, once all that came at this instant is there; True: something began."""
    if not oven.overdue:
        return False
    oven.overdue = 0
    free = oven.station.free_servers
    serve(floor, oven.station)
    return oven.station.free_servers < free


@step
def _welcome(floor: Floor, oven: Oven) -> None:
    """Take note of who has come since."""
    queue = oven.station.queue
    for job in queue:
        if job.block.oven is not oven:
            job.block.oven, job.block.oven_since_s = oven, floor.now
            if oven.most_wait_s < INF:
                alarm(floor, oven.most_wait_s, CALENDAR, oven.station.rank, job.number, _line_of_waited_enough, oven)


@step
def waited_enough(floor: Floor, event: Event) -> None:
    """A job has waited long enough for a batch."""
    oven: Oven = _as_oven(event.subject)
    oven.overdue = 1


@step
def _find_next(floor: Floor, oven: Oven) -> bool:
    """Put together the jobs of the next batch in the order of the queue, of the first class that may begin."""
    _line_up(floor, oven)
    for one in oven.classes:
        oven.n_of[one] = 0
    oven.classes.clear()
    oven.together.clear()
    for job in oven.line:
        of, since_s = oven.class_of[job.product], job.block.oven_since_s
        if not oven.n_of[of]:
            oven.classes.append(of)
            oven.since_s[of] = since_s
        oven.n_of[of] += 1
        oven.since_s[of] = min(oven.since_s[of], since_s)
    for of in oven.classes:
        if _batch_begins(oven.n_of[of], oven.size, floor.now - oven.since_s[of], oven.most_wait_s):
            _put_together(floor, oven, of)
            return True
    return False


@step
def _put_together(floor: Floor, oven: Oven, of: int) -> None:
    """The first jobs of a class in line."""
    for one in oven.line:
        if len(oven.together) < oven.size and oven.class_of[one.product] == of:
            oven.together.append(one)


@step
def _line_up(floor: Floor, oven: Oven) -> None:
    """The jobs of the queue in the order in which they are served."""
    station, line = oven.station, oven.line
    line.clear()
    for job in station.queue:
        at = len(line)
        if station.order:
            _ = station.order.line(floor, station, job)
            keep_key(floor, job)
            while at > 0 and comes_before(job, line[at - 1]):
                at -= 1
        line.insert(at, job)


@step
def _begin(floor: Floor, oven: Oven) -> None:
    """The first of them stands for all: it is worked on, the others are with it."""
    station, together = oven.station, oven.together
    leader = together[0]
    shared: Seat = _new_seat(floor)
    shared.n_jobs = len(together)
    for one in together:
        drop(station.queue, one)
        one.block.oven = NOTHING
        one.seat = shared
    leader.members.clear()
    for i in range(1, len(together)):
        leader.members.append(together[i])
    for job in leader.members:
        job_now(floor, job, HELD, BATCH)
        job.task_position = job.repeats_done = 0
        if station.has_seated:
            see_seated(floor, station, job)
    station.capacity += len(together)
    floor.entries_full = 0
    stir(floor, station)
    seat(floor, station, leader)


@step
def done(floor: Floor, oven: Oven, job: Job) -> bool:
    """What holds for the first of a batch when its operation is done holds for each of them."""
    while job.members:
        ask_after(floor, job.members.pop(0))
    return True


_line_of_waited_enough = line_of(waited_enough)


def install(build: Any) -> None:
    """Stations that serve batches: their jobs wait in the buffer, and have no room on servers before they begin."""
    for plan in build.plan.batches:
        build.keep_jobs()
        build.line(waited_enough)
        station = build.stations[plan.station]
        oven = station.oven = _oven(build, plan, station)
        station.capacity -= station.servers
        station.per_lot = build.ints([1] * station.n_tasks)
        station.serve = build.hook(serve)
        build.hang(station.afters, done, oven, ORDER)
        if plan.most_wait_s < inf:
            build.hang(build.floor.dispatchers, serve_overdue, oven)


def _oven(build: Any, plan: Any, station: Any) -> Any:
    made = build.arena.new("Oven")
    made.station, made.size, made.most_wait_s = station, plan.size, plan.most_wait_s
    n_classes = 1 + max(plan.class_of, default=0)
    made.class_of, made.n_of = build.ints(plan.class_of), build.ints([0] * n_classes)
    made.since_s = build.floats([0.0] * n_classes)
    return made
