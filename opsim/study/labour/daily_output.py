"""How a day comes out, over workforces and runs: quantiles, and the chance that it reaches a target.

Values of one workforce go together, and in a crossed design those of one day; so W x R values say less than as many
independent ones. They count as W R / (1 + (R - 1) s_W + (W - 1) s_D), where s_W and s_D are the shares of the variance
that lie between workforces and between days: the design effect of cluster samples (Kish 1965, section 5.4). With normal
values, whether a target is met goes together in a group at most as much as the value does. With a few odd days it goes
together more, since they hide in the values what the people have in common. So ranks count for themselves, and so does
whether the target is met, and the fewest hold.

The figure whose distribution is told: the good units of a day, or the one that the target names.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opsim.clock import DAY_S
from opsim.kpi.targets import Target, read_target
from opsim.plan import Plan
from opsim.results import Key
from opsim.study.intervals import CONFIDENCE
from opsim.study.labour.variance_components import DAY, NESTED, STAFFING, variance_parts
from opsim.subjects.shifts.hours import scheduled
from opsim.subjects.shifts.plan import total_s


@dataclass(frozen=True, slots=True)
class Chance:
    """A chance and its interval; ``count`` of the values met it, which say as much as ``counts_as`` independent."""

    estimate: float
    low: float
    high: float
    count: int
    n: int
    counts_as: float


@dataclass(frozen=True, slots=True)
class DayQuantile:
    """A quantile and its interval; infinite where the values are too few to bound it."""

    q: float
    estimate: float
    low: float
    high: float


def counts_as(values: np.ndarray, design: str) -> float:
    """So many independent values say as much as this (W, R) table; at least the independent ones that are in it."""
    n_rows, n_columns = values.shape
    least = n_rows if design == NESTED else min(n_rows, n_columns)
    if np.ptp(values) == 0:
        return float(least)
    parts = variance_parts(values, design)
    of_day = 0.0 if design == NESTED else parts.share(DAY)
    effect = 1 + (n_columns - 1) * parts.share(STAFFING) + (n_rows - 1) * of_day
    return float(min(max(values.size / effect, least), values.size))


def counts_with(values: np.ndarray, met: np.ndarray, design: str) -> float:
    """The least of ``counts_as`` of the values, of their ranks, and of whether each meets something.

    met : (W, R) of bool; where all of it is alike it says nothing of what goes together
    """
    ranks = np.unique(values, return_inverse=True)[1].reshape(values.shape)
    kinds = [values, ranks.astype(float), *([] if met.all() or not met.any() else [met.astype(float)])]
    return min(counts_as(kind, design) for kind in kinds)


def chance(values: np.ndarray, met: np.ndarray, design: str, confidence: float = CONFIDENCE) -> Chance:
    """The chance that a target is met: values and met (W, R).

    Clopper-Pearson with so many values as the table counts for, after Korn & Graubard 1998 (Survey Methodology
    24:193-201), but without their factor for few clusters, (t of all values / t of the clusters)^2: 0.95 of 40
    workforces, 0.7 of 6. Crossed with two replications it is too narrow, see ``mean_interval``.
    """
    n = counts_with(values, met, design)
    share = float(np.mean(met))
    low, high = clopper_pearson(share * n, n, confidence)
    return Chance(share, low, high, int(np.count_nonzero(met)), met.size, n)


def clopper_pearson(count: float, n: float, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """(low, high) of a chance after ``count`` of ``n``, which may be fractions.

    Source: Clopper & Pearson 1934, Biometrika 26:404-413, by quantiles of the beta distribution.
    """
    from scipy.special import betaincinv

    miss = (1 - confidence) / 2
    low = 0.0 if count <= 0 else float(betaincinv(count, n - count + 1, miss))
    high = 1.0 if count >= n else float(betaincinv(count + 1, n - count, 1 - miss))
    return low, high


def quantile(values: np.ndarray, q: float, design: str, confidence: float = CONFIDENCE) -> DayQuantile:
    """The q-quantile of a (W, R) table: where the interval of the chance of less than it ends.

    Source: Woodruff 1952, JASA 47:635-646.
    """
    known = np.sort(values, axis=None)
    middle = float(np.quantile(known, q))
    n = counts_with(values, values <= middle, design)
    low, high = clopper_pearson(q * n, n, confidence)
    least = -np.inf if low * known.size < 1 else float(np.quantile(known, low))
    most = np.inf if (1 - high) * known.size < 1 else float(np.quantile(known, high))
    return DayQuantile(q, middle, least, most)


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
