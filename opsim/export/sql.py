"""What SQL is asked over: views of the results of one or more variants of a run.

A question in SQL over results: read, and never write; nothing but the results is within reach.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from opsim.export.tables import CSV, identifier, in_csv
from opsim.files import whole_file
from opsim.log import CAUSES, KINDS
from opsim.log_parquet import ROW_GROUP, plain_errors, quoted
from opsim.problems import nearest
from opsim.results import Result, lacking_rows

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
    from opsim.study.results_folder import RESOLVED

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


_SAME_ANSWER: dict[str, Any] = {"threads": 1, "preserve_insertion_order": True}
"""Sums of several threads differ in their last digits from one time to the next."""
_GUESS = re.compile(r"\n(Did you mean|Candidate bindings:) [^\n]*")
"""DuckDB's own nearest name, which may be of a table that nobody here knows."""
_ABOUT_TABLES = ("show", "describe", "information_schema", "duckdb_", "sqlite_master")


class WrongQuery(ValueError):
    """A query that cannot be answered: DuckDB's own words, and the nearest name where one is not known."""


@contextmanager
def asked(results: Results, query: str, writes: Path | None = None) -> Iterator[Any]:
    """A connection that sees the tables a query names, their files and, if any, one file to write; nothing else.

    NOTE: a file that may be read may be written as well. What keeps the results safe is that a query is one SELECT, and
    that it is bound below DESCRIBE first, as DuckDB changes nothing there: WITH x AS (COPY ...) is called a SELECT too.
    Raises WrongQuery for what is no single SELECT, or asks for rows that are gone; OSError for a broken file.
    """
    import duckdb

    with duckdb.connect(":memory:", config=_SAME_ANSWER | {"python_enable_replacements": False}) as connection:
        _one_select(connection, query)
        tables = _named(query)
        _with_rows(query, results)
        allowed = [file for table in tables for result in results.values() for file in files_of(table, result)]
        allowed += [] if writes is None else [str(writes.resolve())]
        connection.execute(f"SET allowed_paths = [{', '.join(map(quoted, allowed))}]")
        for table in tables:
            fill(connection, table, results)
        connection.execute("SET enable_external_access = false")
        connection.execute("SET lock_configuration = true")
        with _words(tables):
            _query_columns(connection, query)
            yield connection


def answer(results: Results, query: str, most: int | None = None) -> tuple[list[str], list[tuple], int]:
    """(columns, rows, how many there are) of a query; most : so many rows at most. Raises WrongQuery."""
    with asked(results, query) as connection:
        found = connection.execute(_without_zones(connection, query))
        columns = [name for name, *_ in found.description]
        if most is None:
            rows = found.fetchall()
            return columns, rows, len(rows)
        rows, n = found.fetchmany(most), most
        while some := found.fetchmany(10_000):
            n += len(some)
    return columns, rows, len(rows) if len(rows) < most else n


def write_answer(results: Results, query: str, path: Path, form: str) -> int:
    """The answer as a Parquet or CSV file, whole or not at all; returns its rows. Raises WrongQuery, OSError."""
    with whole_file(path) as temporary:
        temporary.touch()
        with asked(results, query, writes=temporary) as connection:
            query = _bare(query)
            how = f"FORMAT parquet, COMPRESSION zstd, ROW_GROUP_SIZE {ROW_GROUP}"
            if form == CSV:
                query, how = in_csv(connection, query), "FORMAT csv, HEADER"
            target = quoted(str(temporary.resolve()))
            with _disk(path):
                return connection.execute(f"COPY ({query}\n) TO {target} ({how}, USE_TMP_FILE false)").fetchone()[0]


@contextmanager
def _disk(path: Path) -> Iterator[None]:
    """A disk that is full is no mistake of the query's."""
    import duckdb

    try:
        yield
    except duckdb.IOException as error:
        with plain_errors(path):
            raise error


def _one_select(connection: Any, query: str) -> None:
    """Raises WrongQuery where a query is anything but one question."""
    import duckdb

    with _words(()):
        statements = connection.extract_statements(query)
    kinds = [statement.type for statement in statements]
    if kinds != [duckdb.StatementType.SELECT]:
        found = " and ".join(kind.name for kind in kinds) or "nothing"
        raise WrongQuery(f"found {found}, expected one SELECT: results are asked, never changed")


def _named(query: str) -> list[Table]:
    """The tables that a query may be about: by their names, or all where it asks which there are."""
    words = query.casefold()
    every = any(word in words for word in _ABOUT_TABLES)
    return [table for table in TABLES if every or table.name in words]


def _with_rows(query: str, results: Results) -> None:
    """Raises WrongQuery where events are asked for and some are gone: figures of the others would be taken for all."""
    gone = [words for result in results.values() if (words := lacking_rows(result))]
    if gone and "events" in query.casefold():
        raise WrongQuery("\n".join(gone))


def _query_columns(connection: Any, query: str) -> list[tuple[str, str]]:
    """(name, type) of what a query gives; nothing is computed."""
    return [(name, kind) for name, kind, *_ in connection.execute(f"DESCRIBE\n{_bare(query)}\n").fetchall()]


def _without_zones(connection: Any, query: str) -> str:
    """The same query, with times of a zone as text: Python would need a package more for them."""
    zoned = [identifier(name) for name, kind in _query_columns(connection, query) if "WITH TIME ZONE" in kind]
    if not zoned:
        return query
    return f"SELECT * REPLACE ({', '.join(f'{name}::VARCHAR AS {name}' for name in zoned)}) FROM ({_bare(query)}\n)"


def _bare(query: str) -> str:
    """One statement without the semicolon that ends it, and what comes after."""
    import duckdb

    written = query.encode()
    ends = (at for at, kind in duckdb.tokenize(query) if kind.name == "operator" and written[at : at + 1] == b";")
    return written[: next(ends, len(written))].decode()


@contextmanager
def _words(tables: Sequence[Table]) -> Iterator[None]:
    import duckdb

    try:
        yield
    except duckdb.InterruptException:
        raise KeyboardInterrupt from None
    except duckdb.Error as error:
        raise WrongQuery(_said(str(error), tables)) from None


def _said(words: str, tables: Sequence[Table]) -> str:
    """DuckDB's words with their place; the nearest table or column where it names one that is not there."""
    words = re.sub(r"LINE ([0-9]+):", lambda line: f"LINE {max(int(line[1]) - 1, 1)}:", words)
    missing = re.search(r'(?:column|Table with name|column named) "?([^"\s!]+)"?', words)
    if missing is None:
        return words
    if missing[1] in (*KINDS, *CAUSES):
        return f"{words}\ntext stands in single quotes: '{missing[1]}'"
    known = [column for table in tables for column, *_ in table.columns]
    near = nearest(missing[1], [*known, *(table.name for table in TABLES)])
    return words if near is None else f"{_GUESS.sub('', words)}\nthe nearest name: {near}"
