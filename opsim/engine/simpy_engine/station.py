"""On a server: preparations, then task after task, by a worker or automatically."""

from bisect import insort

import simpy

from opsim.clock import on_grid
from opsim.engine.rules import COMPLETION
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import GOES_ON, Job, Station, Worker
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import HELD, NO_WORKER, SETUP, WORK

AUTOMATIC_DONE = "automatic task done"
OPERATION_DONE = "operation done"


def arrive(floor: Floor, station: Station, job: Job) -> None:
    """The job is at the station: on a server where one is free, else in the queue."""
    if station.receive is not None:
        station.receive(floor, station, job)
    elif station.serve is not None:
        station.queue.append(job)
        station.serve(floor, station)
    elif station.free_servers:
        seat(floor, station, job)
    else:
        station.queue.append(job)


def fill_servers(floor: Floor, station: Station) -> None:
    """A server has come free: whoever is next in the queue moves up."""
    if station.serve is not None:
        station.serve(floor, station)
    elif station.queue:
        seat(floor, station, next_in_line(station))


def next_in_line(station: Station) -> Job:
    """The job of the queue that comes next, taken out of it."""
    queue = station.queue
    if station.order is None or len(queue) == 1:
        return queue.popleft()
    job = min(queue, key=station.order)
    queue.remove(job)
    return job


def seat(floor: Floor, station: Station, job: Job) -> None:
    """The job takes a free server."""
    station.free_servers -= 1
    if station.seated is not None:
        station.seated.append(job)
    if job.stage != GOES_ON:
        job.task_position = job.repeats_done = 0
    job.stage = 0
    if station.stages:
        proceed(floor, job)
    else:
        next_task(floor, job, None)


def proceed(floor: Floor, job: Job, worker: Worker | None = None) -> None:
    """The preparations that are left, then the tasks; a worker at hand is free where the job has to wait."""
    stages = job.station.stages
    while job.stage < len(stages):
        if not stages[job.stage](floor, job):
            if worker is not None:
                set_free(floor, worker)
            return
        job.stage += 1
    next_task(floor, job, worker)


def next_task(floor: Floor, job: Job, worker: Worker | None) -> None:
    """Begin the task the job has come to: automatically, by the worker at hand, or by calling for one."""
    station = job.station
    if station.down or not station.tasks or (station.ready is not None and not station.ready(floor, job)):
        _not_yet(floor, station, job, worker)
    elif station.automatic[job.task_position]:
        if worker is not None:
            set_free(floor, worker)
        run_automatic(floor, station, job)
    elif worker is not None:
        perform(floor, job, worker)
    else:  # NOTE: ``call`` written out, once for each operation
        now, rank = floor.now, station.rank
        if now > job.since_s:
            floor.log_job(job)
        job.kind, job.cause, job.since_s = HELD, NO_WORKER, now
        insort(station.calling, (-job.priority, now, job.number, job))
        floor.calling[rank] = station
        floor.calls |= 1 << rank


def _not_yet(floor: Floor, station: Station, job: Job, worker: Worker | None) -> None:
    """The station stands still, a tool is missing, or there is nothing (more) to do here."""
    if worker is not None and job.held_by is not worker:
        set_free(floor, worker)
    if station.down:
        for told in floor.broken_off:  # the tools of the task before lie at no closed station
            told(floor, job)
        stand_still(floor, station, job)
    elif not station.tasks:
        floor.tell(OPERATION_DONE, job)


def stand_still(floor: Floor, station: Station, job: Job) -> None:
    """The job waits on its server until the station goes on."""
    floor.job_now(job, HELD, station.stands_for)
    station.standing.append(job)


def call(floor: Floor, station: Station, job: Job) -> None:
    """The job on its server calls for a worker."""
    floor.job_now(job, HELD, NO_WORKER)
    insort(station.calling, (-job.priority, floor.now, job.number, job))
    floor.calling[station.rank] = station
    floor.calls |= 1 << station.rank


def quiet(floor: Floor, station: Station) -> None:
    """Nobody calls at the station any more."""
    if not station.calling and station.rank in floor.calling:
        del floor.calling[station.rank]
        floor.calls ^= 1 << station.rank


def call_off(floor: Floor, station: Station, job: Job) -> None:
    """The job calls for nobody any more."""
    station.calling = [claim for claim in station.calling if claim[3] is not job]
    quiet(floor, station)


def begin_setup(floor: Floor, job: Job, task: int) -> None:
    """Set the server up for the job: a performance of a task of its own, after which the preparations go on."""
    station = job.station
    job.setup_task = task
    if station.down:
        stand_still(floor, station, job)
    elif station.setup_attended and not floor.plan.tasks[task].automatic:
        call(floor, station, job)
    else:
        run_automatic(floor, station, job)


def go_on(floor: Floor, job: Job) -> None:
    """A job that stood still goes on: with its set-up, or with the task it had come to."""
    if job.setup_task < 0:
        next_task(floor, job, None)
    else:
        begin_setup(floor, job, job.setup_task)


def task_done(job: Job) -> bool:
    """Count one performance; True where all tasks of the station are done."""
    repeats = job.station.repeats
    job.repeats_done += 1
    if job.repeats_done == repeats[job.task_position] * (1 if job.lot == 1 else units(job)):
        job.repeats_done = 0
        job.task_position += 1
    return job.task_position == len(repeats)


def units(job: Job) -> int:
    """How many units of a lot the job's task is done for, each by itself."""
    per_lot = job.station.per_lot
    return 1 if per_lot[job.task_position] else job.lot


