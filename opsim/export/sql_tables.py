"""What SQL is asked over: views of the results of one or more variants of a run."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from opsim.log_store import plain_errors, quoted
from opsim.results import Result

Results = Mapping[str, Result]
Rows = Iterable[tuple]


@dataclass(frozen=True)
class Table:
    """A table by name. columns : (name, SQL type, what it is) of each; rows : of those that are not read from files"""

    name: str
    says: str
    columns: tuple[tuple[str, str, str], ...]
    rows: Callable[[Results], Rows] | None = None


_WHICH = (("variant", "VARCHAR", "the variant"), ("replication", "INTEGER", "from 0"))
_EVENTS = (
    *_WHICH,
    ("kind", "VARCHAR", "work, walk, wait, break, queue, create, finish, ..."),
    ("start_s", "DOUBLE", "seconds since the run began"),
    ("end_s", "DOUBLE", "the same as start_s of what lasts no time"),
    ("worker", "VARCHAR", "who, where it is of somebody"),
    ("station", "VARCHAR", "station, store or conveyor"),
    ("place_from", "VARCHAR", "of a walk; of who waits, where he is"),
    ("place_to", "VARCHAR", "of a walk; of who waits, where he is"),
    ("source", "VARCHAR", "where the job came from"),
    ("job", "BIGINT", "its number in the replication"),
    ("product", "VARCHAR", "of the job"),
    ("operation", "VARCHAR", "of the job's route"),
    ("task", "VARCHAR", "what is done"),
    ("performance_id", "BIGINT", "pieces of one performance have the same"),
    ("k", "BIGINT", "the worker's k-th performance of the task, from 0"),
    ("progress_from", "DOUBLE", "share of the performance done before"),
    ("progress_to", "DOUBLE", "share done after"),
    ("pace_shift", "DOUBLE", "by which human effects shifted its log time"),
    ("cause", "VARCHAR", "why somebody or something waits"),
)
_KPIS = (
    *_WHICH,
    ("kpi", "VARCHAR", "the figure's name, such as throughput_per_h"),
    ("subject", "VARCHAR", "product, worker or station; '' for all together"),
    ("part", "VARCHAR", "of figures in parts, such as work, walk, wait"),
    ("unit", "VARCHAR", "such as 1/h"),
    ("value", "DOUBLE", "in this replication; NULL where nothing was observed"),
)
_RUNS = (
    ("variant", "VARCHAR", "the variant"),
    ("scenario", "VARCHAR", "the scenario's name"),
    ("seed", "BIGINT", "of the run"),
    ("replications", "INTEGER", "how many there are"),
    ("start", "VARCHAR", "when on the week's clock the run began"),
    ("warm_up_s", "DOUBLE", "figures count from here"),
    ("horizon_s", "DOUBLE", "to here"),
    ("opsim", "VARCHAR", "the version that ran it"),
)
_TASKS = (
    ("variant", "VARCHAR", "the variant"),
    ("task", "VARCHAR", "the task"),
    ("model", "VARCHAR", "where its times come from"),
    ("emulated", "BOOLEAN", "whether it has a body"),
    ("mean_s", "DOUBLE", "mean time"),
    ("source", "VARCHAR", "recordings behind it"),
    ("licence", "VARCHAR", "of these"),
)
_WORKERS = (
    ("variant", "VARCHAR", "the variant"),
    ("worker", "VARCHAR", "the worker"),
    ("home", "VARCHAR", "where he starts"),
    ("height_m", "DOUBLE", "NULL where nobody says"),
    ("mass_kg", "DOUBLE", "NULL where nobody says"),
    ("age_years", "DOUBLE", "NULL where nobody says"),
    ("sex", "VARCHAR", "NULL where nobody says"),
    ("walk_m_per_s", "DOUBLE", "walking speed"),
)
_STATIONS = (
    ("variant", "VARCHAR", "the variant"),
    ("station", "VARCHAR", "the station"),
    ("place", "VARCHAR", "where it stands"),
    ("servers", "INTEGER", "jobs in process at once"),
    ("buffer", "BIGINT", "places in front; NULL without limit"),
    ("tasks", "VARCHAR", "what a job gets there"),
)


def _runs(results: Results) -> Rows:
    for name, result in results.items():
        said = result.summary
        low_s, high_s = said.get("window_s", (None, None))
        known = (said.get("scenario"), said["seed"], said["replications"], said.get("start"))
        yield (name, *known, low_s, high_s, said.get("opsim"))


def _tasks(results: Results) -> Rows:
    for name, result in results.items():
        for task in result.summary.get("tasks", []):
            yield (name, *(task.get(column) for column, *_ in _TASKS[1:]))


def _workers(results: Results) -> Rows:
    for name, scenario in _scenarios(results):
        for worker, said in scenario.workers.items():
            yield (name, worker, *(getattr(said, column) for column, *_ in _WORKERS[2:]))


def _stations(results: Results) -> Rows:
    for name, scenario in _scenarios(results):
        for station, said in scenario.stations.items():
            yield (name, station, said.at, said.servers, said.buffer, ", ".join(said.tasks))


def _scenarios(results: Results) -> Iterable[tuple[str, Any]]:
    """Each variant's scenario as it was run."""
    from opsim.scenario import read_scenarios
    from opsim.study.folder import RESOLVED

    for name, result in results.items():
        yield name, next(iter(read_scenarios(result.folder / RESOLVED).values())).scenario


