"""Due dates: how many jobs are late, and by how much."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import by_rank, created_s, in_window, mean
from opsim.log import FINISH, EventLog
from opsim.plan import Plan
from opsim.plan.orders import due_of


def due_dates(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Share of jobs that were late, and mean tardiness (early counts as 0), of those that finish in the window and have
    a due date: in all, and by product where there are several.
    """
    if not has_due_dates(plan):
        return
    late_s, product = _lateness_s(log, plan)
    by_product = by_rank(late_s, product, len(plan.products)) if len(plan.products) > 1 else []
    named = [("", late_s), *((made.name, part) for made, part in zip(plan.products, by_product) if part.size)]
    for subject, part_s in named:
        yield Figure("late_share", subject, "", "share", mean((part_s > 0).astype(float)))
    for subject, part_s in named:
        yield Figure("tardiness_s", subject, "", "s", mean(np.maximum(part_s, 0.0)))


def has_due_dates(plan: Plan) -> bool:
    """Whether some job may have one: of its product, or of its order."""
    by_order = (order.due_s for source in plan.sources for order in source.orders)
    return any(np.isfinite(product.due_s) for product in plan.products) or any(np.isfinite(due_s) for due_s in by_order)


def _lateness_s(log: EventLog, plan: Plan) -> tuple[np.ndarray, np.ndarray]:
    """(jobs,) finish minus due date, and product, of the jobs with a due date that finish in the window."""
    done = np.flatnonzero((log["kind"] == FINISH) & in_window(log["end_s"], plan))
    job, source, product = log["job"][done], log["source"][done], log["product"][done]
    due_s = created_s(log, job) + np.array([made.due_s for made in plan.products])[product]
    for rank, made in enumerate(plan.sources):
        for i in np.flatnonzero(source == rank) if made.orders else ():
            ordered_s = due_of(plan, rank, int(job[i]) // len(plan.sources))
            due_s[i] = ordered_s if np.isfinite(ordered_s) else due_s[i]
    has_one = np.isfinite(due_s)
    return (log["end_s"][done] - due_s)[has_one], product[has_one]
