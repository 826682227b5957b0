"""Intervals from independent replications.

Paired differences and their tests, one by one and held together; plain functions on arrays.

As many replications as a figure needs to be known within some per cent of its mean.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from opsim.kpi.catalogue import KPIS, needs_postures
from opsim.problems import did_you_mean, shown
from opsim.study.replication import Replicated

CONFIDENCE = 0.95


@dataclass(frozen=True, slots=True)
class Interval:
    """A mean and its interval; ``half_width`` is nan where fewer than two of the ``n`` values are known."""

    mean: float
    half_width: float
    sd: float
    n: int

    @property
    def low(self) -> float:
        return self.mean - self.half_width

    @property
    def high(self) -> float:
        return self.mean + self.half_width


def t_interval(values: Sequence[float] | np.ndarray, confidence: float = CONFIDENCE) -> Interval:
    """Student's t interval of a mean from independent values; nan (nothing observed) is left out and shows in ``n``.

    Source: Law, Simulation Modeling and Analysis, 5th ed., eq. 4.12.
    """
    from scipy.special import stdtrit  # scipy.stats costs three times this import

    known = np.asarray(values, dtype=float)
    known = known[~np.isnan(known)]
    n = known.size
    if n == 0:
        return Interval(np.nan, np.nan, np.nan, 0)
    mean = float(known.mean())
    if n == 1:
        return Interval(mean, np.nan, np.nan, 1)
    sd = float(known.std(ddof=1))
    return Interval(mean, float(stdtrit(n - 1, (1 + confidence) / 2) * sd / np.sqrt(n)), sd, n)


@dataclass(frozen=True, slots=True)
class QuantileInterval:
    """A quantile's estimate and interval; ``low`` or ``high`` is infinite where ``n`` values are too few to bound it.

    coverage : the chance that the interval holds the quantile, at least the confidence asked for where both are finite
    """

    estimate: float
    low: float
    high: float
    coverage: float
    n: int


def quantile_interval(values: Sequence[float], q: float, confidence: float = CONFIDENCE) -> QuantileInterval:
    """Interval of the q-quantile of what the values were drawn from, whatever its distribution; nan is left out.

    Between two order statistics, each missed on its side with a chance of at most half of what is left.
    Source: Hahn & Meeker, Statistical Intervals, 1991, section 5.2.
    """
    from scipy.special import bdtr

    if not 0 < q < 1:
        raise ValueError(f"a quantile lies between 0 and 1, found {q:g}")
    known = np.asarray(values, dtype=float)
    known = np.sort(known[~np.isnan(known)])
    n = known.size
    if n == 0:
        return QuantileInterval(np.nan, -np.inf, np.inf, 1.0, 0)
    below = bdtr(np.arange(n), n, q)  # chance that at most i of n values lie below the quantile
    miss = (1 - confidence) / 2
    lower = int(np.count_nonzero(below <= miss))  # the lower-th smallest, from 1; 0 where there is none
    upper = int(np.count_nonzero(below < 1 - miss)) + 1  # n + 1 where there is none
    padded, reached = np.r_[-np.inf, known, np.inf], np.r_[0.0, below, 1.0]
    coverage = float(reached[upper] - reached[lower])
    return QuantileInterval(float(np.quantile(known, q)), float(padded[lower]), float(padded[upper]), coverage, n)


ROUNDING = 1e-9
"""Differences below this share of the values are of the order in which numbers were added, not of the variants."""
FEW = 10
"""Pairs: in fewer of them the same step everywhere may be luck, as with counts, and says nothing of the spread."""


def holm(p: Sequence[float]) -> np.ndarray:
    """(m,) p-values held against all m tests made; nan stays nan and does not count.

    Source: Holm 1979, A simple sequentially rejective multiple test procedure, Scand. J. Statist. 6:65-70.
    """
    alone = np.asarray(p, dtype=float)
    adjusted = np.full(alone.shape, np.nan)
    order = np.argsort(alone)[: np.count_nonzero(~np.isnan(alone))]
    steps = alone[order] * np.arange(order.size, 0, -1)
    adjusted[order] = np.minimum(1.0, np.maximum.accumulate(steps))
    return adjusted


def paired(a: Sequence[float], b: Sequence[float]) -> tuple[Interval, float, float | None]:
    """(interval of the mean of a - b, two-sided p, variance ratio) of pairs; a pair with a nan is left out.

    Differences that are all below ``ROUNDING`` of the values are taken for 0. Where a and b vary, and their difference
    does not in fewer than ``FEW`` pairs, p is nan; where neither varies, nothing is left to luck.
    """
    from scipy.special import stdtr  # scipy.stats costs three times this import

    pairs = np.array([a, b], dtype=float)
    pairs = pairs[:, ~np.isnan(pairs).any(axis=0)]
    apart_by = pairs[0] - pairs[1]
    least = ROUNDING * np.abs(pairs).max(initial=0)
    if np.abs(apart_by).max(initial=0) <= least:
        apart_by = np.zeros_like(apart_by)
    interval = t_interval(apart_by)
    if interval.n < 2:
        return interval, np.nan, None
    if interval.n < FEW and interval.mean != 0 and np.ptp(apart_by) <= least < np.ptp(pairs, axis=1).max():
        return interval, np.nan, None
    if interval.sd == 0:
        return interval, 1.0 if interval.mean == 0 else 0.0, None
    t = interval.mean / (interval.sd / np.sqrt(interval.n))
    apart = float(pairs.var(axis=1, ddof=1).sum())
    return interval, float(2 * stdtr(interval.n - 1, -abs(t))), apart / interval.sd**2 if apart > 0 else None


def paired_with_each(one: np.ndarray, others: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """As ``paired`` of one variant and each of many others: (means of one - other, p, whether identical).

    one : (F, n) figures in n replications; others : (M, F, n); each of the results : (M, F)
    """
    from scipy.special import stdtr

    by = one[None] - others
    known = ~np.isnan(by)
    n = known.sum(axis=-1)
    a, b = np.where(known, one[None], 0.0), np.where(known, others, 0.0)
    least = ROUNDING * np.maximum(np.abs(a), np.abs(b)).max(axis=-1, initial=0.0)
    by = np.where(known, by, 0.0)
    by = np.where((np.abs(by).max(axis=-1, initial=0.0) <= least)[..., None], 0.0, by)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = by.sum(axis=-1) / n
        sd = np.sqrt((np.where(known, by - mean[..., None], 0.0) ** 2).sum(axis=-1) / (n - 1))
        p = 2 * stdtr(n - 1.0, -np.abs(mean) / (sd / np.sqrt(n)))
    even = _reach(by, known) <= least
    sd = np.where(even, 0.0, sd)
    p = np.where(even, np.where(mean == 0, 1.0, 0.0), p)
    varies = least < np.maximum(_reach(a, known), _reach(b, known))
    p = np.where((n < 2) | ((n < FEW) & (mean != 0) & even & varies), np.nan, p)
    return mean, p, (n > 0) & (mean == 0) & even


def _reach(values: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Largest minus smallest known value along the last axis; 0 where none is known."""
    low = np.where(known, values, np.inf).min(axis=-1, initial=np.inf)
    high = np.where(known, values, -np.inf).max(axis=-1, initial=-np.inf)
    return np.where(known.any(axis=-1), high - low, 0.0)


