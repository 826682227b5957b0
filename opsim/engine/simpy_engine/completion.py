"""What follows when a stretch of time is over: arrivals of walks, ends of performances, automatic ends, new jobs."""

from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.material import create, operation_done
from opsim.engine.simpy_engine.release import ARRIVED
from opsim.engine.simpy_engine.state import Job, Worker
from opsim.engine.simpy_engine.station import AUTOMATIC_DONE, next_task, perform, task_done
from opsim.engine.simpy_engine.transport import put_down
from opsim.engine.simpy_engine.worker import STRETCH_DONE, hold, log_worker, set_free
from opsim.log import TRANSPORT, WALK


def _stretch_done(floor: Floor, worker: Worker) -> None:
    job = worker.job
    if job is None:
        set_free(floor, worker)
    elif job.kind == TRANSPORT:
        put_down(floor, job, worker)
    elif worker.kind == WALK:
        log_worker(floor, worker)
        perform(floor, job, worker)
    elif task_done(job):
        _station_done(floor, worker, job)
    elif job.station.automatic[job.task_position]:  # type: ignore[union-attr]
        set_free(floor, worker)
        next_task(floor, job, None)
    else:
        next_task(floor, job, worker)


def _station_done(floor: Floor, worker: Worker, job: Job) -> None:
    operation_done(floor, job)
    if (job.plan.carried or floor.plan.when_blocked == "held") and job.number in floor.jobs:
        hold(floor, worker, job)
    else:
        set_free(floor, worker)


def _automatic_done(floor: Floor, job: Job) -> None:
    if task_done(job):
        operation_done(floor, job)
    else:
        next_task(floor, job, None)


def _arrived(floor: Floor, _number: int) -> None:
    create(floor)


HANDLERS: dict[str, Handler] = {STRETCH_DONE: _stretch_done, AUTOMATIC_DONE: _automatic_done, ARRIVED: _arrived}
