"""Where workers stand on a moving line: they walk with their jobs, and back to the next."""

from __future__ import annotations

from typing import Any

from opsim.clock import STEP_S
from opsim.engine import rules
from opsim.engine.floor.event_list import on_grid, stretch
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.log_rows import log_worker
from opsim.engine.floor.machine import Handle, cast, drop, inlined, line_of, step
from opsim.engine.floor.state import Event, Job, Worker
from opsim.engine.rules import COMPLETION
from opsim.log import IDLE, WAIT, WALK
from opsim.subjects.lines.paced_lines import Along, Line, job_m
from opsim.subjects.lines.plan import LinePlan
from opsim.subjects.people.worker import set_free, stop
from opsim.subjects.routes.routing import alarm

ORDER = 30
"""Among the ways to begin a task: a worker comes to his job first."""
INFINITE_S = rules.INFINITE_S
_meeting_s, _strolled_m = inlined(rules.meeting_s), inlined(rules.strolled_m)
_as_along = cast(Along)


@step
def act(floor: Floor, line: Line, job: Job, worker: Worker) -> bool:
    """Somebody is to begin: True where he has to walk to the job first."""
    along, at, began_s = line.along[worker.rank], job.station.line_at, job.block.line_began_s
    came = along.has_way == 1 and along.way_job is job
    _drop_way(line, along)
    if along.has_job and along.job is job and along.at == at:
        return False
    if not came:
        there_m = job_m(line, began_s, floor.now)
        here_m = _where_m(floor, line, along, at)
        if _to_meet_s(line, worker, there_m - here_m) > STEP_S:
            worker.kind, worker.since_s, worker.walk_from = WALK, floor.now, worker.place
            along.has_way, along.way_job, along.way_at = 1, job, at
            line.ways.append(along)
            _walk(floor, line, along, here_m, there_m)
            return True
    _drop_spot(line, along)
    if not along.has_job:
        along.has_job = 1
        line.with_job.append(along)
    along.job, along.began_s, along.at = job, began_s, at
    return False


@step
def stop_walks(floor: Floor, line: Line, job: Job, but: int) -> None:
    """Nobody, but for one of a rank, is to walk to a job any more: whoever does is free where he is."""
    at = 0
    while at < len(line.ways):
        along = line.ways[at]
        if along.way_job is job and along.worker.rank != but:
            _stop(floor, line, along)
        else:
            at += 1


@step
def look(floor: Floor, line: Line) -> bool:
    """Who has left his job stands where it is now, and walks back while nobody sends him."""
    at = 0
    while at < len(line.with_job):
        along = line.with_job[at]
        if along.worker.job is along.job:
            at += 1
        else:
            del line.with_job[at]
            along.has_job = 0
            _stand(floor, line, along, along.at, job_m(line, along.began_s, floor.now))
    at = 0
    while at < len(line.ways):
        along = line.ways[at]
        if along.worker.job is along.way_job:
            at += 1
        else:  # the job calls for somebody else, since he has to go
            _stop(floor, line, along)
    at = 0
    while at < len(line.spots):
        if _look_at(floor, line, line.spots[at]):
            at += 1
        else:
            _drop_spot(line, line.spots[at])
    return False


@step
def _look_at(floor: Floor, line: Line, along: Along) -> bool:
    """Whether somebody who is at no job still has a spot on the line; he walks back, or stops where he is sent."""
    worker = along.worker
    if worker.place != along.place:
        return False
    if along.strolls:
        if not worker.in_free or worker.kind != WALK:
            _put_spot(floor, line, along, _at_m(along, floor.now), along.to_m, 0)
    elif worker.in_free and worker.kind == WAIT:
        back_s = (along.from_m - along.to_m) / worker.walk_m_per_s
        if back_s > STEP_S:
            log_worker(floor, worker)
            worker.kind, worker.since_s, worker.walk_from = WALK, floor.now, worker.place
            _put_spot(floor, line, along, along.from_m, along.to_m, 1)
            event = alarm(floor, back_s, COMPLETION, worker.rank, 0, line_of_strolled, along)
            event.version = along.version
    return True


