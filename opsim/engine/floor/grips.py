"""The rows that tell of tools: what jobs have of them, and how long they wait."""

from __future__ import annotations

from opsim.engine.floor.machine import step
from opsim.engine.floor.parts.grips import Grip
from opsim.engine.floor.parts.rows import name_job, new_row
from opsim.engine.floor.parts.state import Floor, Job
from opsim.log import HELD, NO_TOOL, TOOL


@step
def log_grip(floor: Floor, job: Job, grip: Grip) -> None:
    """Write what a job had until now: a row for each piece, with the number of the tool as its k."""
    if floor.now <= grip.since_s:
        return
    for i in range(grip.n_needs):
        for _ in range(grip.needs[2 * i + 1]):
            row = new_row(floor, TOOL, grip.since_s)
            name_job(row, job)
            row.station, row.operation, row.task = grip.station, grip.operation, grip.task
            row.k = grip.needs[2 * i]


@step
def log_wait(floor: Floor, job: Job, task: int) -> None:
    """Write a job's wait for tools until now, with the task whose tools were missing."""
    if floor.now > job.since_s and job.station.rank >= 0:
        row = new_row(floor, HELD, job.since_s)
        name_job(row, job)
        row.station, row.task, row.cause = job.station.rank, task, NO_TOOL
        job.since_s = floor.now
