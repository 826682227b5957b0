"""The floor: everything the processes share. Processes report; one settle step an instant does everything else."""

from collections.abc import Callable, Mapping
from math import nan
from operator import itemgetter
from typing import Any

import simpy

from opsim.engine.rules import ALLOCATION_RULES
from opsim.engine.simpy_engine.draws import Draws
from opsim.engine.simpy_engine.state import Gate, Job, Performance, Station, Worker
from opsim.log import WORK, LogWriter
from opsim.plan import Plan

AFTER_EVERYTHING = 2
"""SimPy's priorities are 0 (urgent) and 1 (normal): settle comes after both."""

_order = itemgetter(0, 1, 2)


Handler = Callable[["Floor", Any], None]


class Floor:
    """State and log of one replication. ``now`` is the instant that is being settled, where everything changes.

    handlers : what to do with each named report, given its subject
    dispatch : run at the end of every settle step, when all reports are applied
    """

    def __init__(
        self,
        env: simpy.Environment,
        plan: Plan,
        draws: Draws,
        handlers: Mapping[str, Handler],
        dispatch: Callable[["Floor"], None],
    ):
        self.env, self.plan, self.draws = env, plan, draws
        self._handlers, self._dispatch = handlers, dispatch
        self.log = LogWriter()
        self.stations = [Station(station, rank, station.servers) for rank, station in enumerate(plan.stations)]
        self.workers = [
            Worker(worker, rank, worker.place, [0] * len(plan.tasks), simpy.Event(env))
            for rank, worker in enumerate(plan.workers)
        ]
        self.free = {worker.rank: worker for worker in self.workers}
        self.calling: dict[int, Station] = {}
        self.gates = _gates(plan, self.stations)
        self.stirred: set[Gate] = set()
        self.operation_rank = {name: rank for rank, name in enumerate(plan.operations)}
        self.rule = ALLOCATION_RULES[plan.rule]
        self.jobs: dict[int, Job] = {}
        self.n_released = 0
        self.next_gate: Gate | None = None
        self.now = 0.0
        self.n_performances = 0
        self.automatic_k: dict[tuple[int, int], int] = {}
        self._reports: list[tuple] = []
        self._settle_pending = False

    def report(self, kind: int, rank: int, number: int, what: str, subject: Any) -> None:
        """Something happened now. It is applied in settle, in the order of (kind, natural rank, job number)."""
        self._reports.append((kind, rank, number, what, subject))
        self.wake()

    def wake(self) -> None:
        """Have this instant settled, once, after all its other events."""
        if not self._settle_pending:
            self._settle_pending = True
            settle = self.at_end_of(0.0, simpy.Event(self.env), AFTER_EVERYTHING)
            settle.callbacks.append(self._settle)

    def at_end_of(self, delay_s: float, event: simpy.Event, priority: int = simpy.events.NORMAL) -> simpy.Event:
        """``event`` happens after a delay.

        NOTE: what ``simpy.Timeout`` does, for an event that exists already: so a process waits for one event a stretch
        instead of two (an order and a timeout).
        """
        event._ok, event._value = True, None
        self.env.schedule(event, priority=priority, delay=delay_s)  # type: ignore[arg-type]
        return event

    def _settle(self, _event: simpy.Event) -> None:
        self._settle_pending = False
        self.now = self.env.now
        reports, self._reports = self._reports, []
        if len(reports) > 1:
            reports.sort(key=_order)
        for _kind, _rank, _number, what, subject in reports:
            self._handlers[what](self, subject)
        self._dispatch(self)

    def log_job(self, job: Job) -> None:
        """Write the state the job was in until now, where it lasted."""
        if job.performance is not None:
            self._log_performance(job, job.performance)
        elif self.now > job.since_s:
            station = -1 if job.station is None else job.station.rank
            self._log(job.kind, job.since_s, -1, station, job, cause=job.cause)

    def job_now(self, job: Job, kind: int, cause: int = 0) -> None:
        """The job changes its state: the old one is written, the new one begins."""
        self.log_job(job)
        job.performance = None
        job.kind, job.cause, job.since_s = kind, cause, self.now

    def log_instant(self, kind: int, job: Job, cause: int = 0) -> None:
        """Write something that happened to a job at once."""
        self._log(kind, self.now, -1, -1, job, cause=cause)

    def _log_performance(self, job: Job, done: Performance) -> None:
        worker, task, number, k, start_s, duration_s = done
        spent_s = self.now - start_s
        if spent_s > 0:
            station: Station = job.station  # type: ignore[assignment]
            progress = 1.0 if spent_s == duration_s else spent_s / duration_s
            self._log(WORK, start_s, worker, station.rank, job, task, number, k, 0.0, progress, 0.0)

    def _log(
        self,
        kind: int,
        start_s: float,
        worker: int,
        station: int,
        job: Job,
        task: int = -1,
        performance_id: int = -1,
        k: int = -1,
        progress_from: float = nan,
        progress_to: float = nan,
        pace_shift: float = nan,
        cause: int = 0,
    ) -> None:
        # NOTE: the tuple of ``opsim.log.row`` written out, because it is made two or three times an operation.
        self.log.append(
            (
                *(kind, start_s, self.now, worker, station, -1, -1, 0, job.number, job.product, job.operation_rank),
                *(task, performance_id, k, progress_from, progress_to, pace_shift, cause),
            )
        )


def _gates(plan: Plan, stations: list[Station]) -> dict[tuple[int, ...], Gate]:
    gates: dict[tuple[int, ...], Gate] = {}
    for product in plan.products:
        for operation in product.route:
            if operation.stations not in gates:
                gate = gates[operation.stations] = Gate(tuple(stations[rank] for rank in operation.stations))
                for station in gate.stations:
                    station.wanted_by.append(gate)
    return gates
