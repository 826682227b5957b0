"""How long work takes those who can do it: a task, a visit, the set-up before it, all in mean seconds.

Which tasks a visit has, and how many jobs share it.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable
from itertools import pairwise
from statistics import fmean

from opsim.plan.loads.flows import Flow
from opsim.plan.plan import Plan
from opsim.subjects.lines.plan import SharePlan
from opsim.subjects.sequencing.plan import NO_SETUP, SetupPlan
from opsim.subjects.shifts.hours import Hours
from opsim.subjects.tasks.plan import TaskPlan, for_product, performed_ranks
from opsim.task_model import keys_read

LEAST_SETUP = "least_setup"
ANYBODY = -1
"""In place of a worker: somebody with skill rating 1, of whom nothing is known."""


class WorkTimes:
    """Mean times of a Plan's work, each found once. What the run changes (learning, fatigue, the hour) does not count.

    A worker's time is that of the floor: of his own performances, with what is said of his body, divided by his rating
    at the station. Of whom nothing is said that the task reads, the mean of the population counts.
    """

    def __init__(self, plan: Plan, hours: Hours | None = None):
        self.plan, self.hours = plan, Hours(plan) if hours is None else hours
        self._mean_s: dict[tuple[str, int], float] = {}
        self._least_s: dict[tuple[str, int], float] = {}

    def worker_s(self, worker: int, station: int, task: TaskPlan) -> float:
        """Of one unit of a task, by a worker at a station; a machine keeps its own time, whoever stands by."""
        if worker == ANYBODY or task.automatic or task.attended:
            return self._at_rating_1_s(ANYBODY, task)
        person = self.plan.workers[worker]
        known = not set(keys_read(task.model)).isdisjoint(person.body.said)
        return self._at_rating_1_s(worker if known else ANYBODY, task) / person.rating[station]

    def _at_rating_1_s(self, worker: int, task: TaskPlan) -> float:
        key = (task.name, worker)
        if key not in self._mean_s:
            if worker == ANYBODY:
                self._mean_s[key] = task.mean_s()
            elif task.levels is None:
                self._mean_s[key] = task.mean_s(self.plan.worker_effect(worker, task))
            else:
                levels = performed_ranks(self.plan.tasks, self.plan.tasks.index(task))
                self._mean_s[key] = fmean(self._at_rating_1_s(worker, self.plan.tasks[rank]) for rank in levels)
        return self._mean_s[key]

    def least_s(self, station: int, task: TaskPlan) -> float:
        """Of one unit of a task at a station, at least: by the fastest who can do it, or by the station itself."""
        key = (task.name, station)
        if key not in self._least_s:
            times_s = sorted(self.worker_s(worker, station, task) for worker in self.able(station) or [ANYBODY])
            self._least_s[key] = times_s[min(task.team, len(times_s)) - 1]
        return self._least_s[key]

    def able(self, station: int) -> set[int]:
        """Who may be sent to a station, or be called to it."""
        on_call = {worker for line in self.plan.lines if station in line.stations for worker in line.floaters}
        return {*self.hours.able(station), *(w for w in on_call if self.plan.workers[w].rating[station] > 0)}

    def tasks(self, station: int, product: int) -> list[tuple[TaskPlan, float]]:
        """What is done with a job at a station, and how often: for each unit of its lot, or once."""
        done = [(for_product(self.plan.tasks, task, product), part) for task, part in tasks_at(self.plan, station)]
        lot = self.plan.products[product].lot
        return [(task, part * (1 if task.per_lot else lot)) for task, part in done]

    def least_visit_s(self, station: int, product: int) -> float:
        """Of a job on a server, at least."""
        return sum(n * self.least_s(station, task) for task, n in self.tasks(station, product))

    def visit_s(self, worker: int, station: int, product: int) -> float:
        """Of a job on a server, by a worker alone."""
        return sum(n * self.worker_s(worker, station, task) for task, n in self.tasks(station, product))

    def by_hand_s(self, worker: int, station: int, product: int) -> float:
        """Time of people that a visit takes: of each member of a team, and of who stands by a machine.

        In a team a worker is at work for as long as a team of the fastest at least: its slowest member ends the task.
        """
        total_s = 0.0
        for task, n in self.tasks(station, product):
            if task.attended or not task.automatic:
                own_s = self.worker_s(worker, station, task)
                total_s += n * task.team * (max(own_s, self.least_s(station, task)) if task.team > 1 else own_s)
        return total_s

    def least_setup_s(self, station: int, flows: Iterable[Flow]) -> float:
        """Mean set-up before a visit, at least: see ``setup_s``."""
        by_hand = any(setup.station == station and setup.attended for setup in self.plan.setups)
        return setup_s(
            self.plan, station, flows, lambda task: self.least_s(station, task) if by_hand else task.mean_s()
        )

    def setup_by_hand_s(self, worker: int, station: int, flows: Iterable[Flow]) -> float:
        """Mean set-up before a visit, by a worker; 0 where nobody is needed for it."""
        setup = setup_of(self.plan, station)
        if setup is None or not setup.attended:
            return 0.0
        return setup_s(self.plan, station, flows, lambda task: self.worker_s(worker, station, task))


def tasks_at(plan: Plan, station: int) -> list[tuple[int, float]]:
    """The tasks of a station, each with the share of visits in which it is done there.

    Work that two stations share is dealt out so that both take as long a server, as far as that can be.
    """
    tasks = [(task, 1.0) for task in plan.stations[station].tasks]
    taken: list[tuple[int, float]] = []
    for share in plan.shares:
        if share.station == station:
            kept = _kept(plan, share)
            tasks = [*tasks[: -len(share.tasks)], *((task, kept) for task in share.tasks)]
        elif share.partner == station:
            taken = [(task, 1.0 - _kept(plan, share)) for task in share.tasks]
    return [*taken, *tasks]


def _kept(plan: Plan, share: SharePlan) -> float:
    """How much of the shared work the first of two stations would do, for equal times a server."""
    here, there = plan.stations[share.station], plan.stations[share.partner]
    shared_s, here_s, there_s = (
        sum(plan.tasks[task].mean_s() for task in tasks) for tasks in (share.tasks, here.tasks, there.tasks)
    )
    most = (there_s + shared_s) * here.servers - (here_s - shared_s) * there.servers
    return min(1.0, max(0.0, most / (shared_s * (here.servers + there.servers))))


def batch_size(plan: Plan, station: int) -> int:
    """Jobs that share a server, in a full batch."""
    return next((batch.size for batch in plan.batches if batch.station == station), 1)


def setup_of(plan: Plan, station: int) -> SetupPlan | None:
    """The set-ups of a station, where it has some."""
    return next((setup for setup in plan.setups if setup.station == station), None)


def setup_s(plan: Plan, station: int, flows: Iterable[Flow], seconds_of: Callable[[TaskPlan], float]) -> float:
    """Mean set-up before a visit: of the order in which a source makes products, else of an order drawn at random.

    flows : what comes to the station; seconds_of : how long the task of a set-up takes. Where the queue saves set-ups,
    the shortest change to each product counts, and there are fewer of them than this.
    """
    setup = setup_of(plan, station)
    if setup is None:
        return 0.0
    weight: defaultdict[int, float] = defaultdict(float)
    for flow in flows:
        weight[flow.product] += flow.per_h or flow.per_job
    total = sum(weight.values())

    def change_s(before: int, after: int) -> float:
        rank = setup.task[setup.class_of[before]][setup.class_of[after]]
        return 0.0 if rank == NO_SETUP else seconds_of(plan.tasks[rank])

    if total > 0 and any(queue.station == station and queue.rule == LEAST_SETUP for queue in plan.queues):
        return sum(w * (total - w) / total**2 * _least(setup, one, weight, change_s) for one, w in weight.items())
    pairs = _in_sequence(plan, set(weight))
    if not pairs and total > 0:
        pairs = {(a, b): weight[a] * weight[b] / total**2 for a in weight for b in weight}
    return sum(share * change_s(a, b) for (a, b), share in pairs.items())


def _least(setup: SetupPlan, product: int, others: Iterable[int], change_s: Callable[[int, int], float]) -> float:
    """The shortest set-up for a product after another one."""
    here = setup.class_of[product]
    return min((change_s(other, product) for other in others if setup.class_of[other] != here), default=0.0)


def _in_sequence(plan: Plan, products: set[int]) -> dict[tuple[int, int], float]:
    """Shares of the changes from one product to the next, where one source makes all of them in a fixed order."""
    makers = [source for source in plan.sources if products & {product for product, _ in source.mix}]
    if len(makers) != 1 or not makers[0].sequence:
        return {}
    order = [product for product in makers[0].sequence if product in products]
    counts = Counter(pairwise([*order, *order[:1]]))
    return {pair: n / len(order) for pair, n in counts.items()}
