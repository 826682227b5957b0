"""How long a run needs to forget that it began empty: MSER-5 on the average of all replications.

Welch's curve: replications averaged, then smoothed, so that one sees where a run has settled.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from opsim.log import CREATE, FINISH, LEAVING_KINDS, EventLog
from opsim.results import Result
from opsim.study.long_run.batching import rows_of

BATCH = 5
FEWEST_BATCHES = 20
SLICES = 500
"""Equal slices of time a run is cut into: 100 batches of five."""
MOST_OF_LEFT = 0.5
"""A truncation beyond this share of the series is not believed: the run is too short to tell."""


FEWEST_JOBS = 20
"""Where fewer jobs finish in all replications together, nothing can be said."""


@dataclass(frozen=True, slots=True)
class WarmUp:
    """The warm-up that one series suggests.

    series      : (slices,) the average over replications, slice by slice of the whole run
    until_s     : the time to leave out, or None where no truncation can be believed
    """

    name: str
    unit: str
    slice_s: float
    series: np.ndarray
    until_s: float | None


def mser(series: np.ndarray, batch: int = BATCH) -> int | None:
    """How many values to leave out from the front, a multiple of ``batch``; None where no truncation can be believed.

    The truncation with the smallest squared standard error of the mean of what is left; it is refused in the second
    half of the series, where few values are left and happen to lie close together.
    Raises ValueError for fewer than 20 batches or values that are not finite.
    Source: White 1997, Simulation 69:323-334; batches of five: Spratt 1998 (White, Cobb & Spratt 2000, WSC).
    """
    means = _batch_means(np.asarray(series, dtype=float), batch)
    best = int(np.argmin(_statistic(means)))
    return None if best > MOST_OF_LEFT * means.size else best * batch


def suggested_warm_up(result: Result) -> list[WarmUp]:
    """The warm-up that each series of a run suggests: jobs inside, and jobs finished per hour.

    Raises OSError where its rows cannot be read.
    """
    from opsim.log_parquet import read_events

    totals: dict[str, np.ndarray] = {}
    n_finished = 0
    horizon_s, files = result.summary["window_s"][1], result.events_files
    for path in files:
        log = read_events(path)
        n_finished += len(log.of(FINISH))
        for name, (_, of) in SERIES.items():
            totals[name] = totals.get(name, 0.0) + of(log, np.linspace(0, horizon_s, SLICES + 1))
    told = n_finished >= FEWEST_JOBS
    return [found_in(name, totals[name] / len(files), horizon_s / SLICES, told) for name in totals]


def jobs_inside(log: EventLog, edges_s: np.ndarray) -> np.ndarray:
    """(slices,) jobs inside, averaged over each slice of time between two edges."""
    came_s, left_s = log.of(CREATE)["end_s"], log.of(*LEAVING_KINDS)["end_s"]
    return at_once(came_s, left_s, edges_s)


def at_once(begin_s: np.ndarray, end_s: np.ndarray, edges_s: np.ndarray) -> np.ndarray:
    """(slices,) how many of some things that begin and end are going on, averaged over each slice of time.

    begin_s, end_s : instants in any order; what never ends has no end among them
    """
    return (_area(begin_s, edges_s) - _area(end_s, edges_s)) / np.diff(edges_s)


def finished_per_h(log: EventLog, edges_s: np.ndarray) -> np.ndarray:
    """(slices,) jobs finished per hour in each slice of time."""
    return np.histogram(log.of(FINISH)["end_s"], edges_s)[0] / np.diff(edges_s) * 3600


SERIES: dict[str, tuple[str, Callable[[EventLog, np.ndarray], np.ndarray]]] = {
    "work_in_progress": ("jobs", jobs_inside),
    "throughput_per_h": ("1/h", finished_per_h),
}


def _area(at_s: np.ndarray, edges_s: np.ndarray) -> np.ndarray:
    """(slices,) integral over each slice of how many of some instants have passed."""
    at = np.sort(at_s)
    before = np.searchsorted(at, edges_s)
    until = before * edges_s - np.r_[0.0, np.cumsum(at)][before]
    return np.diff(until)


def found_in(name: str, series: np.ndarray, slice_s: float, told: bool) -> WarmUp:
    """The warm-up that the average series suggests; none where nothing can be told, as of too few jobs."""
    left_out = mser(series) if told else None
    return WarmUp(name, SERIES[name][0], slice_s, series, None if left_out is None else left_out * slice_s)


def _batch_means(series: np.ndarray, batch: int) -> np.ndarray:
    n = series.size // batch
    if n < FEWEST_BATCHES:
        raise ValueError(f"{series.size} values are too few: {FEWEST_BATCHES * batch} are needed")
    if not np.all(np.isfinite(series)):
        raise ValueError("a value of the series is not finite")
    return series[: n * batch].reshape(n, batch).mean(axis=1)


def _statistic(means: np.ndarray) -> np.ndarray:
    """(batches - 4,) sum of squares about the mean of what is left, over its number squared; five batches are left.

    Summed from the end by Welford's recursion (1962): a steady tail gives exactly 0, and large values lose nothing.
    """
    scores, mean, squares = [], 0.0, 0.0
    for n, value in enumerate(means[::-1].tolist(), 1):
        apart = value - mean
        mean += apart / n
        squares += apart * (value - mean)
        scores.append(squares / n**2)
    return np.array(scores[: BATCH - 2 : -1])


WIDEST = 4
"""A window reaches over at most a quarter of the series to either side."""


def welch(series: np.ndarray, window: int | None = None) -> np.ndarray:
    """(n - window,) the mean of all replications, smoothed over ``window`` values to either side.

    series : (n,) or (R, n), from the very start of the run; window : by default a twentieth of the series. Near the
    start as many values to either side as there are.
    Raises ValueError where the window is wider than a quarter of the series.
    Source: Welch 1983, The statistical analysis of simulation results; Law, Simulation Modeling and Analysis, 5th ed.,
    section 9.5.1.
    """
    mean = rows_of(series).mean(axis=0)
    n = mean.size
    window = n // 20 if window is None else window
    if not 0 <= window <= n // WIDEST:
        raise ValueError(f"a window of {window} does not fit: expected 0 to {n // WIDEST}, a quarter of {n} values")
    summed = np.r_[0.0, np.cumsum(mean)]
    at = np.arange(n - window)
    reach = np.minimum(at, window)
    return (summed[at + reach + 1] - summed[at - reach]) / (2 * reach + 1)
