"""Workers: where they may serve, the states between stretches of their time, and the tasks they perform.

Human effects are asked and told by lines of the floor, so that others need none of their steps.
"""

from __future__ import annotations

from opsim.engine.floor.event_list import end_stretch, on_grid, stretch
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.log_rows import log_job, log_worker
from opsim.engine.floor.machine import NOTHING, Array, drop, inlined, step
from opsim.engine.floor.random_numbers import AUTOMATIC, DURATION, next_number, stream_of
from opsim.engine.floor.state import Job, Station, Worker
from opsim.log import IDLE, JOB_BLOCKED, SETUP, WAIT, WALK, WORK


@inlined
def has_bit(bits: Array[int], rank: int) -> bool:
    """Whether a station is in the set."""
    return (bits[rank >> 6] >> (rank & 63)) & 1 == 1


@inlined
def set_bit(bits: Array[int], rank: int) -> None:
    bits[rank >> 6] |= 1 << (rank & 63)


@inlined
def clear_bit(bits: Array[int], rank: int) -> None:
    bits[rank >> 6] &= ~(1 << (rank & 63))


@inlined
def may_serve(worker: Worker, station: Station) -> bool:
    """Whether he may be sent to a station now."""
    return (worker.skills[station.rank >> 6] >> (station.rank & 63)) & 1 == 1


@inlined
def see_skills(floor: Floor, worker: Worker) -> None:
    """The stations that his ratings and all limits leave him."""
    floor.none_fits = 0
    for word in range(floor.n_words):
        left = worker.own_skills[word]
        for limit in range(floor.n_limits):
            if worker.limited[limit]:
                left &= worker.limits[limit * floor.n_words + word]
        worker.skills[word] = left


@inlined
def leave_none(floor: Floor, worker: Worker, limit: int) -> None:
    """A limit leaves him no station."""
    worker.limited[limit] = 1
    for word in range(floor.n_words):
        worker.limits[limit * floor.n_words + word] = 0
        worker.skills[word] = 0


@inlined
def leave_those(floor: Floor, worker: Worker, limit: int, stations: Array[int]) -> None:
    """A limit leaves him some stations."""
    worker.limited[limit] = 1
    for word in range(floor.n_words):
        worker.limits[limit * floor.n_words + word] = stations[word]
    see_skills(floor, worker)


@inlined
def leave_all(floor: Floor, worker: Worker, limit: int) -> None:
    """A limit holds no more."""
    worker.limited[limit] = 0
    see_skills(floor, worker)


@inlined
def on_round(worker: Worker, station: Station) -> bool:
    """Whether this is the station of his round where the worker stands: the only one a patrolling worker serves, and
    none any more once he has served there as long as he shall.
    """
    at = worker.round
    return at >= 0 and worker.patrol[at] == station.rank and worker.place == station.place and not worker.served


@inlined
def human_drawn(floor: Floor, station: Station, worker: Worker, task: int, k: int, drawn_s: float) -> float:
    """His own next time as it is now, by ``humans.drawn``; ``worker.pace_shift`` is the shift of log time."""
    floor.asked_task, floor.asked_k, floor.asked_s = task, k, drawn_s
    floor.drawn_line(floor, worker, station)
    return floor.asked_s


@inlined
def time_here_s(floor: Floor, station: Station, worker: Worker, task: int, k: int, drawn_s: float) -> float:
    """How long a drawn time of his takes him at a station now, on the grid: human effects, then his rating."""
    time_s = drawn_s
    if worker.human:
        time_s = human_drawn(floor, station, worker, task, k, drawn_s)
    return on_grid(time_s / worker.rating[station.rank])


@inlined
def works(floor: Floor, worker: Worker, task: int, until_s: float, done: float, k: int) -> None:
    """He works from now until then, if nothing comes between; ``done`` of it was done before."""
    if worker.human:
        floor.asked_task, floor.asked_k, floor.asked_until_s, floor.asked_done = task, k, until_s, done
        floor.works_line(floor, worker)


@inlined
def stops(floor: Floor, worker: Worker) -> None:
    """What he worked on is broken off, or waits for something."""
    if worker.human:
        floor.stops_line(floor, worker)


@inlined
def stop(floor: Floor, worker: Worker) -> None:
    """The stretch under way means nothing any more."""
    end_stretch(floor, worker)
    stops(floor, worker)


@step
def set_free(floor: Floor, worker: Worker) -> None:
    """The worker is idle from now on and can be sent."""
    if worker.kind != WORK and worker.kind != SETUP:  # these are written with the job
        log_worker(floor, worker)
    worker.kind, worker.cause, worker.since_s = WAIT, IDLE, floor.now
    worker.job = NOTHING
    worker.station = NOTHING
    if not worker.in_free:
        worker.in_free = 1
        floor.none_fits = 0
        floor.free.append(worker)


@step
def be_busy(floor: Floor, worker: Worker) -> None:
    """He can be sent no more."""
    worker.in_free = 0
    drop(floor.free, worker)


@step
def take_off(floor: Floor, worker: Worker, kind: int, cause: int) -> None:
    """A free worker can be sent no more: he has a break, is off, or absent, until ``set_free``."""
    log_worker(floor, worker)
    be_busy(floor, worker)
    worker.kind, worker.cause, worker.since_s = kind, cause, floor.now


