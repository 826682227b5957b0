"""In which order waiting jobs go on, and what the rules look at to find it."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from opsim.plan.levels import for_product
from opsim.plan.products import ProductPlan, onward_probabilities
from opsim.plan.sources import SourcePlan
from opsim.plan.stations import StationPlan
from opsim.plan.tasks import Ranks, TaskPlan

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario

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