def perform(floor: Floor, job: Job, worker: Worker) -> None:
    """The worker's next performance of the job's task begins now, or the rest of one that was interrupted."""
    station = job.station
    if station.act is not None and station.act(floor, job, worker):
        return
    if station.down:
        set_free(floor, worker)
        stand_still(floor, station, job)
        return
    task = station.tasks[job.task_position] if job.setup_task < 0 else job.setup_task
    if job.rest_s:
        duration_s, k = _rest(floor, job, worker, task)
    else:  # NOTE: ``drawn_s`` written out, once for each performance
        luck = worker.luck.get(task)
        if luck is None:
            luck = worker.luck[task] = floor.draws.durations(task, worker.rank)
        k = worker.next_k[task]
        worker.next_k[task] = k + 1
        time_s = next(luck)
        if worker.human is not None:
            job.asked = time_s, 0.0
            time_s = worker.human.drawn(floor, station, task, k, time_s)
        duration_s = on_grid(time_s / worker.rating[station.rank])
    begin(floor, job, worker.rank, task, k, duration_s)
    worker.kind, worker.since_s = job.kind, floor.now
    floor.at_end_of(duration_s, worker.stretch_over)


def _rest(floor: Floor, job: Job, worker: Worker, task: int) -> tuple[float, int]:
    """What is left of a performance that was broken off: for him who began it, or by somebody else's own next time.

    Where he has done nothing of it yet, human effects are those of now: it truly begins only now.
    """
    rating, before = worker.rating[job.station.rank], job.progress_from
    if job.worker != worker.rank:
        time_s, k = _next(floor, worker, task)
        if worker.human is not None:
            job.asked = time_s, before
            time_s = worker.human.drawn(floor, job.station, task, k, time_s)
        return on_grid(on_grid(time_s / rating) * (1.0 - before)), k
    if job.asked is None or job.asked[1] != before or worker.human is None:
        return job.rest_s, job.k
    time_s = worker.human.drawn(floor, job.station, task, job.k, job.asked[0])
    job.pace_shift = worker.pace_shift
    return on_grid(on_grid(time_s / rating) * (1.0 - before)), job.k


def _next(floor: Floor, worker: Worker, task: int) -> tuple[float, int]:
    """The worker's own next time of a task, at rating 1 and without human effects, and its number k."""
    luck = worker.luck.get(task)
    if luck is None:
        luck = worker.luck[task] = floor.draws.durations(task, worker.rank)
    k = worker.next_k[task]
    worker.next_k[task] = k + 1
    return next(luck), k


def drawn_s(floor: Floor, station: Station, worker: Worker, task: int) -> tuple[float, int]:
    """The worker's own next duration of a task at a station, and its number k."""
    time_s, k = _next(floor, worker, task)
    if worker.human is not None:
        time_s = worker.human.drawn(floor, station, task, k, time_s)
    return on_grid(time_s / worker.rating[station.rank]), k


def run_automatic(floor: Floor, station: Station, job: Job) -> None:
    """The station does the job's task by itself, or the rest of a run that was interrupted."""
    task = station.tasks[job.task_position] if job.setup_task < 0 else job.setup_task
    if job.rest_s and job.worker < 0:
        duration_s, k = job.rest_s, job.k
    else:  # NOTE: ``drawn_run_s`` written out, once for each run
        luck = station.luck.get(task)
        if luck is None:
            luck = station.luck[task] = floor.draws.automatic_runs(task, station.rank)
        k = station.next_k.get(task, 0)
        station.next_k[task] = k + 1
        duration_s = on_grid(next(luck))
    begin(floor, job, -1, task, k, duration_s)
    rank = len(floor.workers) + station.rank
    over = job.over = floor.at_end_of(duration_s, simpy.Event(floor.env))
    over.callbacks.append(lambda _: floor.report(COMPLETION, rank, job.number, AUTOMATIC_DONE, job))


def drawn_run_s(floor: Floor, station: Station, task: int) -> tuple[float, int]:
    """The station's next duration of an automatic run of a task, and its number k."""
    luck = station.luck.get(task)
    if luck is None:
        luck = station.luck[task] = floor.draws.automatic_runs(task, station.rank)
    k = station.next_k.get(task, 0)
    station.next_k[task] = k + 1
    return on_grid(next(luck)), k


def begin(floor: Floor, job: Job, worker: int, task: int, k: int, duration_s: float) -> None:
    """A performance, or the rest of one, begins: the job is in work from now on."""
    now = floor.now
    if now > job.since_s:
        floor.log_job(job)
    job.kind, job.cause, job.since_s = WORK if job.setup_task < 0 else SETUP, 0, now
    if not job.rest_s or job.worker != worker or job.k != k:  # a rest by the same performer is the same performance
        job.performance_id = floor.n_performances
        floor.n_performances += 1
        job.pace_shift = floor.workers[worker].pace_shift if worker >= 0 else 0.0
    if floor.humans and worker >= 0:
        floor.humans[worker].works(now, task, now + duration_s, job.progress_from, k)
    job.worker, job.task, job.k, job.duration_s = worker, task, k, duration_s
    station = job.station
    if station.meter is not None:
        station.meter.begin(floor)


def ended(floor: Floor, job: Job) -> None:
    """A performance of the job is over, to its end; its row is written when the job's state changes."""
    if job.rest_s:
        floor.log_job(job)  # the last piece, while it is known where it began
        job.since_s = floor.now
        job.progress_from = job.rest_s = 0.0
    station = job.station
    if station.meter is not None:
        station.meter.end(floor)