@step
def wait_by(floor: Floor, worker: Worker, cause: int) -> None:
    """The worker stands by his job and waits, for a cause."""
    log_worker(floor, worker)
    worker.kind, worker.cause, worker.since_s = WAIT, cause, floor.now


@step
def hold(floor: Floor, worker: Worker, job: Job) -> None:
    """The worker stays with a blocked job until it moves."""
    wait_by(floor, worker, JOB_BLOCKED)
    job.held_by = worker


@inlined
def walk_time_s(floor: Floor, worker: Worker, station: Station) -> float:
    """How long a worker walks to a station from where he is."""
    return worker.walk_s[worker.place * floor.n_stations + station.rank]


@step
def walk(floor: Floor, worker: Worker, place: int, walk_s: float) -> None:
    """The worker walks to a place and cannot be sent elsewhere before he is there."""
    worker.walk_from = worker.place
    worker.place = place
    worker.kind, worker.since_s = WALK, floor.now
    stretch(floor, worker, floor.stretch_line, on_grid(walk_s))


@inlined
def is_ready(floor: Floor, station: Station, job: Job) -> bool:
    """Whether nothing keeps the task a job has come to from beginning."""
    for ready in station.readies:
        if not ready.line(floor, ready.subject, job):
            return False
    return True


@inlined
def units(job: Job) -> int:
    """How many units of a lot the job's task is done for, each by itself."""
    return 1 if job.station.per_lot[job.task_position] else job.lot


@inlined
def task_done(job: Job) -> bool:
    """Count one performance; True where all tasks of the station are done."""
    station = job.station
    job.repeats_done += 1
    if job.repeats_done == station.repeats[job.task_position] * units(job):
        job.repeats_done = 0
        job.task_position += 1
    return job.task_position == station.n_tasks


@inlined
def task_of(job: Job) -> int:
    """The task a job has come to, or the set-up it is in or called for."""
    return job.station.tasks[job.task_position] if job.setup_task < 0 else job.setup_task


@inlined
def own_next_s(floor: Floor, worker: Worker, task: int) -> float:
    """The worker's own next time of a task, at rating 1, without human effects; ``floor.asked_k`` is its number.

    A task at a level is counted with all levels, so that item k is one luck: what others had of it is passed by.
    """
    luck = worker.luck[task]
    if not luck:
        luck = stream_of(floor, DURATION, worker.rank, task, 0)
        worker.luck[task] = luck
    of = floor.tasks[task].of if floor.has_levels else task
    k = worker.next_k[of]
    floor.asked_k = k
    if of != task:
        for _ in range(worker.next_k[task], k):
            next_number(floor, luck)
        worker.next_k[task] = k + 1
    worker.next_k[of] = k + 1
    return next_number(floor, luck)


@inlined
def drawn_run_s(floor: Floor, station: Station, task: int) -> float:
    """The station's next duration of an automatic run of a task; its number k is ``floor.asked_k``."""
    luck = station.luck[task]
    if not luck:
        luck = stream_of(floor, AUTOMATIC, station.rank, task, 0)
        station.luck[task] = luck
    k = station.next_k[task]
    station.next_k[task] = k + 1
    floor.asked_k = k
    return on_grid(next_number(floor, luck))


@inlined
def begin(floor: Floor, job: Job, worker: int, task: int, k: int, duration_s: float) -> None:
    """A performance, or the rest of one, begins: the job is in work from now on."""
    log_job(floor, job)
    job.kind = WORK if job.setup_task < 0 else SETUP
    job.cause, job.since_s = 0, floor.now
    if not job.rest_s or job.worker != worker or job.k != k:  # a rest by the same performer is the same performance
        job.performance_id = floor.n_performances
        floor.n_performances += 1
        job.pace_shift = floor.workers[worker].pace_shift if worker >= 0 else 0.0
    if worker >= 0:
        works(floor, floor.workers[worker], task, floor.now + duration_s, job.progress_from, k)
    job.worker, job.task, job.k, job.duration_s = worker, task, k, duration_s
    meter = job.station.meter
    if meter:
        meter.begin_line(floor, meter)


@inlined
def ended(floor: Floor, job: Job) -> None:
    """A performance of the job is over, to its end; its row is written when the job's state changes."""
    if job.setup_task < 0:
        job.level = 0
    if job.rest_s:
        log_job(floor, job)  # the last piece, while it is known where it began
        job.since_s = floor.now
        job.progress_from = 0.0
        job.rest_s = 0.0
    meter = job.station.meter
    if meter:
        meter.end_line(floor, meter)


@step
def attend(floor: Floor, job: Job, worker: Worker) -> bool:
    """The worker stays by the run, or by the rest of one that somebody else may have begun; False where it is down."""
    station = job.station
    if station.down:
        return False
    task = station.tasks[job.task_position]
    duration_s, k = job.rest_s, job.k
    if not job.rest_s:
        duration_s = drawn_run_s(floor, station, task)
        k = floor.asked_k
    worker.pace_shift = 0.0
    begin(floor, job, worker.rank, task, k, duration_s)
    worker.kind, worker.since_s = job.kind, floor.now
    stretch(floor, worker, floor.stretch_line, duration_s)
    return True
