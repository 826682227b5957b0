"""A station that stops at times: one stop at a time, and what falls due meanwhile follows.

Breakdowns and planned maintenance: when they fall due, and who sees to them.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.flow import leave_floor, leave_station, withdraw
from opsim.engine.floor.log_rows import job_now
from opsim.engine.floor.machine import NOTHING, Handle, cast, drop, inlined, line_of, step
from opsim.engine.floor.random_numbers import REPAIR, UPTIME, planned
from opsim.engine.floor.state import Event, Job
from opsim.engine.rules import CALENDAR
from opsim.log import BREAKDOWN, DOWN, HELD, IS_DOWN, MAINTENANCE, SCRAP, SETUP, WORK
from opsim.subjects.breakdowns.breakdowns import (
    Countdown,
    Failing,
    Shop,
    Stop,
    begin_stop,
    clock_goes_on,
    clock_stops,
    cycle_done,
    end_stop,
    log_stop,
    renew,
    send_team,
    work_begins,
    work_ends,
)
from opsim.subjects.breakdowns.plan import CLOCK, CYCLES, NO_TEAM, BreakdownPlan, MaintenancePlan
from opsim.subjects.routes.routing import alarm, take_claim
from opsim.subjects.shifts.interruption import forget_progress, start_station, stop_station
from opsim.subjects.stations.station import proceed, quiet

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
ORDER = 50
"""Among the preparations of a job on a server: the last, where its operation would begin."""
BECOMES = {"resume": RESUMES, "restart": RESTARTS, "scrap": SCRAPPED}
_as_countdown = cast(Countdown)


@step
def set_going(floor: Floor, shop: Shop) -> bool:
    """All stations are up from the start, and what they fall due by is set going."""
    for i in range(shop.n_stops):
        stop = shop.stops[i]
        if stop.due_line:
            _set_alarm(floor, stop)
        else:
            renew(floor, stop.failing.wear, stop)
    for i in range(shop.n_failing):
        clock_goes_on(floor, shop.failing[i].wear)
    return False


@step
def see_to_stops(floor: Floor, shop: Shop) -> bool:
    """Stops that are due begin, and teams go where they are waited for; True where something was done."""
    changed, struck = False, shop.struck
    struck.clear()
    for one in shop.pending:
        struck.append(one)
    for other in struck:
        if strike(floor, other):
            changed = True
    for i in range(shop.n_teams):
        team = shop.teams[i]
        if len(team.waiting) > 0 and send_team(floor, team):
            changed = True
    return changed


@step
def close_stops(floor: Floor, shop: Shop) -> bool:
    """What the stations stand for at the horizon is written."""
    for i in range(shop.n_failing):
        if shop.failing[i].now:
            log_stop(floor, shop.failing[i].now)
    return False


@step
def worn_out(floor: Floor, event: Event) -> None:
    """The time until a breakdown is over."""
    countdown: Countdown = _as_countdown(event.subject)
    countdown.left_s = 0.0
    countdown.alarm = NOTHING
    fall_due(floor, countdown.stop)


@step
def maintenance_due(floor: Floor, event: Event) -> None:
    """It falls due again, and begins as soon as it may."""
    stop: Stop = _as_stop(event.subject)
    _set_alarm(floor, stop)
    fall_due(floor, stop)


@step
def _set_alarm(floor: Floor, stop: Stop) -> None:
    alarm(floor, stop.next_s, CALENDAR, stop.station.rank, stop.rank, stop.due_line, stop)
    stop.next_s = stop.every_s


@step
def station_repaired(floor: Floor, event: Event) -> None:
    """A repair is over."""
    stop: Stop = _as_stop(event.subject)
    repaired(floor, stop.failing)


def install(build: Any) -> None:
    """What stops stations, where something does."""
    plan, arena = build.plan, build.arena
    if not plan.stops:
        return
    shop = arena.new("Shop")
    teams = [_team(build, team.n) for team in plan.repair_teams]
    failing = {rank: _failing(build, shop, rank) for rank in sorted({one.station for one in plan.stops})}
    stops = []
    for rank, one in enumerate(plan.stops):
        stops.append(_stop(build, failing[one.station], rank, one))
        if one.team != NO_TEAM:
            stops[-1].team = teams[one.team]
    shop.n_failing, shop.failing = len(failing), arena.array("Failing", failing.values())
    shop.n_stops, shop.stops = len(stops), arena.array("Stop", stops)
    shop.n_teams, shop.teams = len(teams), arena.array("RepairTeam", teams)
    for one in failing.values():
        _open(build, one)
    build.hang(build.floor.starts, set_going, shop)
    build.hang(build.floor.dispatchers, see_to_stops, shop)
    build.hang(build.floor.closing, close_stops, shop)


def _team(build: Any, n: int) -> Handle:
    made = build.arena.new("RepairTeam")
    made.free = n
    return made


def _failing(build: Any, shop: Handle, rank: int) -> Handle:
    made = build.arena.new("Failing")
    made.station, made.shop, made.wear = build.stations[rank], shop, build.arena.new("Wear")
    return made


def _stop(build: Any, failing: Handle, rank: int, plan: BreakdownPlan | MaintenancePlan) -> Handle:
    made = build.arena.new("Stop")
    made.rank, made.station, made.failing, made.task = rank, failing.station, failing, plan.task
    made.n, made.kind = -1, DOWN
    made.repairs, made.over_line = planned(build, REPAIR, rank), build.line(station_repaired)
    if isinstance(plan, MaintenancePlan):
        made.cause, made.becomes, made.after_job = MAINTENANCE, RESUMES, plan.after_job
        made.next_s, made.every_s, made.due_line = plan.first_s, plan.every_s, build.line(maintenance_due)
    else:
        made.cause, made.becomes = BREAKDOWN, BECOMES[plan.job]
        _count(build, failing.wear, made, plan.by)
    return made


def _count(build: Any, wear: Handle, stop: Handle, by: str) -> None:
    """What counts towards the next breakdown is on the station's meter."""
    made = build.arena.new("Cycles" if by == CYCLES else "Countdown")
    made.stop, made.gaps = stop, planned(build, UPTIME, stop.rank)
    if by == CYCLES:
        wear.cycles.append(made)
    else:
        made.line = build.line(worn_out)
        (wear.clock if by == CLOCK else wear.busy).append(made)


def _open(build: Any, failing: Handle) -> None:
    station, wear = failing.station, failing.wear
    build.seat(station)
    if len(wear.busy) or len(wear.cycles):
        wear.begin_line, wear.end_line = build.line(work_begins), build.line(work_ends)
        wear.cycle_line = build.line(cycle_done)
        station.meter = wear
    build.hang(station.stages, may_begin, failing, ORDER)
    build.hang(station.switched, switch, failing)
