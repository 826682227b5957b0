"""Times of a run as times of the calendar: run clock + when it began in its week + a Monday.

Text that a spreadsheet would take for a formula: in CSV files it begins with an apostrophe, and so stays text.

Event rows and figures of many variants and replications in one file, Parquet or CSV, as DuckDB streams them.

Where each of several files goes that one name was given for.

A time within a run, as people say it: "Tue 10:15:30" on the week's clock, or so long since the run began.

Which row of a log is meant: the k-th performance of a task by a worker, his k-th walk, or what he does at a time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from opsim.clock import DAY_S, DAYS, clock_words, moment_s
from opsim.history import walk_rows
from opsim.log import KINDS, SETUP, WALK, WORK, WORKER_KINDS, EventLog
from opsim.log_parquet import ROW_GROUP, parquet_file, quoted
from opsim.plan import Plan
from opsim.problems import did_you_mean, shown

MONDAY = date(2026, 1, 5)
"""The Monday that a run's week begins with, where nobody says another."""
FIRST = "1970-01-01T00:00:00.000000Z"
"""When OCEL 2.0 says that something holds from the beginning on."""


@dataclass(frozen=True)
class RunClock:
    """monday : the day at whose 00:00 (UTC) the week of the run begins; start_s : run clock 0, seconds after that."""

    start_s: float
    monday: date = MONDAY

    def texts(self, times_s: np.ndarray) -> list[str]:
        """(n,) ISO 8601 times, UTC, to the microsecond: "2026-01-05T06:00:00.000000Z"."""
        began = np.datetime64(self.monday, "us") + np.timedelta64(round(self.start_s * 1e6), "us")
        passed = np.rint(np.asarray(times_s, dtype=float) * 1e6).astype(np.int64)
        # NOTE: each time is often there twice and more, as rows follow each other; to write one costs 0.5 us
        moments, which = np.unique(passed, return_inverse=True)
        written = np.datetime_as_string(began + moments.astype("timedelta64[us]"), unit="us")
        return np.char.add(written, "Z")[which].tolist() if moments.size else []


def monday_of(text: str) -> date:
    """A date as "2026-01-05". Raises ValueError where it is none, or no Monday."""
    try:
        day = date.fromisoformat(text)
    except ValueError:
        raise ValueError(f"--date {text!r}: found no date, expected one such as {MONDAY}") from None
    if day.weekday():
        before = day - timedelta(days=day.weekday())
        raise ValueError(f"--date {text}: found a {day:%A}, expected a Monday, where the week begins, such as {before}")
    return day


DANGEROUS = r"^[ \t\r\n\f\v]*[=+\-@]|^[\t\r\n]"
"""As a name from a scenario may begin, such as =HYPERLINK(...). Numbers are no text, and stay as they are."""


def guarded(column: str, kind: str) -> str:
    """A column as the SQL that gives what may stand in a CSV file. kind : its type as DuckDB calls it"""
    name = identifier(column)
    if kind != "VARCHAR":
        return name
    return f"CASE WHEN regexp_matches({name}, {quoted(DANGEROUS)}) THEN '''' || {name} ELSE {name} END AS {name}"


def identifier(name: str) -> str:
    """A name of a table or a column as SQL."""
    return '"' + name.replace('"', '""') + '"'


PARQUET, CSV = "parquet", "csv"
Files = Mapping[str, Sequence[Path]]
"""By variant, its Parquet files in the order in which they are to come."""


def write_rows(files: Files, path: Path, form: str, clocks: Mapping[str, RunClock] | None = None) -> int:
    """The rows of all files, with the variant in front, whole or not at all; returns how many there are.

    form   : ``PARQUET``, in which names stay as they are, or ``CSV``, in which none is taken for a formula
    clocks : of each variant, where the rows are to have the times of the calendar too (UTC), as start and end
    Raises OSError, ValueError where there are no files.
    """
    parts = [_variant(name, some, None if clocks is None else clocks[name]) for name, some in files.items() if some]
    if not parts:
        raise ValueError(f"{path}: not written; no rows of events are there to write")
    return _copied(" UNION ALL BY NAME ".join(parts), path, form)


