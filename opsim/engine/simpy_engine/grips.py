"""What jobs have of tools, what they want, and the rows that tell of it."""

from collections.abc import Callable
from dataclasses import dataclass
from math import nan

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import OUTSIDE, Job
from opsim.log import HELD, NO_TOOL, TOOL, pack_row
from opsim.plan.tools import Needs


@dataclass(frozen=True, slots=True, eq=False)
class Grip:
    """Tools of a job. task : the one that wants them, -1 the station itself; station, operation : where it took them"""

    needs: Needs
    task: int
    since_s: float
    station: int
    operation: int


@dataclass(slots=True, eq=False)
class Want:
    """Tools that a job wants for something. go_on : what follows when they are there

    at_once : they are the job's as soon as they are free; False: when a worker sets out with them
    """

    purpose: int
    needs: Needs
    task: int
    go_on: Callable[[], None]
    at_once: bool = True


def log_grip(floor: Floor, job: Job, grip: Grip) -> None:
    """Write what a job had until now: a row for each piece, with the number of the tool as its k."""
    if floor.now <= grip.since_s:
        return
    for tool, n in grip.needs:
        row = pack_row(
            *(TOOL, grip.since_s, floor.now, -1, grip.station, -1, -1, job.source, job.number, job.product),
            *(grip.operation, grip.task, -1, tool, nan, nan, nan, 0),
        )
        floor.write(row * n)


def log_wait(floor: Floor, job: Job, task: int) -> None:
    """Write a job's wait for tools until now, with the task whose tools were missing."""
    if floor.now > job.since_s and job.station is not OUTSIDE:
        floor.write(pack_row(
            HELD, job.since_s, floor.now, -1, job.station.rank, -1, -1, job.source, job.number, job.product,
            job.operation_rank, task, -1, -1, nan, nan, nan, NO_TOOL,
        ))  # fmt: skip
        job.since_s = floor.now
