"""Stations that close and open, and sources whose clock runs in some hours only."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from math import nan

from opsim.clock import on_grid
from opsim.engine.rules import CALENDAR
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.interruption import interrupt, shut_station, start_station, stop_station
from opsim.engine.simpy_engine.state import Source, Station
from opsim.log import CLOSED, HELD, IS_DOWN, OFF, SETUP, WORK, pack_row
from opsim.plan.calendar import OPEN
from opsim.plan.release import SATURATED

OPENS_OR_CLOSES = "a station or a source opens or closes"
RESUME = "resume"


@dataclass(slots=True, eq=False)
class Hours:
    """of : what opens and closes; edges : (time, whether it opens) to come; rank : among stations, then sources."""

    of: Station | Source
    edges: Iterator[tuple[float, bool]]
    rank: int


def install(floor: Floor) -> None:
    """What has hours is closed until they begin."""
    n_stations = len(floor.stations)
    found: list[tuple[Station | Source, int]] = [(station, station.rank) for station in floor.stations]
    found += [(source, n_stations + source.rank) for source in floor.sources]
    for one, rank in found:
        open_s = one.plan.open_s
        if open_s is None:
            continue
        if isinstance(one, Station) and one.seated is None:
            one.seated = []
        if not open_s or open_s[0][0] > 0:
            _turn(floor, one, False)
        _wait(floor, Hours(one, _edges(open_s, floor.plan.horizon_s), rank))
    closing = [station for station in floor.stations if station.plan.open_s is not None]
    if closing:
        floor.closing.append(partial(_log_closed, closing))


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


def _wait(floor: Floor, hours: Hours) -> None:
    edge = next(hours.edges, None)
    if edge is not None:
        at_s, opens = edge
        floor.alarm(on_grid(at_s - floor.now), CALENDAR, hours.rank, 0, OPENS_OR_CLOSES, (hours, opens))


def _opens_or_closes(floor: Floor, what: tuple[Hours, bool]) -> None:
    hours, opens = what
    _turn(floor, hours.of, opens)
    _wait(floor, hours)


def _turn(floor: Floor, one: Station | Source, opens: bool) -> None:
    if isinstance(one, Source):
        _turn_source(floor, one, opens)
    elif opens:
        _open(floor, one)
    else:
        _close(floor, one)


def _turn_source(floor: Floor, source: Source, opens: bool) -> None:
    """A source that asks the floor whether it wants a job asks no more, or again; others keep their own time."""
    source.closed = not opens
    if source.plan.kind == SATURATED:
        floor.saturated = [one for one in floor.sources if one.plan.kind == SATURATED and not one.closed]


def _close(floor: Floor, station: Station) -> None:
    """Nothing begins any more. What is under way is done first, unless it stops with the station."""
    station.stands_for = CLOSED
    for told in station.switched:
        told(floor, True)
    if station.plan.at_close == RESUME:
        stop_station(floor, station)
    else:
        shut_station(floor, station)
        for job in station.seated or ():
            begins = job.since_s == floor.now and job.progress_from == 0  # else it goes on by somebody else from now on
            if job.kind in (WORK, SETUP) and begins:
                interrupt(floor, job, CLOSED)
                station.standing.append(job)
    _renamed(floor, station)


def _open(floor: Floor, station: Station) -> None:
    station.stands_for = IS_DOWN
    _renamed(floor, station)
    for told in station.switched:
        told(floor, False)
    start_station(floor, station)


def _renamed(floor: Floor, station: Station) -> None:
    """Jobs that stand for several reasons wait for that one which lasts."""
    for job in station.standing:
        if job.kind == HELD and job.cause != station.stands_for:
            floor.job_now(job, HELD, station.stands_for)


def _log_closed(stations: Iterable[Station], floor: Floor) -> None:
    for station in stations:
        for from_s, to_s in closed_times(station.plan.open_s or (), floor.plan.horizon_s):
            floor.write(pack_row(
                OFF, from_s, to_s, -1, station.rank, -1, -1, -1, -1, -1, -1,
                -1, -1, -1, nan, nan, nan, 0,
            ))  # fmt: skip


HANDLERS: dict[str, Handler] = {OPENS_OR_CLOSES: _opens_or_closes}
