"""How alike neighbours in a series are: correlogram, lag-1 correlation without its bias, von Neumann's test.

Means of pieces of a series, one after another or overlapping.

Batch means: an interval of the steady mean from one long series, or from a few.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.study.intervals import CONFIDENCE, t_interval


def rows_of(series: np.ndarray) -> np.ndarray:
    """A series (n,) or one a replication (R, n) as (R, n) floats. Raises ValueError where a value is not finite."""
    rows = np.atleast_2d(np.asarray(series, dtype=float))
    if rows.ndim != 2:
        raise ValueError(f"a series has one axis, or two with replications first; found {rows.ndim}")
    if not np.all(np.isfinite(rows)):
        raise ValueError("a value of the series is not finite")
    return rows


def correlogram(series: np.ndarray, most: int) -> np.ndarray:
    """(lags,) autocorrelation at lags 0, 1, .. ``most``, replications pooled about their common mean; 0 of a constant.

    series : (n,) or (R, n); lags beyond n - 1 are left out
    Source: Box & Jenkins, Time Series Analysis, eq. 2.1.13 (divisor n at every lag).
    """
    apart = rows_of(series)
    apart = apart - apart.mean()
    squares = float(np.sum(apart**2))
    n = apart.shape[1]
    sums = [float(np.sum(apart[:, : n - lag] * apart[:, lag:])) for lag in range(min(most, n - 1) + 1)]
    if squares <= _rounding(series):
        return np.r_[1.0, np.zeros(len(sums) - 1)]
    return np.array(sums) / squares


def lag_one(series: np.ndarray) -> float:
    """Lag-1 correlation of (n,) or (R, n) by the jackknife of both halves, which takes most of its bias away.

    Source: Law & Carson 1979, A sequential procedure for determining the length of a steady-state simulation,
    Operations Research 27:1011-1025, eq. 5 (after Quenouille 1956).
    """
    rows = rows_of(series)
    half = rows.shape[1] // 2
    if half < 2:
        return float(correlogram(rows, 1)[-1]) if rows.shape[1] > 1 else 0.0
    whole, first, second = (float(correlogram(part, 1)[1]) for part in (rows, rows[:, :half], rows[:, half:]))
    return 2 * whole - (first + second) / 2


def von_neumann(values: np.ndarray) -> tuple[float, float]:
    """(ratio, p) of (n,) values: the ratio is 2 where neighbours are independent, less where they are alike.

    p : one-sided, of being so alike by luck, from the normal distribution; nan below 4 values, 1 of a constant
    Source: von Neumann 1941, Ann. Math. Stat. 12:367-395; as a test of batch means: Fishman 1978, Grouping
    observations in digital simulation, Management Science 24:510-521.
    """
    from scipy.special import ndtr

    one = np.asarray(values, dtype=float)
    n, squares = one.size, float(np.sum((one - one.mean()) ** 2))
    if n < 4:
        return np.nan, np.nan
    if squares <= _rounding(one):
        return 2.0, 1.0
    ratio = float(np.sum(np.diff(one) ** 2)) / squares
    return ratio, float(ndtr(-(1 - ratio / 2) / np.sqrt((n - 2) / (n**2 - 1))))


def _rounding(values: np.ndarray) -> float:
    """Sums of squares below this are what adding numbers in another order leaves."""
    of = np.asarray(values, dtype=float)
    return of.size * (1e-12 * float(np.max(np.abs(of), initial=0.0))) ** 2


def pieces(series: np.ndarray, n: int) -> np.ndarray:
    """(R, n) means of ``n`` pieces of equal length of each row; what fills none is left out at the front."""
    rows = rows_of(series)
    size = rows.shape[1] // n
    return rows[:, rows.shape[1] - n * size :].reshape(rows.shape[0], n, size).mean(axis=2)


def overlapping_half_width(series: np.ndarray, size: int, confidence: float = CONFIDENCE) -> float:
    """Half-width of the mean's interval from all batches of ``size`` values that overlap; nan with too few values.

    1.5 times as many degrees of freedom as without overlap.
    Source: Meketon & Schmeiser 1984, Overlapping batch means: something for nothing? Winter Simulation Conference.
    """
    from scipy.special import stdtrit

    rows = rows_of(series)
    n = rows.shape[1]
    if n < 2 * size:
        return float("nan")
    summed = np.concatenate([np.zeros((rows.shape[0], 1)), np.cumsum(rows - rows.mean(), axis=1)], axis=1)
    means = (summed[:, size:] - summed[:, :-size]) / size
    # Deviations are from the common mean of all replications, which takes less of them away than each one's own would.
    of_one = size * np.mean(means**2) / (n - size / rows.shape[0])
    freedom = max(1.0, 1.5 * (rows.size / size - 1))
    return float(stdtrit(freedom, (1 + confidence) / 2) * np.sqrt(of_one / rows.shape[0]))


MOST_BATCHES, FEWEST_BATCHES = 40, 10
PIECES_EACH = 10
"""Neighbours are judged on ten times as many pieces as there are batches: of few batches nobody knows how alike."""
ALIKE = 0.4
"""Pieces no more alike than this make batches of ten that are as good as independent (0.03 in an AR(1))."""
MOST_TIMES = 20.0
"""Longer than so many times a series its own values tell nothing of."""
MANY_VALUES = FEWEST_BATCHES * PIECES_EACH


@dataclass(frozen=True, slots=True)
class BatchMeans:
    """The mean of a series and its interval from batches that follow one another.

    half_width  : of Student's interval from the batch means; ``half_width_overlapping`` from all batches of this size
                  that overlap, as a check: near the other where the batches are long enough
    means       : (R, b) batch means, b a replication; batch_size : values in each
    left_over   : values at the front of each replication that fill no whole batch
    lag_one     : correlation of neighbours among ten times as many pieces; nan where there are too few values
    independent : whether the batches may be taken for independent: no sign that they are not
    longer      : so many times as long a series would probably do; 1 where it is ``long_enough``
    """

    mean: float
    half_width: float
    half_width_overlapping: float
    confidence: float
    means: np.ndarray
    batch_size: int
    left_over: int
    lag_one: float
    independent: bool
    longer: float

    @property
    def long_enough(self) -> bool:
        """Whether no sign is found that the series is too short.

        Whole replications are independent in any case, but where they are too short all have the same start in them.
        """
        return self.independent and self.lag_one <= ALIKE

    @property
    def n(self) -> int:
        """How many batches there are, all replications together."""
        return int(self.means.size)

    @property
    def low(self) -> float:
        return self.mean - self.half_width

    @property
    def high(self) -> float:
        return self.mean + self.half_width


def batch_means(series: np.ndarray, confidence: float = CONFIDENCE) -> BatchMeans:
    """The steady mean of a series whose start is left out already, with its interval.

    series : (n,) values in their order, or (R, n), a row a replication
    As many batches as may be taken for independent, 40 at most and 10 at least, all replications together; at least
    one a replication. Where even 10 may not, 10 are taken and ``independent`` is False: the interval is too narrow.
    From five replications on whole replications are batches if need be: ``independent``, but not ``long_enough`` where
    they are too short to forget their start, so that the interval may lie off the steady mean.
    Raises ValueError for fewer than 10 values or values that are not finite.
    Source: Law & Carson 1979 (their bound 0.4 on ten times as many pieces); Law, Simulation Modeling and Analysis,
    5th ed., section 9.5.3.
    """
    rows = rows_of(series)
    if rows.size < FEWEST_BATCHES:
        raise ValueError(f"{rows.size} values are too few for batches: {FEWEST_BATCHES} are needed, better 1,000")
    each, lag, independent = _numbers(rows)
    size = rows.shape[1] // each
    means = pieces(rows, each)
    interval = t_interval(means.ravel(), confidence)
    return BatchMeans(
        interval.mean,
        interval.half_width,
        overlapping_half_width(rows[:, rows.shape[1] - each * size :], size, confidence),
        confidence,
        means,
        size,
        rows.shape[1] - each * size,
        lag,
        independent,
        _longer(rows, lag, independent),
    )


def _numbers(rows: np.ndarray) -> tuple[int, float, bool]:
    """(batches a replication, lag-1 correlation of the pieces, whether the batches may be taken for independent)."""
    each, lag = 1, float("nan")
    for each in _candidates(rows.shape[0]):
        enough = rows.shape[1] >= PIECES_EACH * each
        lag = lag_one(pieces(rows, PIECES_EACH * each)) if enough else float("nan")
        if lag <= ALIKE or each == 1:  # means of replications are independent, whatever their values are
            return each, lag, True
    return min(each, rows.shape[1]), lag, False


def _candidates(replications: int) -> Iterator[int]:
    """Batches a replication, the most first; 1 from five replications on, which are enough for an interval."""
    for each in (40, 20, 10, 8, 5, 4, 2):
        if FEWEST_BATCHES <= each * replications <= MOST_BATCHES:
            yield each
    if replications >= 5:
        yield 1


def _longer(rows: np.ndarray, lag: float, independent: bool) -> float:
    """So many times as many values would do, as far as this series tells; 1 where it does."""
    if independent and np.isnan(lag):
        return min(MOST_TIMES, PIECES_EACH / rows.shape[1])
    if independent:
        return 1.0 if lag <= ALIKE else _times(lag)
    wanted = PIECES_EACH * max(1, -(-FEWEST_BATCHES // rows.shape[0]))
    if rows.shape[1] < wanted:
        return min(MOST_TIMES, wanted / rows.shape[1])
    for times in (2, 3, 5, 10):
        if lag_one(pieces(rows, max(4, wanted // times))) <= ALIKE:
            return float(times)
    return MOST_TIMES


def _times(lag: float) -> float:
    """So many times as long pieces are no more alike than ``ALIKE``, if correlation fades as in an AR(1).

    lag : lag-1 correlation of the pieces as they are. Where the values' own correlation is exp(-distance), means of
    pieces x long have (1 - exp(-x))^2 / (2 (x - 1 + exp(-x))): its double integral over two neighbours and over one.
    """
    lengths = np.geomspace(0.02, 4.0, 200)
    alike = (1 - np.exp(-lengths)) ** 2 / (2 * (lengths - 1 + np.exp(-lengths)))
    now, wanted = np.interp([-lag, -ALIKE], -alike, lengths)
    return next((float(times) for times in (2, 3, 5, 10) if now * times >= wanted), MOST_TIMES)