def write_figures(files: Mapping[str, Path], path: Path, form: str) -> int:
    """Every figure of every replication, as ``write_rows``; what was not observed is empty."""
    return write_rows({name: [file] for name, file in files.items()}, path, form)


def _variant(name: str, files: Sequence[Path], clock: RunClock | None) -> str:
    times = "" if clock is None else f', {_moment("start_s", clock)} AS start, {_moment("end_s", clock)} AS "end"'
    return f"SELECT {quoted(name)} AS variant, *{times} FROM read_parquet([{', '.join(quoted(str(f)) for f in files)}])"


def _moment(column: str, clock: RunClock) -> str:
    """A column of the run clock as a TIMESTAMP, to the microsecond."""
    began_us = round(clock.start_s * 1e6)
    return f"(TIMESTAMP '{clock.monday} 00:00:00' + to_microseconds({began_us} + round({column} * 1e6)::BIGINT))"


def _copied(query: str, path: Path, form: str) -> int:
    with parquet_file(path) as (connection, temporary):
        how = f"FORMAT parquet, COMPRESSION zstd, ROW_GROUP_SIZE {ROW_GROUP}"
        if form == CSV:
            query, how = in_csv(connection, query), "FORMAT csv, HEADER"
        return connection.execute(f"COPY ({query}\n) TO {temporary} ({how})").fetchone()[0]


def in_csv(connection: Any, query: str) -> str:
    """A query with the same answer, in which no text is taken for a formula."""
    columns = connection.execute(f"DESCRIBE\n{query}\n").fetchall()
    return f"SELECT {', '.join(guarded(name, kind) for name, kind, *_ in columns)} FROM ({query}\n)"


def out_for(out: Path, *, variant: str = "", replication: int | None = None) -> Path:
    """``out``, with the variant and the replication before its ending where there are several.

    A variant is the name of its results folder, and so of a file: it leads nowhere else.
    """
    said = [variant] if variant else []
    said += [f"r{replication:05d}"] if replication is not None else []
    return out.with_name("_".join([out.stem, *said]) + out.suffix)


def run_s(text: str, start_s: float, horizon_s: float) -> float:
    """Seconds on the run's clock: the first such time of the run; "90 min" is since the run began.

    Raises ValueError where it cannot be read, or lies outside the run.
    """

    try:
        found_s = moment_s(text, start_s)
    except ValueError as error:
        raise ValueError(f"--at: {error}") from None
    if not 0 <= found_s < horizon_s:
        first, last = clock_words(0.0, start_s), clock_words(horizon_s, start_s)
        raise ValueError(f"--at: found {shown(text)}, outside the run; expected a time from {first} to before {last}")
    return found_s


def start_of(start: str) -> float:
    """When a run begins, as its summary says it ("Mon 06:00"), in seconds after Monday 00:00."""
    day, clock = start.split()
    hours, minutes = clock.split(":")
    return DAYS.index(day) * DAY_S + int(hours) * 3600.0 + int(minutes) * 60.0


@dataclass(frozen=True)
class Which:
    """rows : of the log, the pieces of a performance in order, or the one of a walk; k : which one it is; walk : so"""

    rows: np.ndarray
    worker: int
    k: int
    walk: bool


def performance_of(log: EventLog, plan: Plan, worker: str, task: str, k: int) -> Which:
    """All pieces of a worker's k-th performance of a task, k from 0. Raises ValueError where there is none such."""
    rank = worker_rank(plan, worker)
    names = [one.name for one in plan.tasks]
    if task not in names:
        raise ValueError(f"no task {shown(task)}; {did_you_mean(task, names, otherwise='tasks')}")
    own = _performances(log, rank, names.index(task))
    if not own.size:
        done = sorted({names[at] for at in np.unique(_tasks(log, rank)).tolist()})
        raise ValueError(f"{worker} never performs {task} in replication {log.replication}; {_listed(done)}")
    if not np.any(log["k"][own] == k):
        numbers = np.unique(log["k"][own])
        raise ValueError(f"{worker}, {task}: found no performance {k}, expected one of {_ranges(numbers.tolist())}")
    return _pieces(log, own[log["k"][own] == k][0])