FEWEST = 10
"""Replications before the rule is asked at all: fewer give a half-width that is itself too uncertain."""
MOST = 1000


class NoSuchFigure(ValueError):
    """A precision is wanted of a figure that the run does not have."""


@dataclass(frozen=True, slots=True)
class Precision:
    """A figure and the half-width of its interval as a share of the mean that is wanted."""

    kpi: str
    subject: str
    part: str
    relative: float

    @property
    def name(self) -> str:
        return "/".join(filter(None, (self.kpi, self.subject, self.part)))

    def values(self, done: Sequence[Replicated]) -> list[float]:
        """The figure in each replication. Raises NoSuchFigure."""
        key = (self.kpi, self.subject, self.part)
        found = [figure.value for one in done for figure in one.figures if figure[:3] == key]
        if done and not found:
            raise NoSuchFigure(f"precision: no figure {shown(self.name)}; {self._instead(done[0])}")
        return found

    def _instead(self, one: Replicated) -> str:
        """What there is, where the figure is not."""
        if needs_postures([self.kpi]) and self.kpi not in {figure.kpi for figure in one.figures}:
            return "it is made from postures, and nobody looks at them ('posture: off'), or nobody works"
        return did_you_mean(self.name, ["/".join(filter(None, figure[:3])) for figure in one.figures])


