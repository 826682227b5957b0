"""What a scenario says of workers and no model of their tasks reads: said as warnings, never refused."""

from collections.abc import Iterator

from opsim.bodies import keys_read
from opsim.names import listed
from opsim.plan.plan import Plan
from opsim.plan.tasks import TaskPlan
from opsim.plan.worker import WorkerPlan


def unread(plan: Plan) -> list[str]:
    """Every warning in a sentence."""
    return [*_paces(plan), *_people(plan)]


def tasks_of(plan: Plan, worker: WorkerPlan) -> list[TaskPlan]:
    """The tasks a worker may be sent to, in natural order."""
    ranks = {task for station, rating in zip(plan.stations, worker.rating) if rating for task in station.tasks}
    ranks |= {task for one in plan.setups if worker.rating[one.station] for task in one.tasks_by_hand}
    return [plan.tasks[rank] for rank in sorted(ranks) if not plan.tasks[rank].automatic]


def unknown_there(plan: Plan, worker: WorkerPlan) -> list[str]:
    """The emulated tasks of a worker whose recordings do not have the person he is."""
    emulated = [task for task in tasks_of(plan, worker) if "person" in getattr(task.model, "body_keys", ())]
    return [task.name for task in emulated if worker.body.person not in getattr(task.model, "workers", ())]


def _paces(plan: Plan) -> Iterator[str]:
    paced = [worker for worker in plan.workers if worker.body.pace is not None]
    idle = [w.name for w in paced if not any("pace" in keys_read(task.model) for task in tasks_of(plan, w))]
    if idle:
        yield (
            f"the pace of {listed(idle)} changes nothing: none of their tasks is emulated; rate them by their skills, "
            "where 1.1 means a tenth faster"
        )


def _people(plan: Plan) -> Iterator[str]:
    lacking: dict[str, list[str]] = {}
    for worker in plan.workers:
        for task in unknown_there(plan, worker) if worker.body.person is not None else ():
            lacking.setdefault(task, []).append(f"{worker.body.person} ({worker.name})")
    for task, who in lacking.items():
        yield f"{task} was recorded without {listed(who)}: there they move as people drawn from the population"
