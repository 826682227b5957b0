"""Event rows and figures of many variants and replications in one file, Parquet or CSV, as DuckDB streams them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from opsim.export.run_clock import RunClock
from opsim.export.spreadsheet import guarded
from opsim.log_store import ROW_GROUP, parquet_file, quoted

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
