"""A question in SQL over results: read, and never write; nothing but the results is within reach."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from opsim.export.rows import CSV, in_csv
from opsim.export.spreadsheet import identifier
from opsim.export.sql_tables import TABLES, Results, Table, files_of, fill
from opsim.log import CAUSES, KINDS
from opsim.log_store import ROW_GROUP, plain_errors, quoted
from opsim.problems import nearest
from opsim.results import lacking_rows
from opsim.whole import whole_file

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
            _columns(connection, query)
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


def _columns(connection: Any, query: str) -> list[tuple[str, str]]:
    """(name, type) of what a query gives; nothing is computed."""
    return [(name, kind) for name, kind, *_ in connection.execute(f"DESCRIBE\n{_bare(query)}\n").fetchall()]


def _without_zones(connection: Any, query: str) -> str:
    """The same query, with times of a zone as text: Python would need a package more for them."""
    zoned = [identifier(name) for name, kind in _columns(connection, query) if "WITH TIME ZONE" in kind]
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
