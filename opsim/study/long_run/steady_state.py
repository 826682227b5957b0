"""A run cut into slices of time, and its jobs one after another: what batch means are made of.

What the rows of one long replication, or of a few, say of the steady state.

A long run for machines.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.kpi.window import created_s
from opsim.log import FINISH, QUEUE, STOCK, WORK, EventLog
from opsim.results import Result
from opsim.study.long_run.batching import MANY_VALUES, MOST_BATCHES, PIECES_EACH, BatchMeans, batch_means, correlogram
from opsim.study.long_run.diagnostics import Flag, beyond_luck, flags, full_stations, nobody_free
from opsim.study.long_run.warm_up import FEWEST_JOBS, SLICES, at_once, finished_per_h, found_in, jobs_inside, welch

FINE = 4 * SLICES
DAY_S = 86_400.0
WEEK_S = 7 * DAY_S
FEWEST_CYCLES = 10
"""Whole days or weeks below which a run is cut into equal slices instead."""
MOST_JOBS = 4000
"""Values kept of each replication's jobs: of more, neighbours are put together."""


def edges_of(horizon_s: float, keeps_hours: bool) -> np.ndarray:
    """(slices + 1,) edges: whole weeks or days where the floor keeps hours and there are ten, else 2,000 equal slices.

    What is left over at the end of the last whole day or week is left out.
    """
    if keeps_hours:
        for cycle_s in (WEEK_S, DAY_S):
            if horizon_s >= FEWEST_CYCLES * cycle_s:
                return np.arange(int(horizon_s // cycle_s) + 1) * cycle_s
    return np.linspace(0.0, horizon_s, FINE + 1)


def waiting(log: EventLog, edges_s: np.ndarray) -> np.ndarray:
    """(slices,) jobs that wait for a station or a worker; stock in stores does not."""
    rows = log.of(QUEUE)
    rows = rows.where(rows["cause"] != STOCK)
    return at_once(rows["start_s"], rows["end_s"], edges_s)


def people_at_work(log: EventLog, edges_s: np.ndarray) -> np.ndarray:
    """(slices,) people in a performance, averaged over each slice."""
    rows = log.of(WORK)
    rows = rows.where(rows["worker"] >= 0)
    return at_once(rows["start_s"], rows["end_s"], edges_s)


@dataclass(frozen=True, slots=True)
class Sliced:
    """One replication: ``by_time`` (slices,) of each series; ``finish_s``, ``stay_s`` (jobs,) of those that finish.

    each : jobs behind each of these values (1 unless there were many); jobs : how many finished
    """

    by_time: dict[str, np.ndarray]
    finish_s: np.ndarray
    stay_s: np.ndarray
    each: int
    jobs: int


BY_TIME: dict[str, Callable[[EventLog, np.ndarray], np.ndarray]] = {
    "throughput_per_h": finished_per_h,
    "work_in_progress": jobs_inside,
    "jobs_waiting": waiting,
    "people_at_work": people_at_work,
}


def sliced(log: EventLog, edges_s: np.ndarray) -> Sliced:
    """What is kept of a log; the log itself may then go."""
    by_time = {name: of(log, edges_s) for name, of in BY_TIME.items()}
    rows = log.of(FINISH)
    rows = rows.where(np.argsort(rows["end_s"], kind="stable"))
    finish_s, stay_s = rows["end_s"], rows["end_s"] - created_s(log, rows["job"])
    each = max(1, -(-finish_s.size // MOST_JOBS))
    last = finish_s.size // each * each
    kept = slice(finish_s.size - last, None)
    return Sliced(
        by_time, finish_s[kept].reshape(-1, each)[:, -1], stay_s[kept].reshape(-1, each).mean(axis=1), each, len(rows)
    )


def jobs_in_a_row(replications: list[Sliced], from_s: float, most: int) -> np.ndarray | None:
    """(R, G) times in system of jobs that finish from a time on, neighbours put together; None with fewer than 10.

    Each replication gives as many values, at most ``most``; the first jobs that fill no group are left out.
    """
    stays = [one.stay_s[one.finish_s >= from_s] for one in replications]
    groups = min(most, min((stay.size for stay in stays), default=0))
    if groups * len(stays) < 10:
        return None
    size = [stay.size // groups for stay in stays]
    return np.array([stay[stay.size - groups * n :].reshape(groups, n).mean(axis=1) for stay, n in zip(stays, size)])


UNITS = {
    "throughput_per_h": "1/h",
    "time_in_system_s": "s",
    "work_in_progress": "jobs",
    "jobs_waiting": "jobs",
    "people_at_work": "people",
}
"""In the order in which they are told."""
PILES_UP = ("time_in_system_s", "work_in_progress", "jobs_waiting")
MOST_LAGS = 40


@dataclass(frozen=True)
class LongSeries:
    """One figure of a long run.

    batches   : None where there are fewer than 10 values; batch_s, batch_jobs : how long one is, one of them nan
    span_s    : how long the part is that the batches are of
    curve     : the whole run, slice by slice, all replications averaged; smooth : the same by Welch; empty for jobs
    values    : of the correlogram, all replications together
    warm_up_s : by MSER-5, None where it finds none
    """

    name: str
    unit: str
    batches: BatchMeans | None
    batch_s: float
    batch_jobs: float
    span_s: float
    flags: tuple[Flag, ...]
    correlogram: np.ndarray
    values: int
    curve: np.ndarray
    smooth: np.ndarray
    warm_up_s: float | None


@dataclass(frozen=True)
class LongRun:
    """``series`` of a result; ``left_out_s`` of its start, said by ``why``: own, asked or MSER-5.

    full_stations : stations that are never without a job, where the summary says so
    nobody_free   : nobody ever waits for work, where the summary says so
    part_of_days  : the floor keeps hours, and the run is too short for batches of whole days
    """

    scenario: str
    variant: str
    seed: int
    replications: int
    horizon_s: float
    own_warm_up_s: float
    left_out_s: float
    why: str
    slice_s: float
    series: tuple[LongSeries, ...]
    full_stations: tuple[str, ...]
    part_of_days: bool
    nobody_free: bool = False

    @property
    def serious(self) -> bool:
        """Whether something forbids to believe it."""
        return self.part_of_days or any(flag.serious for one in self.series for flag in one.flags)


def look(result: Result, warm_up_s: float | None = None, progress: Callable[[int, int], None] | None = None) -> LongRun:
    """Read the rows of a result, one replication at a time, and judge them.

    warm_up_s : what is left out of the start; by default the run's own warm-up, or what MSER-5 finds if that is longer
    Raises ValueError where there are no rows or nothing is left, OSError where they cannot be read.
    """
    from opsim.log_parquet import read_events

    if not result.events_files:
        raise ValueError(f"{result.folder}: no events here; a long run is judged by its events")
    summary = result.summary
    own_s, horizon_s = summary["window_s"]
    edges_s = edges_of(horizon_s, "scheduled_h" in summary)
    read: list[Sliced] = []
    for path in result.events_files:
        read.append(sliced(read_events(path), edges_s))
        if progress is not None:
            progress(len(read), len(result.events_files))
    slice_s = float(edges_s[1])
    cuts = _mser(read, slice_s)
    left_out_s, why = _left_out(warm_up_s, own_s, cuts)
    if left_out_s >= horizon_s:
        raise ValueError(f"nothing is left: the warm-up ({left_out_s:g} s) is as long as the run ({horizon_s:g} s)")
    full, none_free = full_stations(summary), nobody_free(summary)
    inside = np.array([one.by_time["work_in_progress"] for one in read])[:, _first(edges_s, left_out_s) :]
    # A station that is never without a job is no proof alone: in a short run it may be one long busy spell.
    overloaded = (bool(full) or none_free) and beyond_luck(inside)
    return LongRun(
        str(summary.get("scenario", "")),
        str(summary.get("variant", "")),
        summary["seed"],
        len(read),
        horizon_s,
        own_s,
        left_out_s,
        why,
        slice_s,
        tuple(_series(name, read, edges_s, left_out_s, cuts, overloaded) for name in UNITS),
        full,
        "scheduled_h" in summary and slice_s < DAY_S,
        none_free,
    )


def _mser(read: list[Sliced], slice_s: float) -> Mapping[str, float | None]:
    """By series that ``opsim warm-up`` looks at: the warm-up MSER-5 suggests, None where none is believed."""
    told = sum(one.jobs for one in read) >= FEWEST_JOBS
    found = {}
    for name in ("work_in_progress", "throughput_per_h"):
        mean = np.mean([one.by_time[name] for one in read], axis=0)
        each = mean.size // SLICES
        if each:  # the same slices that `opsim warm-up` has
            mean = mean[: SLICES * each].reshape(SLICES, each).mean(axis=1)
        told = told and mean.size >= MANY_VALUES
        found[name] = found_in(name, mean, slice_s * max(1, each), told).until_s
    return found


def _left_out(asked_s: float | None, own_s: float, cuts: Mapping[str, float | None]) -> tuple[float, str]:
    if asked_s is not None:
        return asked_s, "asked"
    longest_s = max((cut for cut in cuts.values() if cut is not None), default=0.0)
    return (longest_s, "MSER-5") if longest_s > own_s else (own_s, "own")


def _series(
    name: str,
    read: list[Sliced],
    edges_s: np.ndarray,
    from_s: float,
    cuts: Mapping[str, float | None],
    overloaded: bool,
) -> LongSeries:
    by_job = name == "time_in_system_s"
    first = _first(edges_s, from_s)
    whole = None if by_job else np.array([one.by_time[name] for one in read])
    most = MOST_BATCHES * PIECES_EACH
    rows = jobs_in_a_row(read, from_s, most) if whole is None else whole[:, first:]
    n_jobs = sum(int((one.finish_s >= from_s).sum()) * one.each for one in read)
    batches = None if rows is None or rows.size < 10 else batch_means(rows)
    slice_s = float(edges_s[1])
    span_s = float(edges_s[-1] - max(from_s, 0.0))
    counted = n_jobs if name in ("throughput_per_h", "time_in_system_s") else None
    found = (
        []
        if batches is None or rows is None
        else flags(
            rows,
            piles_up=name in PILES_UP,
            events=counted,
            left_out=0 if by_job else first,
            overloaded=overloaded,
        )
    )
    curve = np.empty(0) if whole is None else whole.mean(axis=0)
    return LongSeries(
        name,
        UNITS[name],
        batches,
        np.nan if by_job or batches is None else batches.batch_size * slice_s,
        np.nan if not by_job or batches is None else n_jobs / batches.n,
        span_s,
        tuple(found),
        np.empty(0) if rows is None else correlogram(rows, MOST_LAGS),
        0 if rows is None else rows.size,
        curve,
        curve if curve.size < 8 else welch(curve),
        cuts.get(name),
    )


def _first(edges_s: np.ndarray, from_s: float) -> int:
    """The first slice that is kept."""
    return int(np.searchsorted(edges_s, from_s - 1e-6))


def as_json(run: LongRun) -> dict[str, Any]:
    """Plain values, in a fixed order."""
    return {
        "study": "long_run",
        "scenario": run.scenario,
        "variant": run.variant,
        "seed": run.seed,
        "replications": run.replications,
        "horizon_s": run.horizon_s,
        "own_warm_up_s": run.own_warm_up_s,
        "left_out_s": run.left_out_s,
        "left_out": run.why,
        "believable": not run.serious,
        "parts_of_days": run.part_of_days,
        "never_without_a_job": list(run.full_stations),
        "nobody_ever_free": run.nobody_free,
        "series": [_series_as_json(one) for one in run.series],
    }


def _series_as_json(one: LongSeries) -> dict[str, Any]:
    found = one.batches
    numbers = ("mean", "half_width", "low", "high", "half_width_overlapping", "confidence", "lag_one", "independent")
    return {
        "kpi": one.name,
        "unit": one.unit,
        "warm_up_mser_s": one.warm_up_s,
        **({} if found is None else {name: getattr(found, name) for name in numbers}),
        "batches": 0 if found is None else found.n,
        "batch_s": one.batch_s,
        "batch_jobs": one.batch_jobs,
        "batch_means": [] if found is None else found.means.tolist(),
        "flags": [{"code": flag.code, "serious": flag.serious, "by": flag.by, "says": flag.says} for flag in one.flags],
    }