@step
def strolled(floor: Floor, event: Event) -> None:
    """He is where he may begin, if he was not sent or called away before."""
    along: Along = _as_along(event.subject)
    worker = along.worker
    if along.has_spot and along.version == event.version and worker.in_free and worker.kind == WALK:
        log_worker(floor, worker)
        worker.kind, worker.cause, worker.since_s = WAIT, IDLE, floor.now
        _put_spot(floor, along.line, along, along.to_m, along.to_m, 0)


line_of_strolled = line_of(strolled)


@step
def line_changed(floor: Floor, line: Line) -> None:
    """The line has come to stand, or to run: whoever walks to a job meets it at another time."""
    for along in line.ways:
        here_m = _on_the_way_m(along, floor.now)
        there_m = job_m(line, along.way_job.block.line_began_s, floor.now)
        stop(floor, along.worker)
        _walk(floor, line, along, here_m, there_m)


@inlined
def _at_m(along: Along, now: float) -> float:
    """Where somebody is who is at no job."""
    if not along.strolls:
        return along.from_m
    return _strolled_m(along.from_m, along.to_m, along.worker.walk_m_per_s, now - along.since_s)


@inlined
def _on_the_way_m(along: Along, now: float) -> float:
    walked_m = along.worker.walk_m_per_s * (now - along.way_since_s)
    return along.way_from_m + (walked_m if along.downstream else -walked_m)


@inlined
def _to_meet_s(line: Line, worker: Worker, gap_m: float) -> float:
    return _meeting_s(gap_m, worker.walk_m_per_s, line.speed_m_per_s if line.runs else 0.0)


@inlined
def _where_m(floor: Floor, line: Line, along: Along, at: int) -> float:
    """Where a worker is who stands at a station; who comes from elsewhere is where its stretch begins."""
    here_m = line.start_m[at]
    if along.has_job:
        here_m = job_m(line, along.began_s, floor.now)
    elif along.has_spot and along.place == along.worker.place:
        here_m = _at_m(along, floor.now)
    if along.has_job:
        along.has_job = 0
        drop(line.with_job, along)
    _drop_spot(line, along)
    return here_m


@inlined
def _walk(floor: Floor, line: Line, along: Along, here_m: float, there_m: float) -> None:
    """He walks from here to where he meets his job, which is there now."""
    along.way_from_m, along.way_since_s, along.downstream = here_m, floor.now, there_m > here_m
    seconds = _to_meet_s(line, along.worker, there_m - here_m)
    if seconds < INFINITE_S:  # else he follows the job until the line stands, or it is sent on
        stretch(floor, along.worker, floor.stretch_line, on_grid(seconds))


@step
def _stop(floor: Floor, line: Line, along: Along) -> None:
    """He walks no further, and is free."""
    _drop_way(line, along)
    _stand(floor, line, along, along.way_at, _on_the_way_m(along, floor.now))
    stop(floor, along.worker)
    set_free(floor, along.worker)


@inlined
def _stand(floor: Floor, line: Line, along: Along, at: int, here_m: float) -> None:
    """He is at no job any more, on the stretch of a station; elsewhere it does not matter where on the line."""
    if along.worker.place == line.stations[at].place:
        _put_spot(floor, line, along, here_m, line.reach_m[at], 0)


@inlined
def _put_spot(floor: Floor, line: Line, along: Along, from_m: float, to_m: float, strolls: int) -> None:
    if not along.has_spot:
        along.has_spot = 1
        line.spots.append(along)
    along.place, along.from_m, along.to_m = along.worker.place, from_m, to_m
    along.since_s, along.strolls = floor.now, strolls
    along.version += 1


@inlined
def _drop_spot(line: Line, along: Along) -> None:
    if along.has_spot:
        along.has_spot = 0
        drop(line.spots, along)


@inlined
def _drop_way(line: Line, along: Along) -> None:
    if along.has_way:
        along.has_way = 0
        drop(line.ways, along)


def hang_walks(build: Any, plan: LinePlan, line: Handle) -> None:
    """Have workers walk along a line."""
    walkers = []
    for worker in build.workers:
        along = build.arena.new("Along")
        along.line, along.worker = line, worker
        walkers.append(along)
    line.along = build.arena.array("Along", walkers)
    line.act_line, line.stop_walks_line = build.line(act), build.line(stop_walks)
    for rank in plan.stations:
        build.hang(build.stations[rank].acts, act, line, ORDER)
    build.hang(build.floor.dispatchers, look, line)
