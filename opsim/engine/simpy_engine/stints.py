"""The part of one worker in a performance of a team: a row of his own, beside that of the job."""

from dataclasses import dataclass

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Worker
from opsim.log import WORK, pack_row


@dataclass(frozen=True, slots=True, eq=False)
class Stint:
    """Where, at what and as his k-th performance of it a worker takes part, for ``duration_s`` seconds.

    progress_from : the share of the performance that was done before
    """

    station: int
    product: int
    operation: int
    task: int
    performance_id: int
    k: int
    duration_s: float
    progress_from: float
    pace_shift: float = 0.0

    def log(self, floor: Floor, worker: Worker) -> None:
        """Write the part until now, which began when the worker's state did; it names no job."""
        start_s, now = worker.since_s, floor.now
        done = 1.0 if now - start_s == self.duration_s else (now - start_s) / self.duration_s
        to = 1.0 if done == 1.0 else self.progress_from + (1.0 - self.progress_from) * done
        floor.write(pack_row(
            WORK, start_s, now, worker.rank, self.station, -1, -1, -1, -1, self.product, self.operation,
            self.task, self.performance_id, self.k, self.progress_from, to, self.pace_shift, 0,
        ))  # fmt: skip
