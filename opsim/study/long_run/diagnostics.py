"""Whether a series keeps growing, and whether that may still be luck.

What forbids to believe the mean of a long run, said honestly.

What a summary says of stations that are never without a job and people who never wait for one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.study.long_run.batching import (
    FEWEST_BATCHES,
    MANY_VALUES,
    BatchMeans,
    batch_means,
    pieces,
    rows_of,
    von_neumann,
)

PIECES = 10
STEPS = 40
"""Pieces whose steps tell how far luck carries a series that nothing holds back."""


def growth(series: np.ndarray) -> tuple[float, float]:
    """(fitted growth over the whole series, one-sided p of no growth) by a line through the means of ten pieces.

    Replications are averaged first. p holds where the pieces are independent: a queue that is nearly full wanders, so
    that in a short run p is small far more often than it says.
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


def beyond_luck(series: np.ndarray) -> bool:
    """Whether a series grows more than it would by luck if as much left as comes: a load of exactly 1.

    At that load what piles up is a random walk that cannot fall below 0. It gets as far as |N(0, 1)| times the sd of
    all its steps together, 0.8 on average with an sd of 0.6; 2.2 / sqrt(replications) more than 0.8 is hardly luck
    (at a load of 1 one single run of a hundred). Below a load of 1 luck carries it less far.
    Source: Donsker's theorem and the reflection of Brownian motion (Billingsley, Convergence of probability measures).
    """
    rows = rows_of(series)
    n = min(STEPS, rows.shape[1])
    if n < 4:
        return False
    steps = np.diff(pieces(rows, n), axis=1)
    # Means of pieces of a random walk step by two thirds of the variance of its ends.
    sd = float(np.sqrt(1.5 * n * steps.var()))
    return growth(rows)[0] > sd * (0.8 + 2.2 / np.sqrt(rows.shape[0]))


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


NEVER = 0.005
"""A state that takes no more of the time than this never occurs, but for the first moments."""


def full_stations(summary: Mapping[str, Any]) -> tuple[str, ...]:
    """Stations that are never without a job."""
    return tuple(name for name, share in _shares(summary, "station_states", "starved") if share <= NEVER)


def nobody_free(summary: Mapping[str, Any]) -> bool:
    """Whether there are people and none of them ever waits for work."""
    waits = [share for _, share in _shares(summary, "worker_states", "wait")]
    return bool(waits) and max(waits) <= NEVER


def _shares(summary: Mapping[str, Any], kpi: str, part: str) -> list[tuple[str, float]]:
    """(station or worker, share of the time) in a state, where it is known."""
    rows = [row for row in summary["kpis"] if (row["kpi"], row["part"]) == (kpi, part)]
    return [(row["subject"], row["mean"]) for row in rows if row["mean"] is not None]
