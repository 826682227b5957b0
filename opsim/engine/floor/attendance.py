"""Who has to go, who is back, who stays on: what is to be seen of people who have shifts in every instant."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.leaving import leave_job, stand_by
from opsim.engine.floor.machine import NOTHING, cast, inlined, step
from opsim.engine.floor.overtime import need
from opsim.engine.floor.parts.bits import leave_all, leave_none
from opsim.engine.floor.parts.moments import GONE, HERE, LEAVING, PAUSED
from opsim.engine.floor.parts.people import People
from opsim.engine.floor.parts.presence import Pause, Presence
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.state import DUTY, Floor, Job, Station, Worker
from opsim.engine.floor.pauses import begin_pause, end_pause, rest
from opsim.engine.floor.relief import be_wanted_no_more, send_takers
from opsim.engine.floor.station import go_on
from opsim.engine.floor.ties import go_back, goes_off, met, release, send_carriers
from opsim.engine.floor.worker import set_free, take_off
from opsim.engine.rules.duty import stays_on
from opsim.log import ABSENT, BREAK, OFF, REST, WALK

ORDER = 10
"""Among the ways to begin a task: before all others, since who has to go begins none."""

_stays_on = inlined(stays_on)
_as_presence, _as_pause = cast(Presence), cast(Pause)


@step
def act(floor: Floor, subject: Any, job: Job, worker: Worker) -> bool:
    """Somebody is about to begin a task: he waits to carry, or has to go and does not begin it."""
    if met(floor, job, worker):
        return True
    one = worker.presence
    if not one:
        return False
    if one.state != LEAVING or worker.staying is job:
        return False
    worker.since_s = floor.now  # what he did until now is written, or will be with the job
    set_free(floor, worker)
    go_on(floor, job)
    return True


@step
def look(floor: Floor, people: People) -> bool:
    """Whoever may go goes, who is back goes on, and who is to be relieved is; True where something changed."""
    changed = False
    if people.n_watched:
        changed = _look_at_all(floor, people)
    if people.n_asked and send_takers(floor):
        _look_at_all(floor, people)  # who was relieved at once goes, before the idle walk on or home
        changed = True
    if people.left and send_carriers(floor):
        changed = True
    return changed


@step
def be_here(floor: Floor, one: Presence) -> None:
    """He need not go any more, and can be sent; but where a job waits for him, nowhere else."""
    worker = one.worker
    one.state, one.goes, worker.going = HERE, 0, 0
    worker.staying = NOTHING
    be_wanted_no_more(floor, worker)
    if worker.tied:
        leave_none(floor, worker, DUTY)
    else:
        leave_all(floor, worker, DUTY)
    _watch(floor, one)


@inlined
def _watch(floor: Floor, one: Presence) -> None:
    """He is looked at as soon as he is free."""
    if not one.watched:
        one.watched = 1
        floor.people.n_watched += 1


@inlined
def _watch_no_more(floor: Floor, one: Presence) -> None:
    if one.watched:
        one.watched = 0
        floor.people.n_watched -= 1


@step
def leave(floor: Floor, one: Presence, goes: bool) -> None:
    """He has to go: now where he may, else as soon as he may."""
    worker, duty = one.worker, one.duty
    one.state, one.goes, worker.going = LEAVING, goes, goes
    one.overtime = one.undecided = 0
    leave_none(floor, worker, DUTY)
    _watch(floor, one)
    job = worker.job
    stays = leave_job(floor, worker, duty.at_end if goes else duty.at_break)
    worker.staying = NOTHING
    if stays:
        worker.staying = job
    if worker.in_free:
        _go(floor, one)


@step
def pause_over(floor: Floor, event: Event) -> None:
    """He comes back, or has the next pause that he is owed."""
    one: Presence = _as_presence(event.subject)
    if one.pause is not _as_pause(event.other):
        return
    end_pause(floor, one)
    if one.owed:
        one.state = LEAVING
        _watch(floor, one)
    else:
        be_here(floor, one)


@step
def _look_at_all(floor: Floor, people: People) -> bool:
    changed = False
    for i in range(people.n):
        if people.those[i].watched and _look_at(floor, people.those[i]):
            changed = True
    return changed


@step
def _look_at(floor: Floor, one: Presence) -> bool:
    """True where something became of him."""
    worker = one.worker
    if one.undecided:
        return _decide(floor, one)
    if one.state == LEAVING:
        stand_by(floor, worker)
    if not worker.in_free:
        return one.overtime == 1 and _rests_for_nobody(floor, one) == 1
    if one.state == LEAVING:
        _go(floor, one)
    elif one.state == PAUSED:
        _watch_no_more(floor, one)
        rest(floor, one)
    else:
        return _set_to_work(floor, one)
    return True


@step
def _set_to_work(floor: Floor, one: Presence) -> bool:
    """He is free, and there: back to the job that waits for him, or to whatever comes; False where he stays on."""
    worker = one.worker
    if not one.overtime:
        _watch_no_more(floor, one)
    leave_all(floor, worker, DUTY)
    if go_back(floor, worker) or not one.overtime:
        return True
    if floor.stirred or need(floor, one):
        return False
    leave(floor, one, True)
    return True


@step
def _rests_for_nobody(floor: Floor, one: Presence) -> bool:
    """Who rests by need in overtime goes home instead, where nobody needs him; True where he does."""
    worker = one.worker
    if worker.kind != BREAK or worker.cause != REST or floor.stirred or need(floor, one):
        return False
    leave(floor, one, True)
    return True


@step
def _decide(floor: Floor, one: Presence) -> bool:
    """At the end of his shift: he stays, or has to go; which is seen when all jobs are in that come in now."""
    if floor.stirred:
        return False
    one.undecided = 0
    if _stays_on(need(floor, one) == 1, one.duty.overtime_s):
        be_here(floor, one)
    else:
        leave(floor, one, True)
    return True


@step
def left(floor: Floor, people: People, job: Job, station: Station) -> None:
    """Who stayed for a job's tasks at a station is done there as the job leaves it."""
    if not people.n_watched:
        return
    for i in range(people.n):
        worker = people.those[i].worker
        if people.those[i].watched and worker.staying is job:
            worker.staying = NOTHING


@step
def _go(floor: Floor, one: Presence) -> None:
    """He is free, and goes: off, or to the pause that he is owed."""
    worker = one.worker
    be_wanted_no_more(floor, worker)
    worker.staying = NOTHING
    if one.goes:
        one.state, one.goes, worker.going = GONE, 0, 0
        one.duty = NOTHING
        take_off(floor, worker, ABSENT if one.misses else OFF, 0)
        goes_off(floor, worker)
        if one.misses:
            release(floor, worker)
    else:
        one.state = PAUSED
        begin_pause(floor, one)
    if worker.kind != WALK:
        _watch_no_more(floor, one)


def hang(build: Any, people: Any) -> None:
    """Whoever has shifts is looked at in every round of an instant."""
    people.pause_over_line = build.line(pause_over)
    build.hang(build.floor.dispatchers, look, people)
    build.hang(build.floor.left_station, left, people)
    for station in build.stations:
        build.hang(station.acts, act, people, ORDER)
