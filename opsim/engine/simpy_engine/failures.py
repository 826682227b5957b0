"""Breakdowns and planned maintenance: when they fall due, and who sees to them."""

from __future__ import annotations

from functools import partial

from opsim.clock import on_grid
from opsim.engine.rules import CALENDAR
from opsim.engine.simpy_engine.failing import Failing
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.stops import REPAIRED, Stop, Team
from opsim.engine.simpy_engine.wear import WORN_OUT, Countdown, Cycles
from opsim.plan import BreakdownPlan, MaintenancePlan, Plan
from opsim.plan.failures import CLOCK, CYCLES, NO_TEAM

MAINTENANCE_DUE = "maintenance is due"
ORDER = 50
"""Among the preparations of a job on a server: the last, where its operation would begin."""


def install(floor: Floor) -> None:
    """What stops stations, where something does."""
    plan = floor.plan
    found = plan.stops
    if not found:
        return
    teams = [Team(team.n) for team in plan.repair_teams]
    pending: dict[int, Failing] = {}
    failing = {rank: Failing(floor.stations[rank], pending) for rank in sorted({one.station for one in found})}
    for rank, one in enumerate(found):
        repairs = floor.draws.times(("repair", *_names(plan, one)), plan.tasks[one.task].model)
        team = None if one.team == NO_TEAM else teams[one.team]
        _add(floor, failing[one.station], Stop(one, rank, floor.stations[one.station], team, repairs))
    for station in failing.values():
        _open(floor, station)
    floor.dispatchers.append(partial(_dispatch, pending, teams))
    floor.closing.append(partial(_close, [*failing.values()]))


def _close(failing: list[Failing], floor: Floor) -> None:
    for one in failing:
        if one.now is not None:
            one.now.log(floor)


def _names(plan: Plan, one: BreakdownPlan | MaintenancePlan) -> tuple[str, str]:
    """The names of a station and of one of its stops, as parts of the name of a stream."""
    station = plan.stations[one.station].name
    return station, one.name.removeprefix(f"{station}: ")


def _add(floor: Floor, failing: Failing, stop: Stop) -> None:
    """What the stop falls due by is set going."""
    one = stop.plan
    stop.failing = failing
    if isinstance(one, MaintenancePlan):
        _set_alarm(floor, stop, one.first_s)
        return
    gaps = floor.draws.times(("uptime", *_names(floor.plan, one)), one.every)
    if one.by == CYCLES:
        failing.wear.cycles.append(Cycles(stop, gaps))
    else:
        (failing.wear.clock if one.by == CLOCK else failing.wear.busy).append(Countdown(stop, gaps))
    failing.wear.renew(stop)


def _open(floor: Floor, failing: Failing) -> None:
    """The station is up from the start; what blocks need of it is there."""
    station, wear = failing.station, failing.wear
    station.seated = [] if station.seated is None else station.seated
    if wear.busy or wear.cycles:
        station.meter = wear
    station.add_stage(ORDER, failing.may_begin)
    station.switched.append(failing.switch)
    wear.go_on(floor)


def _dispatch(pending: dict[int, Failing], teams: list[Team], floor: Floor) -> bool:
    """Stops that are due begin, and teams go where they are waited for; True where something was done."""
    changed = False
    if pending:
        for rank in sorted(pending):
            changed |= pending[rank].strike(floor)
    for team in teams:
        if team.waiting:
            changed |= team.send(floor)
    return changed


def _worn_out(_floor: Floor, countdown: Countdown) -> None:
    countdown.over()
    countdown.stop.failing.fall_due(countdown.stop)


def _maintenance_due(floor: Floor, stop: Stop) -> None:
    _set_alarm(floor, stop, stop.plan.every_s)  # type: ignore[union-attr]
    stop.failing.fall_due(stop)


def _set_alarm(floor: Floor, stop: Stop, delay_s: float) -> None:
    floor.alarm(on_grid(delay_s), CALENDAR, stop.station.rank, stop.rank, MAINTENANCE_DUE, stop)


def _repaired(floor: Floor, stop: Stop) -> None:
    stop.failing.repaired(floor)


HANDLERS: dict[str, Handler] = {WORN_OUT: _worn_out, MAINTENANCE_DUE: _maintenance_due, REPAIRED: _repaired}
