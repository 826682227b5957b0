"""The members of a crew: what each has in his hands, what he walks to, and where along the line he is."""

from __future__ import annotations

from opsim.engine.floor.machine import NOTHING, inlined, step
from opsim.engine.floor.parts.crews import Crew
from opsim.engine.floor.parts.rows import log_worker
from opsim.engine.floor.parts.state import DUTY, Floor, Job, Worker
from opsim.engine.floor.worker import be_busy, walk
from opsim.log import ABSENT, BREAK, OFF, WALK


@step
def tidy_people(floor: Floor, crew: Crew) -> None:
    """Jobs that have left the line are in nobody's hands; who is away has let go of his."""
    for member in range(crew.n_members):
        away = _is_away(crew.members[member])
        if away or crew.hand[member] not in crew.jobs:
            crew.hand[member] = NOTHING
        if away or crew.goal[member] not in crew.jobs:
            crew.goal[member] = NOTHING
        if away:
            crew.stand[member] = -1


@step
def reaches(floor: Floor, crew: Crew, member: int, job: Job, place: int) -> bool:
    """Whether a free member stands where a job is; else he goes there, or a part of the way."""
    if goes_to(floor, crew, member, place):
        return True
    crew.goal[member] = job
    return False


@step
def goes_to(floor: Floor, crew: Crew, member: int, place: int) -> bool:
    """Whether a free member is at a station of the line; else he sets out, along it only as far as the next one."""
    worker = crew.members[member]
    at = crew.stand[member]
    while worker.place != crew.stations[place].place or at != place:
        if at < 0 or not crew.is_brigade:
            at = place
        else:
            at += 1 if place > at else -1 if place < at else 0
        station = crew.stations[at]
        crew.stand[member] = at
        walk_s = worker.walk_s[worker.place * floor.n_stations + station.rank]
        if walk_s > 0:
            log_worker(floor, worker)
            be_busy(floor, worker)
            walk(floor, worker, station.place, walk_s)
            return False
        worker.place = station.place
    return True


@inlined
def _is_away(worker: Worker) -> bool:
    """Whether somebody is off, absent or resting, or walks and will be: only what he carries is still his."""
    if worker.kind == WALK:
        return not worker.job and worker.limited[DUTY] == 1
    away = worker.kind == BREAK or worker.kind == OFF or worker.kind == ABSENT
    return away and worker.in_free == 0