def walk_of(log: EventLog, plan: Plan, worker: str, k: int) -> Which:
    """A worker's k-th walk, k from 0. Raises ValueError where there is none such."""
    rank = worker_rank(plan, worker)
    rows = walk_rows(log)
    rows = rows[log["worker"][rows] == rank]
    if not 0 <= k < rows.size:
        if not rows.size:
            raise ValueError(f"{worker} never walks in replication {log.replication}")
        raise ValueError(f"{worker}: found no walk {k}, expected one of 0 to {rows.size - 1}")
    return Which(rows[k : k + 1], rank, k, True)


def at_time(log: EventLog, plan: Plan, worker: str, time_s: float) -> Which:
    """What a worker performs at a time of the run; at an edge what begins. Raises ValueError where he does not move."""
    rank = worker_rank(plan, worker)
    rows = np.flatnonzero((log["worker"] == rank) & np.isin(log["kind"], WORKER_KINDS))
    here = rows[(log["start_s"][rows] <= time_s) & (time_s < log["end_s"][rows])]
    moves = [row for row in here.tolist() if log["kind"][row] in (WORK, SETUP, WALK)]
    if not moves:
        doing = KINDS[log["kind"][here[0]]] if here.size else "nothing, the run is over"
        raise ValueError(f"{worker} performs nothing then: found {doing}; {_next(log, rows, time_s)}")
    row = moves[0]
    if log["kind"][row] != WALK:
        return _pieces(log, row)
    walks = walk_rows(log)
    own = walks[log["worker"][walks] == rank]
    return Which(np.array([row]), rank, int(np.flatnonzero(own == row)[0]), True)


def worker_rank(plan: Plan, worker: str) -> int:
    """The rank of a worker by name. Raises ValueError with the nearest name."""
    names = [one.name for one in plan.workers]
    if worker not in names:
        raise ValueError(f"no worker {shown(worker)}; {did_you_mean(worker, names, otherwise='workers')}")
    return names.index(worker)


def _pieces(log: EventLog, row: int) -> Which:
    """Every piece of the performance that a row is of, in order of time: those of one worker, task and k."""
    same = np.isin(log["kind"], (WORK, SETUP))
    for name in ("worker", "task", "k"):
        same &= log[name] == log[name][row]
    rows = np.flatnonzero(same)
    rows = rows[np.argsort(log["start_s"][rows], kind="stable")]
    return Which(rows, int(log["worker"][row]), int(log["k"][row]), False)


def _performances(log: EventLog, rank: int, task: int) -> np.ndarray:
    work = np.isin(log["kind"], (WORK, SETUP)) & (log["k"] >= 0)
    return np.flatnonzero(work & (log["worker"] == rank) & (log["task"] == task))


def _tasks(log: EventLog, rank: int) -> np.ndarray:
    work = np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] == rank) & (log["task"] >= 0)
    return log["task"][work]


def _next(log: EventLog, rows: np.ndarray, time_s: float) -> str:
    later = rows[(log["start_s"][rows] >= time_s) & np.isin(log["kind"][rows], (WORK, SETUP, WALK))]
    if not later.size:
        return "nothing follows"
    row = later[np.argmin(log["start_s"][later])]
    what = "a walk" if log["kind"][row] == WALK else log.names["task"][log["task"][row]]
    return f"next is {what}, {log['start_s'][row] - time_s:.1f} s later"


def _listed(words: list[str]) -> str:
    return f"what is performed: {', '.join(words)}" if words else "nothing is performed at all"


def _ranges(numbers: list[int]) -> str:
    if numbers == list(range(numbers[0], numbers[-1] + 1)):
        return f"{numbers[0]} to {numbers[-1]}"
    return ", ".join(map(str, numbers[:12])) + (", ..." if len(numbers) > 12 else "")
