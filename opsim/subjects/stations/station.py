"""On a server: preparations, then task after task, by a worker or automatically."""

from __future__ import annotations

from opsim.engine.floor.event_list import new_event, on_grid, push_event, stretch
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.keys import is_better, keep_best
from opsim.engine.floor.log_rows import job_now
from opsim.engine.floor.machine import NOTHING, here, inlined, step
from opsim.engine.floor.state import GOES_ON, Event, Job, Station, Worker
from opsim.engine.rules import COMPLETION
from opsim.log import HELD, NO_WORKER
from opsim.subjects.people.worker import (
    begin,
    clear_bit,
    drawn_run_s,
    has_bit,
    is_ready,
    own_next_s,
    set_bit,
    set_free,
    task_of,
    time_here_s,
    walk,
    walk_time_s,
)
from opsim.subjects.routes.routing import give_up_claims, put_claim


@step
def arrive(floor: Floor, station: Station, job: Job) -> None:
    """The job is at the station: on a server where one is free, else in the queue."""
    if station.receive:
        station.receive.line(floor, station, job)
    elif station.serve:
        station.queue.append(job)
        station.serve.line(floor, station)
    elif station.free_servers:
        _seat(floor, station, job)
    else:
        station.queue.append(job)


@step
def fill_servers(floor: Floor, station: Station) -> None:
    """A server has come free: whoever is next in the queue moves up."""
    if station.serve:
        station.serve.line(floor, station)
    elif station.queue:
        seat(floor, station, next_in_line(floor, station))


@step
def next_in_line(floor: Floor, station: Station) -> Job:
    """The job of the queue that comes next, taken out of it."""
    if not station.order or len(station.queue) == 1:
        return station.queue.pop(0)
    at = 0
    for i in range(len(station.queue)):
        _ = station.order.line(floor, station, station.queue[i])
        if i == 0 or is_better(floor):
            at = i
            keep_best(floor)
    job = station.queue[at]
    del station.queue[at]
    return job


@step
def seat(floor: Floor, station: Station, job: Job) -> None:
    """The job takes a free server."""
    station.free_servers -= 1
    if station.has_seated:
        see_seated(floor, station, job)
    if job.stage != GOES_ON:
        job.task_position = 0
        job.repeats_done = 0
    job.stage = 0
    if station.stages:
        proceed(floor, job, NOTHING)
    else:
        _next_task(floor, job, floor.no_worker)


@step
def see_seated(floor: Floor, station: Station, job: Job) -> None:
    """A job is on a server from now on, which may be the one with the shortest set-up (``Servers.append``)."""
    station.seated.append(job)
    if station.setups:
        station.setups.takes_line(floor, station, job)


@step
def proceed(floor: Floor, job: Job, worker: Worker) -> None:
    """The preparations that are left, then the tasks; a worker at hand is free where the job has to wait."""
    station = job.station
    while job.stage < len(station.stages):
        stage = station.stages[job.stage]
        if not stage.line(floor, stage.subject, job):
            if worker:
                set_free(floor, worker)
            return
        job.stage += 1
    next_task(floor, job, worker)


@step
def next_task(floor: Floor, job: Job, worker: Worker) -> None:
    """Begin the task the job has come to: automatically, by the worker at hand, or by calling for one."""
    station = job.station
    if station.down or station.n_tasks == 0 or not is_ready(floor, station, job):
        not_yet(floor, station, job, worker)
    elif station.automatic[job.task_position]:
        if worker:
            set_free(floor, worker)
        _run_automatic(floor, station, job)
    elif worker:
        perform(floor, job, worker)
    else:
        _call(floor, station, job)


@step
def not_yet(floor: Floor, station: Station, job: Job, worker: Worker) -> None:
    """The station stands still, a tool is missing, or there is nothing (more) to do here."""
    if worker and job.held_by is not worker:
        set_free(floor, worker)
    if station.down:
        for hook in floor.broken_off:  # the tools of the task before lie at no closed station
            hook.line(floor, hook.subject, job)
        stand_still(floor, station, job)
    elif station.n_tasks == 0:
        floor.operation_line(floor, job)


@step
def stand_still(floor: Floor, station: Station, job: Job) -> None:
    """The job waits on its server until the station goes on."""
    job_now(floor, job, HELD, station.stands_for)
    station.standing.append(job)


@step
def call(floor: Floor, station: Station, job: Job) -> None:
    """The job on its server calls for a worker."""
    job_now(floor, job, HELD, NO_WORKER)
    put_claim(floor, station.calling, job, floor.now)
    if not has_bit(floor.calls, station.rank):
        set_bit(floor.calls, station.rank)
        floor.n_calling += 1
        floor.none_fits = 0


