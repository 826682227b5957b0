"""Text that a spreadsheet would take for a formula: in CSV files it begins with an apostrophe, and so stays text."""

from __future__ import annotations

from opsim.log_store import quoted

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
