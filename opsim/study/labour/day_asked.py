"""The figure whose distribution is told: the good units of a day, or the one that the target names."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opsim.clock import DAY_S
from opsim.kpi.target import Target, read_target
from opsim.plan import Plan
from opsim.plan.hours.scheduled import scheduled
from opsim.plan.hours.spans import total_s
from opsim.results import Key
from opsim.study.labour.day import Chance, DayQuantile, chance, counts_as, quantile

RATE = "throughput_per_h"
QUANTILES = (0.05, 0.5, 0.95)


@dataclass(frozen=True, slots=True)
class DayAsked:
    """A figure times ``hours``: of the good units of a day the scheduled hours of a day, else 1."""

    kpi: str
    subject: str
    part: str
    hours: float
    days: int
    target: Target | None

    @property
    def a_day(self) -> bool:
        """Whether it is the good units of a day."""
        return self.target is None or self.target.a_day

    @property
    def name(self) -> str:
        return "/".join((self.kpi, self.subject, self.part)).rstrip("/")


@dataclass(frozen=True, slots=True)
class DayFound:
    """values : (W, R) of the figure, in units of a day or its own; quantiles P5, P50, P95; chance of the target

    counts_as : so many independent values say as much, of the chance where there is one
    """

    asked: DayAsked
    key: Key
    values: np.ndarray
    quantiles: tuple[DayQuantile, ...]
    chance: Chance | None
    counts_as: float


def day_asked(target: str | None, plan: Plan | None) -> DayAsked:
    """What is asked of the day; without a plan only which figure that is. Raises ValueError for no target."""
    read = None if target is None else read_target(target)
    hours, days = (1.0, 1) if plan is None else hours_and_days(plan)
    if read is None or read.a_day:
        return DayAsked(RATE, "", "", hours, days, read)
    return DayAsked(read.asked.kpi, read.asked.subject, read.asked.part, 1.0, days, read)


def hours_and_days(plan: Plan) -> tuple[float, int]:
    """(scheduled hours of a working day, working days of the run).

    A span that begins before midnight belongs to the day on which it begins, as shifts do. A run that is shorter than
    a day is a day; one without hours has days of 24 h.
    """
    spans = scheduled(plan)
    if len(spans) == 1 and total_s(spans) >= plan.horizon_s:
        days = max(1.0, plan.horizon_s / DAY_S)
        return plan.horizon_s / days / 3600, max(1, round(days))
    days_open = {int((plan.start_s + start_s) // DAY_S) for start_s, _ in spans}
    n = max(1, len(days_open))
    return total_s(spans) / n / 3600, n


def day_found(asked: DayAsked, key: Key, rates: np.ndarray, design: str) -> DayFound:
    """rates : (W, R) of the figure itself. Raises ValueError where it was not observed everywhere."""
    if not np.isfinite(rates).all():
        raise ValueError(f"target: {asked.name} was not observed in {np.count_nonzero(~np.isfinite(rates))} runs")
    values = rates * asked.hours
    found = None
    if asked.target is not None:
        bound = asked.target.bound
        found = chance(values, values >= bound if asked.target.at_least else values <= bound, design)
    quantiles = tuple(quantile(values, q, design) for q in QUANTILES)
    n = counts_as(values, design) if found is None else found.counts_as
    return DayFound(asked, key, values, quantiles, found, n)
