"""What forbids to believe the mean of a long run, said honestly."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.study.long_run.batches import FEWEST_BATCHES, MANY_VALUES, BatchMeans, batch_means
from opsim.study.long_run.correlation import rows_of, von_neumann
from opsim.study.long_run.growing import PIECES, growth
from opsim.study.long_run.pieces import pieces

CHANCE = 0.01
"""Of each flag where nothing is wrong and the pieces it looks at are independent. Where they are not, far more: of
stable queues at load 0.95, 1,000 customers from empty, 15 in 100 are said to grow. So it is said with an either-or."""
MUCH = 0.5
"""What piles up keeps growing where its fitted growth over the series is this share of its mean, and no accident."""
AGAIN = 10.0
"""So many times as long a run tells growth for good from a run too short: the one grows on, the other settles."""
FEW_EVENTS = 200


@dataclass(frozen=True, slots=True)
class Flag:
    """A reason for doubt. ``serious`` : the interval is not to be believed at all.

    code : unstable (it grows, and it is known that more comes than leaves), growing (it grows within this run),
           too_short, autocorrelated, start_left, few_events
    by   : how much: growth over the series, times as long as it should be, lag of the von Neumann ratio below 2,
           the end minus the beginning, events
    """

    code: str
    says: str
    serious: bool
    by: float


def flags(
    series: np.ndarray,
    *,
    piles_up: bool = True,
    events: int | None = None,
    left_out: int = 0,
    overloaded: bool = False,
) -> list[Flag]:
    """Reasons to doubt the mean of a series, the most serious first; an empty list is no proof that all is well.

    series     : (n,) or (R, n), without the ``left_out`` values of its start
    piles_up   : whether growth may mean that more comes than leaves, as with jobs inside and with waits
    events     : how many jobs or the like are behind it, where that is known
    overloaded : whether something else than the series says that more comes than leaves, as a load above 1 or a
                 station that is never without a job; only then no longer run helps
    Raises ValueError as ``batch_means``.
    """
    rows = rows_of(series)
    found = batch_means(rows)
    growing = list(_growing(rows, overloaded)) if piles_up else []
    for_good = bool(growing) and overloaded
    return [
        *growing,
        *([] if for_good else _too_short(rows, found, left_out)),
        *([] if for_good else _start_left(rows)),
        *_autocorrelated(found),
        *_few_events(events),
    ]


def _growing(rows: np.ndarray, overloaded: bool) -> Iterator[Flag]:
    by, p = growth(rows)
    if p > CHANCE or by < MUCH * abs(float(rows.mean())):
        return
    grows = f"it keeps growing, by {by:.3g} over the run about a mean of {rows.mean():.3g}"
    if overloaded:
        yield Flag("unstable", f"{grows}: more comes than leaves, and no longer run helps", True, by)
    else:
        says = f"{grows}: either more comes than leaves, or the run is too short to tell; run {AGAIN:.0f} times as long"
        yield Flag("growing", says, True, by)


def _too_short(rows: np.ndarray, found: BatchMeans, left_out: int) -> Iterator[Flag]:
    if left_out > rows.shape[1]:
        says = "more than half of the run is warm-up: the run is too short"
        yield Flag("too_short", says, True, (left_out + rows.shape[1]) / rows.shape[1])
    elif not found.long_enough:
        yield Flag("too_short", _why_short(rows, found), True, found.longer)


def _why_short(rows: np.ndarray, found: BatchMeans) -> str:
    if found.independent and rows.shape[1] < PIECES:
        return f"replications of {rows.shape[1]} values show nothing of their start: {PIECES} are needed, better 100"
    if found.independent:
        return (
            "replications are independent, but each is too short to forget its start (correlation "
            f"{found.lag_one:.2f} of neighbouring tenths)"
        )
    if rows.size < MANY_VALUES:
        return f"{rows.size} values are too few to see whether batches are independent: {MANY_VALUES} are needed"
    return (
        f"too short: what follows one another is alike (correlation {found.lag_one:.2f} of neighbours), so that it "
        f"has not even {FEWEST_BATCHES} independent batches"
    )


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
