"""What forbids to believe the mean of a long run, said honestly."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.study.long_run.batches import FEWEST_BATCHES, MANY_VALUES, BatchMeans, batch_means, pieces
from opsim.study.long_run.correlation import rows_of, von_neumann

CHANCE = 0.01
"""Of each flag where nothing is wrong."""
PIECES = 10
MUCH = 0.5
"""What piles up grows for good where its fitted growth over the series is this share of its mean, and no accident."""
FEW_EVENTS = 200


@dataclass(frozen=True, slots=True)
class Flag:
    """A reason for doubt. ``serious`` : the interval is not to be believed at all.

    code : unstable, too_short, autocorrelated, start_left, few_events
    by   : how much: growth over the series, times as long as it should be, lag of the von Neumann ratio below 2,
           the end minus the beginning, events
    """

    code: str
    says: str
    serious: bool
    by: float


def flags(series: np.ndarray, *, piles_up: bool = True, events: int | None = None, left_out: int = 0) -> list[Flag]:
    """Reasons to doubt the mean of a series, the most serious first; none where all is well.

    series   : (n,) or (R, n), without the ``left_out`` values of its start
    piles_up : whether growth means that more comes than leaves, as with jobs inside and with waits
    events   : how many jobs or the like are behind it, where that is known
    Raises ValueError as ``batch_means``.
    """
    rows = rows_of(series)
    found = batch_means(rows)
    unstable = list(_unstable(rows)) if piles_up else []  # no longer run helps it, so that it is not called short
    return [
        *unstable,
        *([] if unstable else _too_short(rows, found, left_out)),
        *([] if unstable else _start_left(rows)),
        *_autocorrelated(found),
        *_few_events(events),
    ]


def growth(series: np.ndarray) -> tuple[float, float]:
    """(fitted growth over the whole series, one-sided p of no growth) by a line through the means of ten pieces.

    Replications are averaged first. Pieces as long as a tenth of the run are nearly independent where it is long
    enough for batch means at all.
    """
    from scipy.special import stdtr

    rows = rows_of(series)
    n = min(PIECES, rows.shape[1])
    if n < 4:
        return 0.0, 1.0
    means = pieces(rows, n).mean(axis=0)
    at = np.arange(n) - (n - 1) / 2
    slope = float(at @ means / (at @ at))
    rest = means - means.mean() - slope * at
    squares = float(rest @ rest)
    if squares <= 1e-18 * float(means @ means):
        return slope * n, 0.0 if abs(slope) > 1e-9 * float(np.max(np.abs(means))) and slope > 0 else 1.0
    t = slope / np.sqrt(squares / (n - 2) / (at @ at))
    return slope * n, float(stdtr(n - 2, -t))


def _unstable(rows: np.ndarray) -> Iterator[Flag]:
    by, p = growth(rows)
    if p <= CHANCE and by >= MUCH * abs(float(rows.mean())):
        says = f"it keeps growing, by {by:.3g} over the run about a mean of {rows.mean():.3g}: more comes than leaves"
        yield Flag("unstable", says, True, by)


def _too_short(rows: np.ndarray, found: BatchMeans, left_out: int) -> Iterator[Flag]:
    if left_out > rows.shape[1]:
        says = "more than half of the run is warm-up: the run is too short"
        yield Flag("too_short", says, True, (left_out + rows.shape[1]) / rows.shape[1])
        return
    if found.independent:
        return
    if rows.size < MANY_VALUES:
        says = f"{rows.size} values are too few to see whether batches are independent: {MANY_VALUES} are needed"
    else:
        says = (
            f"too short: what follows one another is alike (correlation {found.lag_one:.2f} of neighbours), so that it "
            f"has not even {FEWEST_BATCHES} independent batches"
        )
    yield Flag("too_short", says, True, found.longer)


def _start_left(rows: np.ndarray) -> Iterator[Flag]:
    """The first quarter against the second half, whose pieces alone say how much luck there is.

    Source: in the manner of Geweke 1992 (Bayesian Statistics 4:169-193) and of Schruben 1982 (Operations Research
    30:569-590), who take the spread from the end, where nothing of the start is left.
    """
    from scipy.special import stdtr

    n = min(2 * PIECES, rows.shape[1] // 4 * 4)
    if n < 8:
        return
    means = pieces(rows, n).mean(axis=0)
    first, last = float(means[: n // 4].mean()), means[n // 2 :]
    apart, sd = float(last.mean()) - first, float(last.std(ddof=1))
    if abs(apart) <= 1e-9 * abs(float(rows.mean())):
        return
    t = np.inf if sd == 0 else abs(apart) / (sd * np.sqrt(4 / n + 2 / n))
    if 2 * stdtr(last.size - 1, -t) <= CHANCE:
        says = f"the start still shows: {first:.4g} in the first quarter, {first + apart:.4g} in the second half"
        yield Flag("start_left", says, False, apart)


def _autocorrelated(found: BatchMeans) -> Iterator[Flag]:
    if not found.independent or found.means.shape[1] < 4:
        return
    ratio, p = von_neumann(found.means.mean(axis=0))
    if p <= CHANCE:
        says = f"neighbouring batches are alike (von Neumann ratio {ratio:.2f}, 2 if independent): ± is too narrow"
        yield Flag("autocorrelated", says, False, 2 - ratio)


def _few_events(events: int | None) -> Iterator[Flag]:
    if events is not None and events < FEW_EVENTS:
        yield Flag("few_events", f"only {events:,} jobs are behind it: {FEW_EVENTS} and more are wanted", False, events)
