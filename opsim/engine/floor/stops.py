"""Stops of stations and the teams that end them: who is waited for, since when, and what the log is told."""

from __future__ import annotations

from opsim.engine.floor.machine import inlined, step
from opsim.engine.floor.parts.events import alarm
from opsim.engine.floor.parts.failing import RepairTeam, Stop
from opsim.engine.floor.parts.luck import next_number
from opsim.engine.floor.parts.rows import new_row
from opsim.engine.floor.parts.state import Floor
from opsim.engine.rules import REPAIR as REPAIR_REPORTED
from opsim.engine.rules import repair
from opsim.log import DOWN, REPAIR

_longest_down = inlined(repair.longest_down)


@inlined
def _first(team: RepairTeam) -> int:
    """The number of the stop that has waited longest."""
    at = 0
    for i in range(1, len(team.waiting)):
        one, best = team.waiting[i], team.waiting[at]
        found = _longest_down(one.since_s, float(one.station.rank), float(one.rank))
        if found < _longest_down(best.since_s, float(best.station.rank), float(best.rank)):
            at = i
    return at


@step
def send_team(floor: Floor, team: RepairTeam) -> bool:
    """It sees to the stops that wait, as many as it can; True where it went to one."""
    went = False
    while team.free > 0 and len(team.waiting) > 0:
        at = _first(team)
        stop = team.waiting[at]
        del team.waiting[at]
        team.free -= 1
        begin_repair(floor, stop)
        went = True
    return went


@step
def begin_stop(floor: Floor, stop: Stop) -> None:
    """The station stands from now on: the team is called, or the repair begins."""
    stop.n += 1
    stop.kind, stop.since_s = DOWN, floor.now
    if stop.team:
        stop.team.waiting.append(stop)
    else:
        begin_repair(floor, stop)


@step
def begin_repair(floor: Floor, stop: Stop) -> None:
    """Somebody is there, or nobody is needed."""
    log_stop(floor, stop)
    stop.kind, stop.since_s = REPAIR, floor.now
    repair_s = next_number(floor, stop.repairs)
    alarm(floor, repair_s, REPAIR_REPORTED, stop.station.rank, stop.rank, stop.over_line, stop)


@step
def end_stop(floor: Floor, stop: Stop) -> None:
    """The repair is done, and the team is free."""
    log_stop(floor, stop)
    if stop.team:
        stop.team.free += 1


@step
def log_stop(floor: Floor, stop: Stop) -> None:
    """Write what the station waited for, or was given, until now."""
    if floor.now > stop.since_s:
        row = new_row(floor, stop.kind, stop.since_s)
        row.station, row.task, row.k, row.cause = stop.station.rank, stop.task, stop.n, stop.cause
