"""EventLog <-> Parquet, by DuckDB: names as text, so that anybody can query the file.

One thread, insertion order preserved, compression and row-group size said: the same log gives the same bytes.
"""

import json
from pathlib import Path

import numpy as np

from opsim.log import COLUMNS, NAMED, EventLog
from opsim.whole import whole_file

ROW_GROUP = 65_536
_NUMBERED = ("job", "performance_id", "k")
"""Counting columns in which -1 means none."""


def connect():
    """A DuckDB connection in memory with one thread and order kept."""
    import duckdb

    connection = duckdb.connect(":memory:")
    connection.execute("SET threads = 1; SET preserve_insertion_order = true")
    return connection


def quoted(text: str) -> str:
    """A text as an SQL literal."""
    return "'" + text.replace("'", "''") + "'"


def write_events(log: EventLog, path: Path) -> None:
    """Write a log as Parquet, whole or not at all."""
    columns = ", ".join(["replication", *(_to_text(log, name) for name in COLUMNS)])
    rows = {"replication": np.full(len(log), log.replication, np.int32), **log.columns}
    meta = json.dumps({"names": log.names, "horizon_s": log.horizon_s, "replication": log.replication})
    with connect() as connection, whole_file(path) as temporary:
        connection.register("event_rows", rows)
        connection.execute(
            f"COPY (SELECT {columns} FROM event_rows) TO {quoted(str(temporary))} (FORMAT parquet, COMPRESSION zstd, "
            f"ROW_GROUP_SIZE {ROW_GROUP}, KV_METADATA {{opsim: {quoted(meta)}}})"
        )


def read_events(path: Path) -> EventLog:
    """Read a log back: equal to what was written. Raises OSError or duckdb.Error where the file is not one of ours."""
    with connect() as connection:
        name = quoted(str(path))
        found = connection.execute(
            f"SELECT decode(value) FROM parquet_kv_metadata({name}) WHERE decode(key) = 'opsim'"
        ).fetchone()
        if found is None:
            raise OSError(f"{path}: not an event log of opsim")
        meta = json.loads(found[0])
        names = {column: tuple(values) for column, values in meta["names"].items()}
        select = ", ".join(_to_number(names, column) for column in COLUMNS)
        table = connection.execute(f"SELECT {select} FROM read_parquet({name})").fetchnumpy()
    columns: dict[str, np.ndarray] = {column: np.asarray(table[column], dtype=kind) for column, kind in COLUMNS.items()}
    return EventLog(meta["replication"], meta["horizon_s"], columns, names)


def _to_text(log: EventLog, column: str) -> str:
    if column in NAMED:
        return f"list_extract({_name_list(log.names[column])}, {column} + 1) AS {column}"
    if column in _NUMBERED:
        return f"nullif({column}, -1) AS {column}"
    return f"CASE WHEN isnan({column}) THEN NULL ELSE {column} END AS {column}"


def _to_number(names: dict[str, tuple[str, ...]], column: str) -> str:
    if column in NAMED:
        return f"coalesce(list_position({_name_list(names[column])}, {column}), 0) - 1 AS {column}"
    if column in _NUMBERED:
        return f"coalesce({column}, -1) AS {column}"
    return f"coalesce({column}, 'nan'::DOUBLE) AS {column}"


def _name_list(names: tuple[str, ...]) -> str:
    return "[" + ", ".join(quoted(name) for name in names) + "]::VARCHAR[]"
