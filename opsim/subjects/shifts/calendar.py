"""What the calendar brings: people come and go by their shifts, stations and sources open and close."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from opsim.engine.floor.floor_state import DUTY, Floor, Source
from opsim.engine.floor.log_rows import job_now, log_worker, new_row
from opsim.engine.floor.machine import Array, Handle, cast, inlined, line_of, step, struct
from opsim.engine.floor.random_numbers import ABSENCE, number_at, stream_of
from opsim.engine.floor.state import Event, Station, Worker
from opsim.engine.rules import CALENDAR, is_absent
from opsim.log import ABSENT, CLOSED, HELD, IS_DOWN, OFF, SETUP, WORK
from opsim.subjects.people.worker import leave_none, set_free, take_off
from opsim.subjects.release.plan import SATURATED
from opsim.subjects.routes.routing import alarm
from opsim.subjects.shifts import attendance, hand_over, overtime
from opsim.subjects.shifts.attendance import be_here, leave
from opsim.subjects.shifts.hand_over import release
from opsim.subjects.shifts.interruption import interrupt, shut_station, start_station, stop_station
from opsim.subjects.shifts.plan import OPEN
from opsim.subjects.shifts.shifts import (
    BEGIN,
    GONE,
    HERE,
    LEAVING,
    PAUSE,
    PAUSED,
    Duty,
    Moment,
    People,
    Presence,
    end_pause,
    presence_of,
)

_is_absent = inlined(is_absent)
_as_presence, _as_duty = cast(Presence), cast(Duty)


@step
def open_calendars(floor: Floor, people: People) -> bool:
    """Nobody who has shifts is there before the first of them begins."""
    for i in range(people.n):
        one = people.those[i]
        take_off(floor, one.worker, OFF, 0)
        turn(floor, one)
    return True


@step
def turns(floor: Floor, event: Event) -> None:
    """Something of somebody's calendar is due."""
    turn(floor, _as_presence(event.subject))


@step
def turn(floor: Floor, one: Presence) -> None:
    """Apply what is due of somebody's calendar, and wait for the next of it."""
    while one.next < one.n_moments:
        due = one.moments[one.next]
        if due.at_s > floor.now:
            rank = floor.n_stations + floor.n_sources + one.worker.rank
            alarm(floor, due.at_s - floor.now, CALENDAR, rank, 0, line_of_turns, one)
            return
        if due.what == BEGIN:
            _begin(floor, one, due.duty)
        elif due.what == PAUSE:
            _owe(floor, one, due)
        else:
            _end(floor, one, due)
        one.next += 1


@step
def _begin(floor: Floor, one: Presence, duty: Duty) -> None:
    """His shift begins. Who is still there from the one before goes on, and is not absent; unless he goes since he
    misses this one, which has followed at once.
    """
    if one.misses and one.state == LEAVING:
        return
    worker = one.worker
    one.duty, one.overtime, one.undecided = duty, 0, 0
    if one.state == GONE and _misses(floor, one, duty):
        _be_away(floor, worker, ABSENT)
        release(floor, worker)
    elif one.state == GONE:
        set_free(floor, worker)
        worker.place, worker.round = worker.home, -1
        be_here(floor, one)
    elif one.state == LEAVING:
        be_here(floor, one)


@step
def _end(floor: Floor, one: Presence, due: Moment) -> None:
    """His shift is over. Where another one follows at once, he goes only if he misses that."""
    worker, follows = one.worker, False
    one.owed.clear()
    missed = one.misses
    one.misses = 0
    if due.follows:
        follows = True
        one.misses = _misses(floor, one, due.follows)
    if one.state == GONE:
        _be_away(floor, worker, OFF)
    elif follows and not one.misses:
        if one.state == LEAVING:
            be_here(floor, one)
    elif not missed:
        if one.state == PAUSED:
            end_pause(floor, one)
        be_here(floor, one)
        most_s = due.duty.overtime_s
        if most_s > 0:  # whether he stays is seen when all who come at this instant are there
            one.overtime = one.undecided = 1
            leave_none(floor, worker, DUTY)
            rank = floor.n_stations + floor.n_sources + worker.rank
            event = alarm(floor, most_s, CALENDAR, rank, 2, line_of_overtime_over, one)
            event.other = due.duty
        else:
            leave(floor, one, True)


@step
def _owe(floor: Floor, one: Presence, due: Moment) -> None:
    """A pause begins: at once, or after the one before, or when he is done."""
    if one.state == GONE or one.duty is not due.duty:
        return
    one.owed.append(due.pause)
    if one.state == HERE:
        leave(floor, one, False)


@step
def _misses(floor: Floor, one: Presence, duty: Duty) -> bool:
    share = one.worker.absence
    if share <= 0:
        return False
    if not one.chances:
        one.chances = stream_of(floor, ABSENCE, one.worker.rank, 0, 0)
    return _is_absent(number_at(floor, one.chances, duty.number), share)


@inlined
def _be_away(floor: Floor, worker: Worker, kind: int) -> None:
    log_worker(floor, worker)
    worker.kind, worker.cause, worker.since_s = kind, 0, floor.now


@step
def overtime_over(floor: Floor, event: Event) -> None:
    """He goes, however much there is still to do."""
    one: Presence = _as_presence(event.subject)
    if one.overtime and one.duty is _as_duty(event.other):
        leave(floor, one, True)


line_of_turns, line_of_overtime_over = line_of(turns), line_of(overtime_over)


def install_shifts(build: Any) -> None:
    """The calendars of people, where somebody has one; after the blocks that set people free."""
    if all(worker.duties is None for worker in build.plan.workers):
        return
    people = build.floor.people = build.arena.new("People")
    those = [presence_of(build, worker) for worker in build.workers if _has_shifts(build, worker)]
    people.n, people.those = len(those), build.arena.array("Presence", those)
    hand_over.hang_ties(build)
    hand_over.hang_relief(build, people)
    overtime.set_needs(build, people)
    attendance.set_lines(build, people)
    attendance.hang_attendance(build, people)
    build.line(turns), build.line(overtime_over)
    build.hang(build.floor.starts, open_calendars, people)


def _has_shifts(build: Any, worker: Any) -> bool:
    return build.plan.workers[worker.rank].duties is not None


@struct
class Hours:
    """Of a station, or a source. rank : among stations, then sources; shut : whether it is closed at the start

    at_s, opens : n edges, when, and whether it opens; next : the one that comes next; closed : n_closed pairs of times
    saturated : n_saturated sources of that kind, in their order, all of the floor
    """

    station: Station
    source: Source
    rank: int
    shut: int
    n: int
    at_s: Array[float]
    opens: Array[int]
    next: int
    n_closed: int
    closed: Array[float]
    n_saturated: int
    saturated: Array[Source]


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
        floor.entries_full = 0
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


def install_opening_hours(build: Any) -> None:
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