TABLES = (
    Table("events", "what happened, a row each, the warm-up included", _EVENTS),
    Table("kpis", "every figure of every replication", _KPIS),
    Table("runs", "the variants", _RUNS, _runs),
    Table("tasks", "the tasks, and what is known of their times", _TASKS, _tasks),
    Table("workers", "the people, as the scenario describes them", _WORKERS, _workers),
    Table("stations", "the stations, as the scenario describes them", _STATIONS, _stations),
)
EXAMPLES = (
    (
        "Hours at work, by worker, in the mean of the replications",
        "SELECT variant, worker, sum(end_s - start_s) / 3600 / count(DISTINCT replication) AS hours\n"
        "FROM events WHERE kind = 'work' AND worker IS NOT NULL GROUP BY ALL ORDER BY ALL",
    ),
    (
        "Throughput of each variant, over its replications",
        "SELECT variant, avg(value) AS mean, stddev(value) AS sd, count(value) AS n\n"
        "FROM kpis WHERE kpi = 'throughput_per_h' AND subject = '' GROUP BY ALL ORDER BY mean DESC",
    ),
    (
        "The longest waits for a worker",
        "SELECT variant, replication, station, job, start_s, end_s - start_s AS waited_s\n"
        "FROM events WHERE kind = 'held' AND cause = 'worker' ORDER BY waited_s DESC LIMIT 5",
    ),
)
"""(what is asked, the query)."""


def fill(connection: Any, table: Table, results: Results) -> None:
    """Make a table of a connection: a view of files where it is read from them, else a table with its rows.

    Raises OSError that names a file which is gone or broken.
    """
    if table.rows is None:
        _fill_view(connection, table, results)
        return
    columns = ", ".join(f'"{name}" {kind}' for name, kind, _ in table.columns)
    connection.execute(f"CREATE TABLE {table.name} ({columns})")
    if rows := [list(row) for row in table.rows(results)]:
        connection.executemany(f"INSERT INTO {table.name} VALUES ({', '.join('?' * len(table.columns))})", rows)


def files_of(table: Table, result: Result) -> list[str]:
    """The files that a view reads of a variant."""
    if table.rows is not None:
        return []
    return [str(path.resolve()) for path in (result.events_files if table.name == "events" else [result.kpis_file])]


def _fill_view(connection: Any, table: Table, results: Results) -> None:
    import duckdb

    try:
        connection.execute(f"CREATE VIEW {table.name} AS {_view(table, results)}")
    except duckdb.Error:  # one by one: so it is said which file cannot be read
        for file in (file for result in results.values() for file in files_of(table, result)):
            with plain_errors(Path(file)):
                connection.execute(f"DESCRIBE SELECT {_columns(table)} FROM read_parquet({quoted(file)})")
        raise


def _view(table: Table, results: Results) -> str:
    listed = {name: files_of(table, result) for name, result in results.items()}
    parts = [
        f"SELECT {quoted(name)} AS variant, {_columns(table)} FROM read_parquet([{', '.join(map(quoted, files))}])"
        for name, files in listed.items()
        if files
    ]
    nothing = ", ".join(f'NULL::{kind} AS "{name}"' for name, kind, _ in table.columns)
    return " UNION ALL ".join(parts) or f"SELECT {nothing} WHERE false"


def _columns(table: Table) -> str:
    """Those that files have: all but the variant."""
    return ", ".join(f'"{name}"' for name, *_ in table.columns[1:])
