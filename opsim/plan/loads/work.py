"""What a visit takes: its tasks, its share of a batch, the set-up before it."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable
from itertools import pairwise

from opsim.plan.loads.rates import Flow
from opsim.plan.plan import Plan
from opsim.plan.setup import SetupPlan
from opsim.plan.work_sharing import SharePlan

LEAST_SETUP = "least_setup"


def task_s(plan: Plan, task: int, product: int) -> float:
    """Mean time of a task for a job, all units of its lot, at rating 1."""
    said = plan.tasks[task]
    return said.mean_s() * (1 if said.per_lot else plan.products[product].lot)


def visit_s(plan: Plan, station: int, product: int) -> float:
    """Mean time of a job on a server, at rating 1."""
    return sum(part * task_s(plan, task, product) for task, part in tasks_at(plan, station))


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


def setup_s(plan: Plan, station: int, flows: Iterable[Flow]) -> float:
    """Mean set-up before a visit: of the order in which a source makes products, else of an order drawn at random.

    flows : what comes to the station. Where the queue saves set-ups, the shortest change to each product counts, and
    there are fewer of them than this.
    """
    setup = setup_of(plan, station)
    if setup is None:
        return 0.0
    weight: defaultdict[int, float] = defaultdict(float)
    for flow in flows:
        weight[flow.product] += flow.per_h or flow.per_job
    total = sum(weight.values())
    if total > 0 and any(queue.station == station and queue.rule == LEAST_SETUP for queue in plan.queues):
        return sum(w * (total - w) / total**2 * _least(setup, product, weight) for product, w in weight.items())
    pairs = _in_sequence(plan, set(weight))
    if not pairs and total > 0:
        pairs = {(a, b): weight[a] * weight[b] / total**2 for a in weight for b in weight}
    return sum(share * setup.mean_s[setup.class_of[a]][setup.class_of[b]] for (a, b), share in pairs.items())


def _least(setup: SetupPlan, product: int, others: Iterable[int]) -> float:
    """The shortest set-up for a product after another one."""
    here = setup.class_of[product]
    times = [setup.mean_s[setup.class_of[other]][here] for other in others if setup.class_of[other] != here]
    return min(times, default=0.0)


def _in_sequence(plan: Plan, products: set[int]) -> dict[tuple[int, int], float]:
    """Shares of the changes from one product to the next, where one source makes all of them in a fixed order."""
    makers = [source for source in plan.sources if products & {product for product, _ in source.mix}]
    if len(makers) != 1 or not makers[0].sequence:
        return {}
    order = [product for product in makers[0].sequence if product in products]
    counts = Counter(pairwise([*order, *order[:1]]))
    return {pair: n / len(order) for pair, n in counts.items()}
