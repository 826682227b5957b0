"""A station that stops at times: one stop at a time, and what falls due meanwhile follows."""

from __future__ import annotations

from opsim.engine.floor.interruption import forget_progress, start_station, stop_station
from opsim.engine.floor.machine import NOTHING, cast, drop, inlined, line_of, step
from opsim.engine.floor.material import leave_floor, leave_station, withdraw
from opsim.engine.floor.parts.claims import take_claim
from opsim.engine.floor.parts.failing import Failing, Stop
from opsim.engine.floor.parts.rows import job_now
from opsim.engine.floor.parts.state import Floor, Job
from opsim.engine.floor.station import proceed, quiet
from opsim.engine.floor.stops import begin_stop, end_stop
from opsim.engine.floor.wear import clock_goes_on, clock_stops, renew
from opsim.log import BREAKDOWN, HELD, IS_DOWN, SCRAP, SETUP, WORK

RESUMES, RESTARTS, SCRAPPED = range(3)
"""What becomes of the jobs that were in work."""
_as_stop = cast(Stop)


@step
def switch(floor: Floor, failing: Failing, closed: int) -> None:
    """The station closes, or opens: while it is closed the clock of what wears it out stands still."""
    failing.closed = closed
    if closed:
        clock_stops(floor, failing.wear)
    elif not failing.now:
        clock_goes_on(floor, failing.wear)


@step
def fall_due(floor: Floor, stop: Stop) -> None:
    """The stop begins as soon as it may; who waits already is not doubled."""
    failing = stop.failing
    if stop in failing.due:
        return
    failing.due.append(stop)
    pending = failing.shop.pending
    if failing not in pending:
        at = len(pending)
        while at > 0 and pending[at - 1].station.rank > failing.station.rank:
            at -= 1
        pending.insert(at, failing)


@step
def may_begin(floor: Floor, failing: Failing, job: Job) -> bool:
    """The last preparation of a job: no operation begins where a stop is due, or cycles are used up."""
    wear = failing.wear
    for one in wear.cycles:
        if one.left <= 0:
            fall_due(floor, one.stop)
    if not failing.now and len(failing.due) == 0:
        return True
    _hold(floor, failing, job)
    return False


@step
def strike(floor: Floor, failing: Failing) -> bool:
    """The station stops where a stop is due and may begin; True where it did."""
    if failing.now:
        return False
    stop = _next(floor, failing)
    if not stop:
        _call_off(floor, failing)
        return False
    station, in_work = failing.station, failing.in_work
    in_work.clear()
    for job in station.seated:
        if job.kind == WORK:
            in_work.append(job)
    stop_station(floor, station)
    clock_stops(floor, failing.wear)
    _take(floor, failing, stop)
    for one in in_work:
        if stop.becomes == RESTARTS:
            forget_progress(floor, one)
        elif stop.becomes == SCRAPPED:
            _scrap(floor, failing, one)
    return True


@step
def repaired(floor: Floor, failing: Failing) -> None:
    """The stop is over: the next one that is due follows, or the station goes on."""
    end_stop(floor, failing.now)
    failing.now = NOTHING
    stop = _next(floor, failing)
    if stop:
        _take(floor, failing, stop)
        return
    if not failing.closed:
        clock_goes_on(floor, failing.wear)
    start_station(floor, failing.station)
    held = failing.held
    n = len(held)
    while n:  # those that are held again meanwhile are behind the n
        at = 0
        for i in range(1, n):
            if held[i].number < held[at].number:
                at = i
        job = held[at]
        del held[at]
        n -= 1
        if job in failing.station.seated:
            proceed(floor, job, NOTHING)


@step
def _next(floor: Floor, failing: Failing) -> Stop:
    """The first stop that is due and may begin: what waits for jobs to be done lets others pass. Nothing: none may."""
    waits, seated = False, failing.station.seated
    for one in seated:
        if _is_begun(one) and one not in failing.held:
            waits = True
    for other in failing.due:
        if not waits or not other.after_job:
            return other
    return _as_stop(0)


@step
def _take(floor: Floor, failing: Failing, stop: Stop) -> None:
    drop(failing.due, stop)
    if len(failing.due) == 0:
        drop(failing.shop.pending, failing)
    failing.now = stop
    renew(floor, failing.wear, stop)
    begin_stop(floor, stop)


@step
def _call_off(floor: Floor, failing: Failing) -> None:
    """No worker, team or tool is waited for by a job that was not begun."""
    station, at = failing.station, 0
    while at < len(station.calling):
        job = station.calling[at].job
        if job.setup_task < 0 and not _is_begun(job):
            take_claim(floor, station.calling, at)
            _back_to_stage(failing, job)
            _hold(floor, failing, job)
        else:
            at += 1
    quiet(floor, station)
    if len(floor.call_off) == 0:
        return
    asked = failing.in_work
    asked.clear()
    for other in station.seated:
        asked.append(other)
    for job in asked:
        if job.stage == len(station.stages) and job.setup_task < 0 and not _is_begun(job) and _waited(floor, job):
            _back_to_stage(failing, job)
            _hold(floor, failing, job)


@inlined
def _waited(floor: Floor, job: Job) -> bool:
    """Whether the job waited for a team or a tool; all are asked."""
    waited = False
    for hook in floor.call_off:
        if hook.line(floor, hook.subject, job):
            waited = True
    return waited


@inlined
def _back_to_stage(failing: Failing, job: Job) -> None:
    """The job has this preparation before it again."""
    stages = failing.station.stages
    for i in range(len(stages)):
        if stages[i].line == line_of_may_begin:
            job.stage = i


@step
def _hold(floor: Floor, failing: Failing, job: Job) -> None:
    job_now(floor, job, HELD, IS_DOWN)
    failing.held.append(job)


@inlined
def _is_begun(job: Job) -> bool:
    """Whether something was done of the operation of a job on its server, and something is left."""
    if job.kind == WORK or job.kind == SETUP:
        return True
    if job.kind != HELD:
        return False
    return job.rest_s > 0 or job.repeats_done > 0 or 0 < job.task_position < job.station.n_tasks


@step
def _scrap(floor: Floor, failing: Failing, job: Job) -> None:
    """What was in work is lost, with all that was on the same server."""
    station, together = failing.station, failing.together
    together.clear()
    for one in station.seated:
        shares = False
        if job.seat:
            shares = one.seat is job.seat
        if one is job or shares:
            together.append(one)
    drop(station.standing, job)
    for one in together:
        if one.ahead:
            withdraw(floor, one)
        leave_station(floor, one)
        leave_floor(floor, one, SCRAP, BREAKDOWN, station.rank, -1)


line_of_may_begin = line_of(may_begin)
