"""What comes out, how long it stays, how much is inside."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.log import CREATE, FINISH, LOST, EventLog
from opsim.plan import Plan

SECONDS_PER_HOUR = 3600.0


def throughput(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Good jobs finished in the window per hour, in all and by product.

    No calendar closes release or stations yet, so scheduled open hours and calendar hours are the same.
    """
    hours = _window_length_s(plan) / SECONDS_PER_HOUR
    product = _in_window(log.of(FINISH), plan)["product"]
    for name in ("throughput_per_h", "throughput_per_calendar_h"):
        yield Figure(name, "", "", "1/h", product.size / hours)
    for rank, count in enumerate(np.bincount(product, minlength=len(plan.products))):
        if len(plan.products) > 1:
            yield Figure("throughput_per_h", plan.products[rank].name, "", "1/h", count / hours)


def lost(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Jobs turned away per hour and their share of all that arrived in the window, where the source turns jobs away."""
    if plan.release.when_full == "lose":
        n_lost = len(_in_window(log.of(LOST), plan))
        n_arrived = len(_in_window(log.of(CREATE), plan))
        yield Figure("lost_per_h", "", "", "1/h", n_lost / (_window_length_s(plan) / SECONDS_PER_HOUR))
        yield Figure("lost_share", "", "", "share", n_lost / n_arrived if n_arrived else np.nan)


def times_in_system(log: EventLog, plan: Plan) -> dict[str, np.ndarray]:
    """By product: seconds from creation to leaving of jobs that finish in the window."""
    created = log.of(CREATE)
    enter_s = np.empty(len(created))
    enter_s[created["job"]] = created["end_s"]
    done = _in_window(log.of(FINISH), plan)
    stay_s = done["end_s"] - enter_s[done["job"]]
    return {product.name: stay_s[done["product"] == rank] for rank, product in enumerate(plan.products)}


def time_in_system(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Mean time in system, in all and by product."""
    by_product = times_in_system(log, plan)
    yield Figure("time_in_system_s", "", "", "s", mean(np.concatenate(list(by_product.values()))))
    for product, stay_s in by_product.items():
        if len(by_product) > 1:
            yield Figure("time_in_system_s", product, "", "s", mean(stay_s))


def work_in_progress(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Jobs inside, averaged over the window."""
    low, high = plan.window_s
    left = log.of(FINISH, LOST)["end_s"]
    created = log.of(CREATE)["end_s"]
    inside_s = np.clip(left, low, high).sum() + (created.size - left.size) * high - np.clip(created, low, high).sum()
    yield Figure("work_in_progress", "", "", "jobs", inside_s / (high - low))


def mean(values: np.ndarray) -> float:
    """The mean, or nan where there is nothing to average."""
    return float(values.mean()) if values.size else float("nan")


def _in_window(log: EventLog, plan: Plan) -> EventLog:
    low, high = plan.window_s
    return log.where((log["end_s"] >= low) & (log["end_s"] < high))


def _window_length_s(plan: Plan) -> float:
    low, high = plan.window_s
    return high - low
