"""The floor: everything the processes share. Processes report; one settle step an instant does everything else."""

from collections.abc import Callable, Mapping
from heapq import heappush
from math import nan
from operator import itemgetter
from typing import Any

import simpy

from opsim.clock import on_grid
from opsim.engine.simpy_engine.draws import Draws
from opsim.engine.simpy_engine.state import Gate, Job, Source, Station, Worker
from opsim.log import SETUP, WORK, LogWriter, pack_row
from opsim.plan import Operation, Plan
from opsim.plugins import dispatch_rule

AFTER_EVERYTHING = 2
"""SimPy's priorities are 0 (urgent) and 1 (normal): settle comes after both."""

_order = itemgetter(0, 1, 2)

Handler = Callable[["Floor", Any], None]


class Floor:
    """State and log of one replication. ``now`` is the instant that is being settled, where everything changes.

    handlers : what to do with each named report, given its subject
    dispatch : run at the end of every settle step, when all reports are applied

    What blocks hang in, each empty where none does:
    dispatchers  : asked in every round of a settle step, before workers are sent; True where something changed
    created      : told of each job that comes into being
    left_station : told of each job that gives its place at a station back; left_floor : of each that leaves
    broken_off   : told of each job whose performance is broken off
    handed_over  : the job that goes from hand to hand just now, with its tools
    call_off     : asked of a job that may not begin yet; True where it waited for a tool of its task, or for a team
    lost_server  : told of each job that loses its server to another one and stays at the station
    closing      : asked for their open rows at the horizon, before those of workers and jobs are written
    stock, kits  : what lies in the stores, and who waits for parts, where there are some
    helping      : who helps others at their work, where somebody may be called to; called : by the rank of a worker
                   who is on his way because he was called to a job that others may be at, who called him
    legs         : by (station, station): who is told of a job that has its place there, and fetches it
    humans       : of each worker, what becomes of him as he works; empty where no effect is on
    doses        : of each worker, what his body has gone through so far; empty where no rule asks
    prefix       : of a worker, a station and the job that calls there: what comes before the rule's own key
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
        self.write = self.log.rows.extend
        self.stations = [_station(plan, rank) for rank in range(len(plan.stations))]
        self.workers = [_worker(env, plan, rank) for rank in range(len(plan.workers))]
        self.free = {worker.rank: worker for worker in self.workers}
        self.calling: dict[int, Station] = {}
        self.calls = 0  # NOTE: bit r for calling[r], so that a worker who can serve none of them is passed over quickly
        self.gates = _gates(plan, self.stations)
        self.stirred: set[Gate] = set()
        self.steps = _steps(plan, self.gates)
        self.rule = dispatch_rule(plan.rule)
        self.sources = [Source(source, rank, draws.products(rank)) for rank, source in enumerate(plan.sources)]
        self.saturated = [source for source in self.sources if source.plan.kind == "saturated"]
        self.losing = {source.rank for source in self.sources if source.plan.when_full == "lose"}
        self.jobs: dict[int, Job] = {}
        self.dispatchers: list[Callable[[Floor], bool]] = []
        self.left_station: list[Callable[[Floor, Job, Station], None]] = []
        self.broken_off: list[Callable[[Floor, Job], None]] = []
        self.handed_over: Job | None = None
        self.call_off: list[Callable[[Floor, Job], bool]] = []
        self.lost_server: list[Callable[[Floor, Job, Station], None]] = []
        self.created: list[Callable[[Floor, Job], None]] = []
        self.left_floor: list[Callable[[Floor, Job], None]] = []
        self.closing: list[Callable[[Floor], None]] = []
        self.stock: Any = None
        self.kits: Any = None
        self.helping: Any = None
        self.called: dict[int, Any] = {}
        self.legs: dict[tuple[int, int], Callable[[Floor, Job, Station], None]] = {}
        self.prefix: Callable[[Worker, Station, Job], tuple[float, ...]] | None = None
        self.humans: tuple[Any, ...] = ()
        self.doses: tuple[Any, ...] = ()
        self.now = 0.0
        self.n_performances = 0
        self._reports: list[tuple] = []
        self._settle_pending = False

    def report(self, kind: int, rank: int, number: int, what: str, subject: Any) -> None:
        """Something happened now. It is applied in settle, in the order of (kind, natural rank, job number)."""
        env = self.env
        queue = env._queue
        if not self._settle_pending and (not queue or queue[0][0] > env._now):
            # NOTE: the instant has no other event, so this is its end already: saves an event in two.
            self.now = env._now
            self._handlers[what](self, subject)
            self._dispatch(self)
            return
        self._reports.append((kind, rank, number, what, subject))
        self.wake()

    def wake(self) -> None:
        """Have this instant settled, once, after all its other events."""
        if not self._settle_pending:
            self._settle_pending = True
            settle = self.at_end_of(0.0, simpy.Event(self.env), AFTER_EVERYTHING)
            settle.callbacks.append(self._settle)

    def tell(self, what: str, subject: Any) -> None:
        """Have a named report applied at once, inside settle."""
        self._handlers[what](self, subject)

    def alarm(self, delay_s: float, kind: int, rank: int, number: int, what: str, subject: Any) -> simpy.Event:
        """A report after a delay, which is rounded to the grid. ``cancel`` makes it nothing."""
        event = self.at_end_of(on_grid(delay_s), simpy.Event(self.env))
        event.callbacks.append(lambda _: self.report(kind, rank, number, what, subject))
        return event

    def stir(self, station: Station) -> None:
        """There may be room at a station: whoever wants in is looked at again."""
        for gate in station.wanted_by:
            if gate.claims:
                self.stirred.add(gate)

    def at_end_of(self, delay_s: float, event: simpy.Event, priority: int = simpy.events.NORMAL) -> simpy.Event:
        """``event`` happens after a delay.

        NOTE: what ``simpy.Timeout`` does, for an event that exists already: so a process waits for one event a stretch
        instead of two (an order and a timeout). ``Environment.schedule`` is written out.
        """
        event._ok, event._value = True, None
        env = self.env
        heappush(env._queue, (env._now + delay_s, priority, next(env._eid), event))  # type: ignore[misc]
        return event

    def _settle(self, _event: simpy.Event | None = None) -> None:
        self._settle_pending = False
        self.now = self.env.now
        reports, self._reports = self._reports, []
        if len(reports) > 1:
            reports.sort(key=_order)
        for report in reports:
            self._handlers[report[3]](self, report[4])
        self._dispatch(self)

    def log_job(self, job: Job) -> None:
        """Write the state the job was in until now, where it lasted."""
        # NOTE: the rows of ``opsim.log.row`` written out and packed here: two or three an operation.
        start_s, now = job.since_s, self.now
        if now <= start_s:
            return
        station = job.station.rank
        number, product, operation = job.number, job.product, job.operation_rank
        kind = job.kind
        if kind == WORK or kind == SETUP:  # noqa: SIM109  NOTE: twice as fast as a tuple
            to = 1.0 if now - start_s == job.duration_s else progress(job, now)
            self.write(pack_row(
                kind, start_s, now, job.worker, station, -1, -1, job.source, number, product, operation,
                job.task, job.performance_id, job.k, job.progress_from, to, job.pace_shift, 0,
            ))  # fmt: skip
        else:
            self.write(pack_row(
                kind, start_s, now, -1, station, -1, -1, job.source, number, product, operation,
                -1, -1, -1, nan, nan, nan, job.cause,
            ))  # fmt: skip

    def job_now(self, job: Job, kind: int, cause: int = 0) -> None:
        """The job changes its state: the old one is written, the new one begins."""
        if self.now > job.since_s:
            self.log_job(job)
        job.kind, job.cause, job.since_s = kind, cause, self.now

    def log_instant(self, kind: int, job: Job, cause: int = 0, station: int = -1, other: int = -1) -> None:
        """Write something that happened to a job at once; at a station and with another job, where it is worth it."""
        now = self.now
        self.write(pack_row(
            kind, now, now, -1, station, -1, -1, job.source, job.number, job.product, job.operation_rank,
            -1, -1, other, nan, nan, nan, cause,
        ))  # fmt: skip


def pair_key(
    floor: Floor, worker: Worker, station: Station, job: Job, n_waiting: int, since_s: float
) -> tuple[float, ...]:
    """What a free worker and a calling station are compared by; ``job`` is the one that calls, since some time."""
    rank = station.rank
    key = floor.rule(n_waiting, since_s, worker.walk_s[worker.place][rank], worker.rating[rank], rank, worker.rank)
    return key if floor.prefix is None else (*floor.prefix(worker, station, job), *key)


def cancel(event: simpy.Event) -> None:
    """An event that is to come will mean nothing."""
    if event.callbacks:
        event.callbacks.clear()


def progress(job: Job, now: float) -> float:
    """How much of the performance under way is done, as a share of the whole of it."""
    spent_s = now - job.since_s
    if spent_s == job.duration_s:
        return 1.0
    before = job.progress_from
    return before + (1.0 - before) * (spent_s / job.duration_s)


def _station(plan: Plan, rank: int) -> Station:
    station = plan.stations[rank]
    tasks = [plan.tasks[task] for task in station.tasks]
    automatic, repeats = tuple(task.automatic for task in tasks), tuple(task.repeat for task in tasks)
    made = Station(station, rank, station.place, station.capacity, station.tasks, automatic, repeats, station.servers)
    made.per_lot = tuple(task.per_lot for task in tasks)
    return made


def _worker(env: simpy.Environment, plan: Plan, rank: int) -> Worker:
    worker = plan.workers[rank]
    speed = worker.walk_m_per_s
    walk_s = tuple(tuple(row[station.place] / speed for station in plan.stations) for row in plan.distance_m)
    skills = sum(1 << rank for rank, rating in enumerate(worker.rating) if rating > 0)
    event, next_k = simpy.Event(env), [0] * len(plan.tasks)
    return Worker(worker, rank, worker.place, event, walk_s, worker.rating, skills, {}, next_k)


def _steps(plan: Plan, gates: dict[tuple[int, ...], Gate]) -> list[list[tuple[Operation, int, Gate]]]:
    """Of each product and step: the operation, its rank, and the gate in front of it."""
    ranks = {name: rank for rank, name in enumerate(plan.operations)}
    return [[(step, ranks[step.name], gates[step.stations]) for step in product.route] for product in plan.products]


def _comes_back(plan: Plan, ranks: tuple[int, ...]) -> bool:
    """Whether a job that has a place at one of some stations may want in there without another one."""
    if plan.quality or any(station.place_first for station in plan.stations):
        return True
    return any(
        then >= 0 and product.route[then].stations == ranks and not set(ranks).isdisjoint(step.stations)
        for product in plan.products
        for step, ways in zip(product.route, product.onward)
        for _, then in ways
    )


def _gates(plan: Plan, stations: list[Station]) -> dict[tuple[int, ...], Gate]:
    wanted = {operation.stations: None for product in plan.products for operation in product.route}
    gates = {
        ranks: Gate(tuple(stations[rank] for rank in ranks), comes_back=_comes_back(plan, ranks)) for ranks in wanted
    }
    for station in stations:
        station.wanted_by = tuple(gate for gate in gates.values() if station in gate.stations)
    return gates