@step
def quiet(floor: Floor, station: Station) -> None:
    """Nobody calls at the station any more, where that is so."""
    if not station.calling and has_bit(floor.calls, station.rank):
        clear_bit(floor.calls, station.rank)
        floor.n_calling -= 1


@step
def call_off(floor: Floor, station: Station, job: Job) -> None:
    """The job calls for nobody any more."""
    give_up_claims(floor, station.calling, job)
    quiet(floor, station)


@step
def begin_setup(floor: Floor, job: Job, task: int) -> None:
    """Set the server up for the job: a performance of a task of its own, after which the preparations go on."""
    station = job.station
    job.setup_task = task
    if station.down:
        stand_still(floor, station, job)
    elif station.setup_attended and not floor.tasks[task].automatic:
        call(floor, station, job)
    else:
        run_automatic(floor, station, job)


@step
def go_on(floor: Floor, job: Job) -> None:
    """A job that stood still goes on: with its set-up, or with the task it had come to."""
    if job.setup_task < 0:
        next_task(floor, job, NOTHING)
    else:
        begin_setup(floor, job, job.setup_task)


@inlined
def go_and_perform(floor: Floor, worker: Worker, job: Job) -> None:
    """A worker who was given a job goes to its station, and performs there."""
    walk_s = walk_time_s(floor, worker, worker.station)
    if walk_s > 0:
        walk(floor, worker, worker.station.place, walk_s)
    else:
        worker.place = worker.station.place
        perform(floor, job, worker)


@step
def perform(floor: Floor, job: Job, worker: Worker) -> None:
    """The worker's next performance of the job's task begins now, or the rest of one that was interrupted."""
    station = job.station
    for act in station.acts:
        if act.line(floor, act.subject, job, worker):
            return
    if station.down:
        set_free(floor, worker)
        stand_still(floor, station, job)
        return
    task = task_of(job)
    if floor.has_levels and job.setup_task < 0:
        floor.asked_task = task
        floor.level_line(floor, job)
        task = floor.asked_task
    if job.rest_s:
        duration_s = rest_s(floor, job, worker, task)
        k = floor.asked_k
    else:
        time_s = own_next_s(floor, worker, task)
        k = floor.asked_k
        if worker.human:
            job.asked, job.asked_s, job.asked_done = 1, time_s, 0.0
        duration_s = time_here_s(floor, station, worker, task, k, time_s)
    begin(floor, job, worker.rank, task, k, duration_s)
    worker.kind, worker.since_s = job.kind, floor.now
    stretch(floor, worker, floor.stretch_line, duration_s)


@step
def rest_s(floor: Floor, job: Job, worker: Worker, task: int) -> float:
    """What is left of a performance that was broken off: for him who began it, or by somebody else's own next time.

    Where he has done nothing of it yet, human effects are those of now: it truly begins only now. Its number k is in
    ``floor.asked_k``.
    """
    station, before = job.station, job.progress_from
    if job.worker != worker.rank:
        time_s = own_next_s(floor, worker, task)
        k = floor.asked_k
        if worker.human:
            job.asked, job.asked_s, job.asked_done = 1, time_s, before
        whole_s = time_here_s(floor, station, worker, task, k, time_s)
        floor.asked_k = k
        return on_grid(whole_s * (1.0 - before))
    if not job.asked or job.asked_done != before or not worker.human:
        floor.asked_k = job.k
        return job.rest_s
    whole_s = time_here_s(floor, station, worker, task, job.k, job.asked_s)
    job.pace_shift = worker.pace_shift
    floor.asked_k = job.k
    return on_grid(whole_s * (1.0 - before))


@step
def drawn_s(floor: Floor, station: Station, worker: Worker, task: int) -> float:
    """The worker's own next duration of a task at a station; its number k is ``floor.asked_k``."""
    time_s = own_next_s(floor, worker, task)
    k = floor.asked_k
    duration_s = time_here_s(floor, station, worker, task, k, time_s)
    floor.asked_k = k
    return duration_s


@step
def run_automatic(floor: Floor, station: Station, job: Job) -> None:
    """The station does the job's task by itself, or the rest of a run that was interrupted."""
    task = task_of(job)
    if job.rest_s and job.worker < 0:
        duration_s, k = job.rest_s, job.k
    else:
        duration_s = drawn_run_s(floor, station, task)
        k = floor.asked_k
    begin(floor, job, -1, task, k, duration_s)
    over: Event = new_event(floor)
    over.line, over.alive = floor.automatic_line, 1
    over.kind, over.rank, over.number = COMPLETION, floor.n_workers + station.rank, job.number
    over.job = job
    job.over = over
    push_event(floor, floor.env_now + duration_s, over)


_seat, _next_task, _run_automatic, _call = here(seat), here(next_task), here(run_automatic), here(call)
