"""What comes out, how long it stays, how much is inside."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.open_hours import open_hours
from opsim.kpi.values import (
    SECONDS_PER_HOUR,
    by_rank,
    created_s,
    in_window,
    mean,
    quantiles,
    units_each,
    window_length_s,
)
from opsim.log import BAD, CREATE, FINISH, LEAVING_KINDS, LOST, EventLog
from opsim.plan import Plan
from opsim.plan.endings import finishes


def throughput(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Good units finished in the window per hour, in all and by product; a lot counts as its units.

    A job that leaves with a defect is not good, though nobody found the defect (``defects_out_share``). What ends in
    a store is no output until it goes out as a part of something. ``throughput_per_h`` counts the hours for which the
    floor is scheduled to be open, ``throughput_per_calendar_h`` all hours of the window; nan where there are none.
    """
    scheduled = open_hours(plan) or np.nan
    done = _ended(log, plan, FINISH)
    product = log["product"][done[log["cause"][done] != BAD]]
    units = np.bincount(product, minlength=len(plan.products)) * units_each(plan)
    calendar = window_length_s(plan) / SECONDS_PER_HOUR
    for name, hours in (("throughput_per_h", scheduled), ("throughput_per_calendar_h", calendar)):
        yield Figure(name, "", "", "1/h", units.sum() / hours)
    finished = [rank for rank in range(len(plan.products)) if finishes(plan, rank)]
    for rank in finished if len(finished) > 1 else ():
        yield Figure("throughput_per_h", plan.products[rank].name, "", "1/h", units[rank] / scheduled)


def lost(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Jobs turned away per hour, and their share of all that arrived in the window at sources that turn jobs away."""
    losing = [rank for rank, source in enumerate(plan.sources) if source.when_full == "lose"]
    if losing:
        n_lost, arrived = _ended(log, plan, LOST).size, _ended(log, plan, CREATE)
        n_arrived = int(np.isin(log["source"][arrived], losing).sum())
        yield Figure("lost_per_h", "", "", "1/h", n_lost / (window_length_s(plan) / SECONDS_PER_HOUR))
        yield Figure("lost_share", "", "", "share", n_lost / n_arrived if n_arrived else np.nan)


def times_in_system(log: EventLog, plan: Plan) -> dict[str, np.ndarray]:
    """By product that can finish: seconds from creation to leaving of jobs that finish in the window."""
    done = _ended(log, plan, FINISH)
    stay_s = log["end_s"][done] - created_s(log, log["job"][done])
    parts = by_rank(stay_s, log["product"][done], len(plan.products))
    return {plan.products[rank].name: part for rank, part in enumerate(parts) if finishes(plan, rank)}


def time_in_system(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Time in system, in all: mean and quantiles; and lead time, which is the same of each product.

    Both run from creation to finish: waiting outside a full first buffer belongs to them.
    """
    by_product = times_in_system(log, plan)
    every_s = np.concatenate([*by_product.values(), np.array([])])
    yield Figure("time_in_system_s", "", "", "s", mean(every_s))
    for product, stay_s in by_product.items():
        if len(by_product) > 1:
            yield Figure("time_in_system_s", product, "", "s", mean(stay_s))
    yield from quantiles("time_in_system_quantile_s", "", "s", every_s)
    for product, stay_s in by_product.items():
        yield Figure("lead_time_s", product, "", "s", mean(stay_s))
    for product, stay_s in by_product.items():
        yield from quantiles("lead_time_quantile_s", product, "s", stay_s)


def work_in_progress(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Jobs inside, averaged over the window: in all, and by product where there are several; those in stores too.

    Little's law L = lambda W holds of it exactly where the floor is empty at both ends of the window.
    Source: Little 1961, A proof for the queuing formula L = lambda W, Operations Research 9(3).
    """
    length_s = window_length_s(plan)
    inside_s = _seconds_left(log, plan, CREATE) - _seconds_left(log, plan, *LEAVING_KINDS)
    yield Figure("work_in_progress", "", "", "jobs", inside_s.sum() / length_s)
    for product, spent_s in zip(plan.products, inside_s):
        if len(plan.products) > 1:
            yield Figure("work_in_progress", product.name, "", "jobs", spent_s / length_s)


def _seconds_left(log: EventLog, plan: Plan, *kinds: int) -> np.ndarray:
    """(products,) seconds of the window that follow on the instants of some kinds, summed."""
    low, high = plan.window_s
    rows = np.flatnonzero(np.isin(log["kind"], kinds))
    left_s = high - np.clip(log["end_s"][rows], low, high)
    return np.bincount(log["product"][rows], weights=left_s, minlength=len(plan.products))


def _ended(log: EventLog, plan: Plan, kind: int) -> np.ndarray:
    """Numbers of the rows of a kind that end in the window."""
    rows = np.flatnonzero(log["kind"] == kind)
    return rows[in_window(log["end_s"][rows], plan)]
