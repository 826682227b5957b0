"""Figures of the known answers that no KPI is: each a pure function of a log and its Plan."""

from collections.abc import Callable

import numpy as np

from opsim.log import ABSENT, BLOCKED, CREATE, DOWN, FINISH, JOB_KINDS, QUEUE, REPAIR, STOCK, EventLog
from opsim.plan import Plan
from opsim.subjects.lines.figures import lines


def machines_down(log: EventLog, plan: Plan) -> float:
    """Stations that stand on average, waiting for repair or under it."""
    return _seconds(log, plan, DOWN, REPAIR) / _length_s(plan)


def repairs_under_way(log: EventLog, plan: Plan) -> float:
    """Stations under repair on average: with one team, the share of its time that it works."""
    return _seconds(log, plan, REPAIR) / _length_s(plan)


def failures_per_s(log: EventLog, plan: Plan) -> float:
    """Repairs that were done, a second of the window."""
    return _repairs(log, plan) / _length_s(plan)


def wait_for_repair_s(log: EventLog, plan: Plan) -> float:
    """Time from a breakdown until the team comes, on average."""
    return _seconds(log, plan, DOWN) / _repairs(log, plan)


def between_machines(log: EventLog, plan: Plan) -> float:
    """Parts that the first of two machines has done and the second has not: one may still stand on either."""
    jobs = log.of(*JOB_KINDS)
    between = (jobs["station"] == 1) | ((jobs["station"] == 0) & (jobs["kind"] == BLOCKED))
    return float(jobs.where(between).clipped_s(*plan.window_s).sum()) / _length_s(plan)


def filled_at_once(log: EventLog, plan: Plan) -> float:
    """Share of the orders of the window that found their piece: they left as they came."""
    orders = _product(plan, "order")
    came, gone = (log.where((log["kind"] == kind) & (log["product"] == orders)) for kind in (CREATE, FINISH))
    left_s = dict(zip(gone["job"].tolist(), gone["end_s"].tolist()))
    low, high = plan.window_s
    stays = [left_s.get(job) == at for job, at in zip(came["job"].tolist(), came["end_s"].tolist()) if low <= at < high]
    return sum(stays) / len(stays)


def orders_waiting(log: EventLog, plan: Plan) -> float:
    """Orders inside on average."""
    jobs = log.of(*JOB_KINDS)
    rows = jobs.where(jobs["product"] == _product(plan, "order"))
    return float(rows.clipped_s(*plan.window_s).sum()) / _length_s(plan)


def pieces_in_stock(log: EventLog, plan: Plan) -> float:
    """Pieces that lie in a store on average."""
    rows = log.where((log["kind"] == QUEUE) & (log["cause"] == STOCK))
    return float(rows.clipped_s(*plan.window_s).sum()) / _length_s(plan)


def stay_of_first_s(log: EventLog, plan: Plan) -> float:
    """Time in the system of the product ``first``, of those that finish in the window."""
    return _stay_s(log, plan, "first")


def stay_of_second_s(log: EventLog, plan: Plan) -> float:
    """Time in the system of the product ``second``, of those that finish in the window."""
    return _stay_s(log, plan, "second")


def jobs_finished(log: EventLog, _plan: Plan) -> float:
    """Jobs that left the floor as done."""
    return float(len(log.of(FINISH)))


def absent_at_once(log: EventLog, plan: Plan) -> float:
    """Workers who miss a shift, on average over the shifts of the first of them."""
    return float(_missing(log, plan).mean())


def shifts_missed_by_none(log: EventLog, plan: Plan) -> float:
    """Share of the shifts that nobody misses."""
    return float((_missing(log, plan) == 0).mean())


def shifts_missed_by_two(log: EventLog, plan: Plan) -> float:
    """Share of the shifts that two miss."""
    return float((_missing(log, plan) == 2).mean())


def incomplete_share(log: EventLog, plan: Plan) -> float:
    """Share of the jobs that left a paced line unfinished at some station of it."""
    return next(figure.value for figure in lines(log, plan) if figure.kpi == "incomplete_share" and not figure.part)


def _missing(log: EventLog, plan: Plan) -> np.ndarray:
    """(shifts,) how many miss each; all have the same shifts."""
    begins = [duty.start_s for duty in plan.workers[0].duties or ()]
    return np.array([np.sum(log.of(ABSENT)["start_s"] == begin) for begin in begins])


FROM_LOG: dict[str, Callable[[EventLog, Plan], float]] = {
    "machines_down": machines_down,
    "repairs_under_way": repairs_under_way,
    "failures_per_s": failures_per_s,
    "wait_for_repair_s": wait_for_repair_s,
    "between_machines": between_machines,
    "filled_at_once": filled_at_once,
    "orders_waiting": orders_waiting,
    "pieces_in_stock": pieces_in_stock,
    "stay_of_first_s": stay_of_first_s,
    "stay_of_second_s": stay_of_second_s,
    "jobs_finished": jobs_finished,
    "absent_at_once": absent_at_once,
    "shifts_missed_by_none": shifts_missed_by_none,
    "shifts_missed_by_two": shifts_missed_by_two,
    "incomplete_share": incomplete_share,
}


def _stay_s(log: EventLog, plan: Plan, product: str) -> float:
    low, high = plan.window_s
    came, gone = log.of(CREATE), log.of(FINISH)
    gone = gone.where((gone["product"] == _product(plan, product)) & (gone["end_s"] >= low) & (gone["end_s"] < high))
    order = np.argsort(came["job"])
    at = order[np.searchsorted(came["job"][order], gone["job"])]
    return float((gone["end_s"] - came["end_s"][at]).mean())


def _product(plan: Plan, name: str) -> int:
    return [product.name for product in plan.products].index(name)


def _seconds(log: EventLog, plan: Plan, *kinds: int) -> float:
    rows = log.of(*kinds)
    return float(rows.where(rows["station"] >= 0).clipped_s(*plan.window_s).sum())


def _repairs(log: EventLog, plan: Plan) -> float:
    rows = log.of(REPAIR)
    low, high = plan.window_s
    return float(np.sum((rows["end_s"] >= low) & (rows["end_s"] < high)))


def _length_s(plan: Plan) -> float:
    low, high = plan.window_s
    return high - low
