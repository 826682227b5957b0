"""What stops stations, and the teams that end it: who is waited for, since when, and what the log is told.

What is left until a station breaks down is counted in seconds by the clock, seconds at work, or cycles.
"""

from __future__ import annotations

from opsim.engine import rules
from opsim.engine.floor.event_list import on_grid
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.log_rows import new_row
from opsim.engine.floor.machine import NOTHING, Array, Call, List, inlined, step, struct
from opsim.engine.floor.random_numbers import next_number
from opsim.engine.floor.records import Stream
from opsim.engine.floor.state import Event, Job, Station
from opsim.engine.rules import BREAKDOWN
from opsim.engine.rules import REPAIR as REPAIR_REPORTED
from opsim.log import DOWN, REPAIR
from opsim.subjects.routes.routing import alarm, cancel


@struct
class RepairTeam:
    """free : how many stops more it can see to now."""

    free: int
    waiting: List[Stop]


@struct
class Stop:
    """One kind of breakdown or maintenance of a station.

    rank : among all stops; repairs : how long each of its repairs takes; n : how often it has come, less one
    failing : what is known of its station
    kind, since_s : DOWN or REPAIR, and since when, while the station stands because of it

    becomes : of jobs in work, one of RESUMES, RESTARTS, SCRAPPED of ``failing``

    task, cause : in its rows; next_s : of maintenance, until it falls due first, then every_s
    due_line, over_line : steps told when maintenance falls due, and when the repair is over
    """

    rank: int
    station: Station
    team: RepairTeam
    repairs: Stream
    failing: Failing
    n: int
    kind: int
    since_s: float
    task: int
    cause: int
    becomes: int
    after_job: int
    next_s: float
    every_s: float
    due_line: Call
    over_line: Call


@struct
class Failing:
    """closed : whether it is out of its hours

    now : because of which it stands; due : stops that are to come; held : jobs on servers that wait for them

    pending : all stations with stops that are due, by rank; shared by all

    shop : of all such stations; in_work, together : jobs gone through.
    """

    station: Station
    shop: Shop
    wear: Wear
    now: Stop
    due: List[Stop]
    held: List[Job]
    closed: int
    in_work: List[Job]
    together: List[Job]


@struct
class Shop:
    """All stations that fail, by rank, their stops and the teams. pending : stations with stops that are due, by rank

    struck : those of them that are gone through just now
    """

    n_failing: int
    failing: Array[Failing]
    n_stops: int
    stops: Array[Stop]
    n_teams: int
    teams: Array[RepairTeam]
    pending: List[Failing]
    struck: List[Failing]


@struct
class Countdown:
    """Seconds until one kind of breakdown. line : of the step that is told when they are over."""

    stop: Stop
    gaps: Stream
    left_s: float
    since_s: float
    alarm: Event
    line: Call


@struct
class Cycles:
    """Operations until one kind of breakdown."""

    stop: Stop
    gaps: Stream
    left: float


@struct
class Wear:
    """begin_line, end_line, cycle_line : steps told of the begin and end of a performance, and of an operation done.

    n_at_work : performances under way
    """

    begin_line: Call
    end_line: Call
    cycle_line: Call
    clock: List[Countdown]
    busy: List[Countdown]
    cycles: List[Cycles]
    n_at_work: int


_longest_down = inlined(rules.longest_down)


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


@inlined
def _run(floor: Floor, countdown: Countdown) -> None:
    """The seconds go by from now on."""
    if not countdown.alarm and countdown.left_s > 0:
        stop = countdown.stop
        countdown.since_s = floor.now
        countdown.alarm = alarm(
            floor, countdown.left_s, BREAKDOWN, stop.station.rank, stop.rank, countdown.line, countdown
        )


@inlined
def _hold(floor: Floor, countdown: Countdown) -> None:
    """The seconds stand still; what is left is kept, to the last tick."""
    if countdown.alarm:
        cancel(countdown.alarm)
        countdown.left_s -= floor.now - countdown.since_s
        countdown.alarm = NOTHING


@step
def work_begins(floor: Floor, wear: Wear) -> None:
    """A performance begins."""
    wear.n_at_work += 1
    if wear.n_at_work == 1:
        for one in wear.busy:
            _run(floor, one)


@step
def work_ends(floor: Floor, wear: Wear) -> None:
    """A performance ends, or is broken off."""
    wear.n_at_work -= 1
    if wear.n_at_work == 0:
        for one in wear.busy:
            _hold(floor, one)


@step
def cycle_done(floor: Floor, wear: Wear) -> None:
    """An operation is done."""
    for one in wear.cycles:
        one.left -= 1.0


@step
def clock_stops(floor: Floor, wear: Wear) -> None:
    """The station stops; what it does has been broken off before."""
    for one in wear.clock:
        _hold(floor, one)


@step
def clock_goes_on(floor: Floor, wear: Wear) -> None:
    """The station is up; what is at work on it begins after this."""
    for one in wear.clock:
        _run(floor, one)


@step
def renew(floor: Floor, wear: Wear, stop: Stop) -> None:
    """A breakdown is repaired: what counts towards it begins anew."""
    for one in wear.clock:
        if one.stop is stop:
            one.left_s = on_grid(next_number(floor, one.gaps))
    for other in wear.busy:
        if other.stop is stop:
            other.left_s = on_grid(next_number(floor, other.gaps))
    for each in wear.cycles:
        if each.stop is stop:
            each.left = next_number(floor, each.gaps)
