"""Automatic tasks that somebody attends: the station's time, and a worker who stays."""

from __future__ import annotations

from opsim.engine.floor.machine import step
from opsim.engine.floor.parts.performing import begin, drawn_run_s
from opsim.engine.floor.parts.state import Floor, Job, Worker
from opsim.engine.floor.parts.stretches import stretch


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