@dataclass(frozen=True, slots=True)
class Reached:
    """What became of a Precision: the relative half-width after ``n`` replications."""

    precision: Precision
    n: int
    found: float
    reached: bool

    @property
    def words(self) -> str:
        known = f"{self.precision.name} is known within {100 * self.found:.2g} % of its mean"
        return f"{known} (wanted: {100 * self.precision.relative:.2g} %)" + ("" if self.reached else ", not reached")


def read_precision(text: str) -> Precision:
    """``throughput_per_h=1%`` or ``worker_states/ana/work=2 %``. Raises ValueError with what was expected."""
    match = re.fullmatch(r"\s*([^=/]+)(?:/([^=/]*))?(?:/([^=/]*))?\s*=\s*([0-9.]+)\s*%\s*", text)
    percent = _number(match[4]) if match else None
    if match is None or percent is None or not 0 < percent < 100:
        raise ValueError(f"precision: expected FIGURE=PER CENT, such as throughput_per_h=1%, found {shown(text)}")
    kpi = match[1].strip()
    if kpi not in KPIS:
        raise ValueError(f"precision: no figure {shown(kpi)}; {did_you_mean(kpi, KPIS)}")
    return Precision(kpi, (match[2] or "").strip(), (match[3] or "").strip(), percent / 100)


def enough(intervals: Sequence[Interval], relatives: Sequence[float]) -> bool:
    """Whether every interval is narrow enough for the true mean to be within its share.

    Source: Law, Simulation Modeling and Analysis, 5th ed., section 9.4.1: half-width / |mean| <= share / (1 + share),
    as the mean itself is only estimated.
    """
    return all(_relative(i) <= relative / (1 + relative) for i, relative in zip(intervals, relatives))


def replicate_until(
    precisions: Sequence[Precision], most: int, run: Callable[[int, int], list[Replicated]]
) -> tuple[list[Replicated], list[Reached]]:
    """Replications 0 .. n-1, n the first number from 10 on that is enough for every precision, at most ``most``.

    run(first, n) gives replications first .. n-1. They come in batches, and n is found among them one by one, so that
    it does not depend on the batches or on the number of processes.
    """
    done = run(0, 1)
    for precision in precisions:
        precision.values(done)
    upto = min(FEWEST, most)
    checked, n = FEWEST - 1, None
    while n is None:
        done = done + run(len(done), upto)
        values = [precision.values(done) for precision in precisions]
        n = next((k for k in range(checked + 1, upto + 1) if _enough(precisions, values, k)), None)
        if n is None and upto >= most:
            n = most
        checked, upto = max(checked, upto), _next(precisions, values, upto, most)
    return done[:n], [_reached(precision, done[:n]) for precision in precisions]


def _enough(precisions: Sequence[Precision], values: Sequence[list[float]], n: int) -> bool:
    return enough([t_interval(of[:n]) for of in values], [precision.relative for precision in precisions])


def _next(precisions: Sequence[Precision], values: Sequence[list[float]], n: int, most: int) -> int:
    """How many will probably be needed, at most twice as many as there are."""
    ratios = [_relative(t_interval(of)) * (1 + p.relative) / p.relative for p, of in zip(precisions, values)]
    needed = n * max(ratios) ** 2
    return min(most, max(n + 1, 2 * n if not needed < 2 * n else math.ceil(needed)))


def _reached(precision: Precision, done: Sequence[Replicated]) -> Reached:
    interval = t_interval(precision.values(done))
    reached = len(done) >= FEWEST and enough([interval], [precision.relative])
    return Reached(precision, len(done), _relative(interval), reached)


def _relative(interval: Interval) -> float:
    """Half-width as a share of the mean; infinite where there is none, nothing where every value is the same."""
    if interval.n < 2:
        return math.inf
    if interval.half_width == 0:
        return 0.0
    return interval.half_width / abs(interval.mean) if interval.mean else math.inf


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None
