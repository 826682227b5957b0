"""Batch means: an interval of the steady mean from one long series, or from a few."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.study.interval import CONFIDENCE, t_interval
from opsim.study.long_run.correlation import lag_one, rows_of

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
    independent : whether the batches may be taken for independent
    longer      : so many times as long a series would probably do; 1 where the batches are independent
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
        1.0 if independent else _longer(rows),
    )


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


def _numbers(rows: np.ndarray) -> tuple[int, float, bool]:
    """(batches a replication, lag-1 correlation of the pieces, whether the batches may be taken for independent)."""
    each, lag = 1, float("nan")
    for each in _candidates(rows.shape[0]):
        if each == 1:  # means of replications are independent, whatever their values are
            return 1, lag, True
        if rows.shape[1] >= PIECES_EACH * each:
            lag = lag_one(pieces(rows, PIECES_EACH * each))
            if lag <= ALIKE:
                return each, lag, True
    return min(each, rows.shape[1]), lag, False


def _candidates(replications: int) -> Iterator[int]:
    """Batches a replication, the most first; 1 from five replications on, which are enough for an interval."""
    for each in (40, 20, 10, 8, 5, 4, 2):
        if FEWEST_BATCHES <= each * replications <= MOST_BATCHES:
            yield each
    if replications >= 5:
        yield 1


def _longer(rows: np.ndarray) -> float:
    """So many times as many values would make the fewest batches independent, as far as this series tells."""
    wanted = PIECES_EACH * max(1, -(-FEWEST_BATCHES // rows.shape[0]))
    if rows.shape[1] < wanted:
        return min(MOST_TIMES, wanted / rows.shape[1])
    for times in (2, 3, 5, 10):
        if lag_one(pieces(rows, max(4, wanted // times))) <= ALIKE:
            return float(times)
    return MOST_TIMES
