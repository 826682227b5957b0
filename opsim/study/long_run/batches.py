"""Batch means: an interval of the steady mean from one long series, or from a few."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.study.interval import CONFIDENCE, t_interval
from opsim.study.long_run.correlation import lag_one, rows_of
from opsim.study.long_run.pieces import overlapping_half_width, pieces

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
