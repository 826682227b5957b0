"""Breakdowns and planned maintenance: when they fall due, and who sees to them."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.failing import RESTARTS, RESUMES, SCRAPPED, fall_due, may_begin, repaired, strike, switch
from opsim.engine.floor.machine import NOTHING, Handle, cast, step
from opsim.engine.floor.parts.events import alarm
from opsim.engine.floor.parts.failing import Shop, Stop
from opsim.engine.floor.parts.luck import REPAIR, UPTIME, planned
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.state import Floor
from opsim.engine.floor.parts.wear import Countdown
from opsim.engine.floor.stops import log_stop, send_team
from opsim.engine.floor.wear import clock_goes_on, cycle_done, renew, work_begins, work_ends
from opsim.engine.rules import CALENDAR
from opsim.log import BREAKDOWN, DOWN, MAINTENANCE
from opsim.plan import BreakdownPlan, MaintenancePlan
from opsim.plan.failures import CLOCK, CYCLES, NO_TEAM

ORDER = 50
"""Among the preparations of a job on a server: the last, where its operation would begin."""
BECOMES = {"resume": RESUMES, "restart": RESTARTS, "scrap": SCRAPPED}
_as_countdown, _as_stop = cast(Countdown), cast(Stop)


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
