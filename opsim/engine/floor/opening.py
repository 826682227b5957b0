"""Stations that close and open, and sources whose clock runs in some hours only."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from opsim.engine.floor.interruption import interrupt, shut_station, start_station, stop_station
from opsim.engine.floor.machine import Handle, cast, line_of, step
from opsim.engine.floor.parts.events import alarm
from opsim.engine.floor.parts.hours import Hours
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.rows import job_now, new_row
from opsim.engine.floor.parts.state import Floor, Station
from opsim.engine.rules import CALENDAR
from opsim.log import CLOSED, HELD, IS_DOWN, OFF, SETUP, WORK
from opsim.plan.calendar import OPEN
from opsim.plan.release import SATURATED

_as_hours = cast(Hours)


@step
def begin_hours(floor: Floor, hours: Hours) -> bool:
    """What has hours is closed until they begin."""
    if hours.shut:
        _turn(floor, hours, 0)
    _wait(floor, hours)
    return False


@step
def _wait(floor: Floor, hours: Hours) -> None:
    if hours.next < hours.n:
        delay_s = hours.at_s[hours.next] - floor.now
        alarm(floor, delay_s, CALENDAR, hours.rank, 0, line_of_opens_or_closes, hours)


@step
def opens_or_closes(floor: Floor, event: Event) -> None:
    """A station or a source opens or closes."""
    hours: Hours = _as_hours(event.subject)
    opens = hours.opens[hours.next]
    hours.next += 1
    _turn(floor, hours, opens)
    _wait(floor, hours)


@step
def _turn(floor: Floor, hours: Hours, opens: int) -> None:
    if hours.source:
        _turn_source(floor, hours, opens)
    elif opens:
        _open(floor, hours.station)
    else:
        _close(floor, hours.station)


@step
def _turn_source(floor: Floor, hours: Hours, opens: int) -> None:
    """A source that asks the floor whether it wants a job asks no more, or again; others keep their own time."""
    hours.source.closed = 1 - opens
    if hours.n_saturated:
        floor.saturated.clear()
        for i in range(hours.n_saturated):
            if not hours.saturated[i].closed:
                floor.saturated.append(hours.saturated[i])


@step
def _close(floor: Floor, station: Station) -> None:
    """Nothing begins any more. What is under way is done first, unless it stops with the station."""
    station.stands_for = CLOSED
    for hook in station.switched:
        hook.line(floor, hook.subject, 1)
    if station.finishes_at_close:
        shut_station(floor, station)
        for job in station.seated:
            begins = job.since_s == floor.now and job.progress_from == 0  # else it goes on by somebody else from now on
            if begins and (job.kind == WORK or job.kind == SETUP):
                interrupt(floor, job, CLOSED)
                station.standing.append(job)
    else:
        stop_station(floor, station)
    _renamed(floor, station)


@step
def _open(floor: Floor, station: Station) -> None:
    station.stands_for = IS_DOWN
    _renamed(floor, station)
    for hook in station.switched:
        hook.line(floor, hook.subject, 0)
    start_station(floor, station)


@step
def _renamed(floor: Floor, station: Station) -> None:
    """Jobs that stand for several reasons wait for that one which lasts."""
    for job in station.standing:
        if job.kind == HELD and job.cause != station.stands_for:
            job_now(floor, job, HELD, station.stands_for)


@step
def log_closed(floor: Floor, hours: Hours) -> bool:
    """Write all times in which a station is closed."""
    for i in range(hours.n_closed):
        row = new_row(floor, OFF, hours.closed[2 * i])
        row.end_s, row.station = hours.closed[2 * i + 1], hours.station.rank
    return False


line_of_opens_or_closes = line_of(opens_or_closes)


def install(build: Any) -> None:
    """What has hours opens and closes by them."""
    floor, stations, sources = build.floor, build.plan.stations, build.plan.sources
    saturated = [source for source in build.sources if sources[source.rank].kind == SATURATED]
    for rank, one in enumerate((*stations, *sources)):
        if one.open_s is None:
            continue
        hours = _hours(build, rank, one.open_s)
        if rank < len(stations):
            hours.station = build.stations[rank]
            build.seat(hours.station)
            build.hang(floor.closing, log_closed, hours)
        else:
            hours.source = build.sources[rank - len(stations)]
            if one.kind == SATURATED:
                hours.n_saturated, hours.saturated = len(saturated), build.arena.array("Source", saturated)
        build.line(opens_or_closes)
        build.hang(floor.starts, begin_hours, hours)


def _hours(build: Any, rank: int, open_s: Any) -> Handle:
    """Edges after the start and before the horizon; and the times between."""
    made, horizon_s = build.arena.new("Hours"), build.plan.horizon_s
    edges, closed = [*_edges(open_s, horizon_s)], [*closed_times(open_s, horizon_s)]
    made.rank, made.shut = rank, not open_s or open_s[0][0] > 0
    made.n, made.at_s = len(edges), build.floats(at_s for at_s, _ in edges)
    made.opens = build.ints(opens for _, opens in edges)
    made.n_closed, made.closed = len(closed), build.floats(edge for pair in closed for edge in pair)
    return made


def closed_times(open_s: OPEN, horizon_s: float) -> Iterator[tuple[float, float]]:
    """(from_s, to_s) of each time in which something is closed, in order."""
    last_s = 0.0
    for from_s, to_s in open_s:
        if from_s > last_s:
            yield last_s, from_s
        last_s = to_s
    if last_s < horizon_s:
        yield last_s, horizon_s


def _edges(open_s: OPEN, horizon_s: float) -> Iterator[tuple[float, bool]]:
    """(time, whether it opens) of what changes after the start and before the horizon."""
    for from_s, to_s in open_s:
        if from_s > 0:
            yield from_s, True
        if to_s < horizon_s:
            yield to_s, False
