"""Automatic tasks that somebody attends: the station's time, and a worker who stays."""

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Job, Worker
from opsim.engine.simpy_engine.station import begin, drawn_run_s


def attend(floor: Floor, job: Job, worker: Worker) -> bool:
    """The worker stays by the run, or by the rest of one that somebody else may have begun; False where it is down."""
    station = job.station
    if station.down:
        return False
    task = station.tasks[job.task_position]
    duration_s, k = (job.rest_s, job.k) if job.rest_s else drawn_run_s(floor, station, task)
    worker.pace_shift = 0.0
    begin(floor, job, worker.rank, task, k, duration_s)
    worker.kind, worker.since_s = job.kind, floor.now
    floor.at_end_of(duration_s, worker.stretch_over)
    return True
