"""Where, at what, with which product and when of the day people are exposed."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from opsim.clock import on_the_clock
from opsim.ergonomics.shift.booking import HOUR_S, HOURS
from opsim.ergonomics.shift.day import UPRIGHT, hours_s
from opsim.ergonomics.shift.ledger import Ledger
from opsim.ergonomics.shift.stretch import WAITING, WALKING
from opsim.kpi.figure import Figure
from opsim.kpi.levels import LEVELS, bounds_of_level, minutes
from opsim.kpi.values import SECONDS_PER_HOUR
from opsim.log import ABSENT, OFF, EventLog
from opsim.plan import Plan

NONE = -1
Subjects = dict[int, str]


def exposure_by(ledger: Ledger, plan: Plan, hours: float, log: EventLog) -> Iterator[Figure]:
    """Measured minutes at each of ``LEVELS`` (part; with ``_at_most`` behind it: as many as there may be).

    exposure_by_station, exposure_by_task, exposure_by_product : in an hour of all workers' time, so that those of all
        stations (tasks, products) sum to the figure of all; but for the trunk, whose figures of all
        (``trunk_beyond_60_min_per_h``) are of work alone, while these are of walking and waiting too. Tasks ``walking``
        and ``waiting`` where these count, and ``none`` for what is done at no station, or for no product
    exposure_by_hour : by the hour of the day in which it was ("07:00"), in an hour of the time of those who were there
    """
    for column, subjects in _subjects(plan).items():
        cells = ledger.by(column, np.array(list(subjects), dtype=int))
        yield from _figures(f"exposure_by_{column}", cells, list(subjects.values()), np.full(len(subjects), hours))
    there_h = _present_s(log, plan) / SECONDS_PER_HOUR
    which = np.flatnonzero(there_h > 0)
    names = [on_the_clock(hour * HOUR_S) for hour in which.tolist()]
    yield from _figures("exposure_by_hour", ledger.by("hour", which), names, there_h[which])


def _figures(kpi: str, cells: Ledger, subjects: list[str], hours: np.ndarray) -> Iterator[Figure]:
    there = np.where(hours > 0, hours, np.nan)
    for name in LEVELS:
        for bound in bounds_of_level(name):
            for subject, value in zip(subjects, minutes(cells, name, bound) / there):
                yield Figure(kpi, subject, name + bound, "min/h", value)


def _subjects(plan: Plan) -> dict[str, Subjects]:
    """By column of the ledger's key: whatever people may be exposed at."""
    tasks = {rank: task.name for rank, task in enumerate(plan.tasks) if not task.automatic}
    beside = _beside_work(plan)
    stations = {rank: station.name for rank, station in enumerate(plan.stations) if station.tasks}
    products = {rank: product.name for rank, product in enumerate(plan.products)}
    nowhere = {NONE: "none"} if beside else {}
    no_product = {NONE: "none"} if beside or plan.setups else {}
    return {"station": stations | nowhere, "task": tasks | beside, "product": products | no_product}


def _beside_work(plan: Plan) -> Subjects:
    walking = {} if plan.walking is None else {WALKING: "walking"}
    return walking | ({WAITING: "waiting"} if plan.ergonomics.waiting == UPRIGHT else {})


def _present_s(log: EventLog, plan: Plan) -> np.ndarray:
    """(24,) seconds of the window in which workers were there, all together, by the hour of the day."""
    gone = log.where(np.isin(log["kind"], (OFF, ABSENT)) & (log["worker"] >= 0))
    found = np.zeros(HOURS)
    for low_s, high_s in pairwise(hours_s(plan)):
        hour = int((plan.start_s + low_s) // HOUR_S) % HOURS
        found[hour] += (high_s - low_s) * len(plan.workers) - gone.clipped_s(low_s, high_s).sum()
    return found
