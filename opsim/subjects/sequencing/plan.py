"""In which order waiting jobs go on, and what the rules look at to find it.

Set-ups: what a server needs before a job of another class than the one it did last.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from opsim.plan.ranks import Ranks
from opsim.plan.subjects import subject_tasks
from opsim.problems import natural_key
from opsim.subjects.release.plan import SourcePlan
from opsim.subjects.routes.plan import ProductPlan, onward_probabilities
from opsim.subjects.stations.plan import StationPlan
from opsim.subjects.tasks.plan import TaskPlan, for_product

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario, Setup


FIFO = "fifo"
SHORTEST_QUEUE = "shortest_queue"
MOST_DOWNSTREAM = "most_downstream"
FINISH_FIRST = ""
"""How it is at a station where what was begun is finished before anything else."""


@dataclass(frozen=True, slots=True)
class QueuePlan:
    """A queue that has a rule, priorities, or pre-emption.

    station : its rank; rule : name of the rule of ``opsim.sequencing``; preempt : ``resume``, ``restart`` or
    ``FINISH_FIRST``
    """

    station: int
    rule: str
    preempt: str = FINISH_FIRST


@dataclass(frozen=True, slots=True)
class WorkAhead:
    """Mean times at rating 1, without waiting and set-ups, by product and step of its route.

    at_s   : (P, S) of a product's operation at each station; work_s : (P, steps) of each step, the mean of its stations
    left_s, left_steps : (P, steps) of this operation and all later ones, and how many they are on average
    """

    at_s: tuple[tuple[float, ...], ...]
    work_s: tuple[tuple[float, ...], ...]
    left_s: tuple[tuple[float, ...], ...]
    left_steps: tuple[tuple[float, ...], ...]


def _at_s(station: StationPlan, tasks: Sequence[TaskPlan], product: int, lot: int) -> float:
    """Mean time of an operation on a lot of a product."""
    own = [for_product(tasks, rank, product) for rank in station.tasks]
    return sum(task.mean_s() * (1 if task.per_lot else lot) for task in own)


def has_priorities(products: Sequence[ProductPlan], sources: Sequence[SourcePlan]) -> bool:
    """Whether some jobs go before others: of products, or of a list of orders."""
    return len({product.priority for product in products}) > 1 or any(one.kind == "schedule" for one in sources)


def looks_ahead(queues: Sequence[QueuePlan], routing: str, allocation: str) -> bool:
    """Whether a rule is in force that may look at mean times, or at how many operations are left."""
    ahead = routing not in _BLIND_ROUTING or allocation == MOST_DOWNSTREAM
    return ahead or any(queue.rule not in _BLIND_RULES for queue in queues)


_BLIND_RULES = {FIFO, "edd", "least_setup"}
_BLIND_ROUTING = {SHORTEST_QUEUE, "first_free", "in_order"}


def plan_queues(scenario: Scenario, ranks: Ranks, has_priorities: bool) -> tuple[QueuePlan, ...]:
    """The queues that are not simply first come, first served, in natural order of stations."""
    stations = ((rank, scenario.stations[name]) for name, rank in ranks.stations.items() if name in scenario.stations)
    queues = [QueuePlan(rank, one.dispatch or scenario.flow.dispatch, one.preempt or "") for rank, one in stations]
    return tuple(queue for queue in queues if has_priorities or queue.rule != FIFO)


def work_ahead(
    stations: Sequence[StationPlan],
    products: Sequence[ProductPlan],
    tasks: Sequence[TaskPlan],
    together: Collection[int] = (),
) -> WorkAhead:
    """What rules know of the work that lies ahead; stations ``together`` do each task once for all of a batch."""
    at_s = tuple(
        tuple(_at_s(one, tasks, number, 1 if rank in together else product.lot) for rank, one in enumerate(stations))
        for number, product in enumerate(products)
    )
    work_s = tuple(
        tuple(_mean(at[rank] for rank in step.stations) for step in product.route)
        for product, at in zip(products, at_s)
    )
    return WorkAhead(
        at_s,
        work_s,
        tuple(_to_come(product, here) for product, here in zip(products, work_s)),
        tuple(_to_come(product, (1.0,) * len(product.route)) for product in products),
    )


def _to_come(product: ProductPlan, here: Sequence[float]) -> tuple[float, ...]:
    """The sum of something over this step and all later ones, on average over the ways that jobs take."""
    passing = onward_probabilities(product)
    if all(len(ways) == 1 and (step > at or step < 0) for at, ways in enumerate(product.onward) for _, step in ways):
        sums = [0.0] * (len(here) + 1)  # NOTE: a way that only goes forward needs no equations; step -1 is the last sum
        for at in reversed(range(len(here))):
            sums[at] = here[at] + sums[product.onward[at][0][1]]
        return tuple(sums[:-1])
    import numpy as np

    return tuple(np.linalg.solve(np.eye(len(here)) - np.array(passing), np.array(here)).tolist())


def _mean(values) -> float:
    values = tuple(values)
    return sum(values) / len(values)


NO_SETUP = -1
ANYTHING = -1
"""What a server was last set up for, before its first job: no set-up is needed for whatever comes."""


@dataclass(frozen=True, slots=True)
class SetupPlan:
    """Set-ups at a station. Products are told apart by classes, themselves or their families.

    station  : its rank; attended : whether a worker does it
    class_of : (P,) number of each product's class, -1 where it never comes here
    task     : (C, C) rank of the task from one class to another, ``NO_SETUP`` where there is none
    mean_s   : (C, C) mean time of that task at rating 1
    first    : the class at the start, or ``ANYTHING``
    """

    station: int
    attended: bool
    class_of: tuple[int, ...]
    task: tuple[tuple[int, ...], ...]
    mean_s: tuple[tuple[float, ...], ...]
    first: int

    @property
    def tasks_by_hand(self) -> set[int]:
        """Ranks of the tasks by which workers set up here; some may run alone all the same."""
        return {rank for row in self.task for rank in row if rank != NO_SETUP} if self.attended else set()

    def needed(self, last: int, product: int) -> tuple[int, float]:
        """(task, mean time) of the set-up for a product on a server that last did a class."""
        if last == ANYTHING:
            return NO_SETUP, 0.0
        here = self.class_of[product]
        return self.task[last][here], self.mean_s[last][here]


def setup_tasks(scenario: Scenario) -> dict:
    """Tasks that a scenario does not name: of set-ups that are said as a time, and of subjects of somebody else."""
    from opsim.scenario.schema import Fixed

    said = [time for station in scenario.stations.values() for time in _said(station) if isinstance(time, float)]
    made = {setup_name(time_s): Fixed.model_validate({"fixed": f"{time_s!r} s"}) for time_s in said if time_s > 0}
    return {**made, **subject_tasks(scenario)}


def setup_name(time_s: float) -> str:
    """What the task of a set-up is called; a colon is in no name of a scenario."""
    return f"setup: {time_s:.10g} s"


def plan_setups(scenario: Scenario, ranks: Ranks, tasks) -> tuple[SetupPlan, ...]:
    """Set-ups of all stations that have some, in natural order; ``tasks`` are those of the Plan."""
    found = ((name, scenario.stations[name].setup) for name in sorted(scenario.stations, key=natural_key))
    return tuple(_setup(name, setup, scenario, ranks, tasks) for name, setup in found if setup is not None)


def _setup(name: str, setup: Setup, scenario: Scenario, ranks: Ranks, tasks) -> SetupPlan:
    class_of = {product: class_name(scenario, setup, product) for product in ranks.products}
    here = [product for product in ranks.products if comes_to(scenario.products[product], name)]
    first = () if setup.first is None else (setup.first,)
    classes = sorted({*first, *(class_of[product] for product in here)}, key=natural_key)
    said = [[_rank(setup, last, new, ranks) for new in classes] for last in classes]
    return SetupPlan(
        ranks.stations[name],
        setup.attended,
        tuple(classes.index(class_of[product]) if product in here else -1 for product in ranks.products),
        tuple(tuple(row) for row in said),
        tuple(tuple(0.0 if rank == NO_SETUP else tasks[rank].mean_s() for rank in row) for row in said),
        ANYTHING if setup.first is None else classes.index(setup.first),
    )


def class_name(scenario: Scenario, setup, product: str) -> str:
    """What a product counts as: itself, or its family where set-ups go by families."""
    family = scenario.products[product].family
    return family if setup.by == "family" and family is not None else product


def comes_to(product, station: str) -> bool:
    """Whether a product comes to a station: by its route, or by its routing."""
    if product.route is not None:
        return any(station == step or (isinstance(step, list) and station in step) for step in product.route)
    return any(station == name or station in ways for name, ways in product.routing.items())


def _rank(setup, last: str, new: str, ranks: Ranks) -> int:
    said = setup.times.get(last, {}).get(new)
    if said is None:
        said = 0.0 if last == new else setup.otherwise
    if isinstance(said, str):
        return ranks.tasks[said]
    if not said:
        return NO_SETUP
    return ranks.tasks[setup_name(said)]


def _said(station) -> list[float | str]:
    if station.setup is None:
        return []
    otherwise = [] if station.setup.otherwise is None else [station.setup.otherwise]
    return [*(time for row in station.setup.times.values() for time in row.values()), *otherwise]
