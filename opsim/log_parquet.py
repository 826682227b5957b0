"""EventLog <-> Parquet, by DuckDB: names as text, so that anybody can query the file.

One thread, insertion order preserved, compression and row-group size said: the same log gives the same bytes.
"""

import atexit
import json
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import parent_process
from pathlib import Path
from typing import Any

import numpy as np

from opsim.files import whole_file
from opsim.log import COLUMNS, NAMED, EventLog

ROW_GROUP = 65_536
_NUMBERED = ("job", "performance_id", "k")
"""Counting columns in which -1 means none."""


_open: dict[int, Any] = {}
"""By the number of the process: a database does not outlive a fork."""


def connect() -> Any:
    """A DuckDB connection in memory with one thread and order kept; to be closed.

    NOTE: to open a database takes 30 ms, as long as all else that is done to a file. So processes made for work keep
    theirs. Others do not, beyond ``one_database``, as its threads stand in the way of a fork (opsim/threads.py).
    """
    if os.getpid() in _open:
        return _open[os.getpid()].cursor()
    database = _database()
    if parent_process() is None:
        return database
    _open[os.getpid()] = database
    atexit.register(_open.clear)  # the thread that waits for the parent's end outlives Python, and all it can reach
    return database.cursor()


@contextmanager
def one_database() -> Iterator[None]:
    """All connections inside this block are to one database, opened once. No process is to be forked inside."""
    if os.getpid() in _open:
        yield
        return
    with _database() as _open[os.getpid()]:
        try:
            yield
        finally:
            del _open[os.getpid()]


def _database() -> Any:
    import duckdb

    return duckdb.connect(":memory:", config={"threads": 1, "preserve_insertion_order": True})


@contextmanager
def plain_errors(path: Path) -> Iterator[None]:
    """What DuckDB complains of inside this block becomes an OSError that names ``path`` and the reason."""
    import duckdb

    try:
        yield
    except duckdb.InterruptException:
        raise KeyboardInterrupt from None
    except duckdb.Error as error:
        raise OSError(f"{path}: {_reason(str(error), path)}") from error
    except RuntimeError as error:  # so DuckDB says that Ctrl-C came
        if "interrupted" in str(error):
            raise KeyboardInterrupt from None
        raise


@contextmanager
def parquet_file(path: Path) -> Iterator[tuple[Any, str]]:
    """(connection, temporary name as an SQL literal) to COPY a table to; the file is whole or not there.

    Raises OSError with the path and the reason, such as a full disk.
    """
    with plain_errors(path), connect() as connection, whole_file(path) as temporary:
        yield connection, quoted(str(temporary))


def quoted(text: str) -> str:
    """A text as an SQL literal."""
    return "'" + text.replace("'", "''") + "'"


def write_events(log: EventLog, path: Path, made_from: str = "") -> None:
    """Write a log as Parquet, whole or not at all; ``made_from`` says of which run it is. Raises OSError."""
    columns = ", ".join(["replication", *(_to_text(log, name) for name in COLUMNS)])
    rows = {"replication": np.full(len(log), log.replication, np.int32), **log.columns}
    meta = {"names": log.names, "horizon_s": log.horizon_s, "replication": log.replication, "made_from": made_from}
    with parquet_file(path) as (connection, temporary):
        connection.register("event_rows", rows)
        connection.execute(
            f"COPY (SELECT {columns} FROM event_rows) TO {temporary} (FORMAT parquet, COMPRESSION zstd, "
            f"ROW_GROUP_SIZE {ROW_GROUP}, KV_METADATA {{opsim: {quoted(json.dumps(meta))}}})"
        )


def read_events(path: Path, made_from: str | None = None) -> EventLog:
    """Read a log back: equal to what was written.

    made_from : the run the rows must be of; by default any
    Raises OSError with the path and the reason where the file cannot be read, is not one of ours or of another run.
    """
    name = quoted(str(path))
    with plain_errors(path), connect() as connection:
        meta = _meta(connection, path)
        if made_from is not None and meta.get("made_from") != made_from:
            raise OSError(f"{path}: an event log of another run")
        try:
            names = {column: tuple(meta["names"][column]) for column in NAMED}
            select = ", ".join(_to_number(names, column) for column in COLUMNS)
            table = connection.execute(f"SELECT {select} FROM read_parquet({name})").fetchnumpy()
            columns: dict[str, np.ndarray] = {
                column: np.asarray(table[column], dtype=kind) for column, kind in COLUMNS.items()
            }
            return EventLog(int(meta["replication"]), float(meta["horizon_s"]), columns, names)
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise OSError(f"{path}: not an event log that this opsim can read ({error})") from None


def _meta(connection: Any, path: Path) -> dict[str, Any]:
    found = connection.execute(
        f"SELECT decode(value) FROM parquet_kv_metadata({quoted(str(path))}) WHERE decode(key) = 'opsim'"
    ).fetchone()
    try:
        meta = json.loads(found[0]) if found is not None else None
    except ValueError:
        meta = None
    if not isinstance(meta, dict):
        raise OSError(f"{path}: not an event log of opsim")
    return meta


def _reason(said: str, path: Path) -> str:
    """The first line of DuckDB's complaint, without its kind and without the names of files."""
    if "No space left" in said or "File too large" in said:
        return "cannot be written: the disk is full, or the file is larger than allowed"
    line = said.splitlines()[0] if said else "cannot be read"
    line = re.sub(r"^[A-Za-z ]*Error: ", "", line)
    return "cannot be read or written: " + re.sub(rf"(?i)\s*(file )?\S*{re.escape(path.name)}\S*", "", line).strip()


def _to_text(log: EventLog, column: str) -> str:
    if column in NAMED:
        return f"list_extract({name_list(log.names[column])}, {column} + 1) AS {column}"
    if column in _NUMBERED:
        return f"nullif({column}, -1) AS {column}"
    return f"CASE WHEN isnan({column}) THEN NULL ELSE {column} END AS {column}"


def _to_number(names: dict[str, tuple[str, ...]], column: str) -> str:
    if column in NAMED:
        return f"coalesce(list_position({name_list(names[column])}, {column}), 0) - 1 AS {column}"
    if column in _NUMBERED:
        return f"coalesce({column}, -1) AS {column}"
    return f"coalesce({column}, 'nan'::DOUBLE) AS {column}"


def name_list(names: tuple[str, ...]) -> str:
    """Names as an SQL list."""
    return "[" + ", ".join(quoted(name) for name in names) + "]::VARCHAR[]"
