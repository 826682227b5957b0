"""``opsim sql``: a question over the results of a run.

Answers of ``opsim sql``: a table for people, CSV, JSON or a file; and what there is to ask.
"""

from __future__ import annotations

import re
import sys
from datetime import date, datetime, time, timedelta
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes

MOST_SHOWN = 200


@click.command("sql")
@click.argument("results", type=click.Path(path_type=Path))
@click.argument("query", required=False)
@click.option(
    "--scenario", "scenarios", multiple=True, metavar="NAME", help="A variant; may be given again.  [default: all]"
)
@click.option("--csv", "as_csv", is_flag=True, help="Rows as CSV.")
@click.option("-o", "--out", type=click.Path(path_type=Path), help="A .csv or .parquet file for the rows.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    results: Path, query: str | None, scenarios: tuple[str, ...], as_csv: bool, out: Path | None, as_json: bool
) -> None:
    """Ask the RESULTS of a run in SQL, as DuckDB has it. Without a QUERY, the tables are listed.

    opsim sql results/line "SELECT variant, kpi, avg(value) FROM kpis GROUP BY ALL"
    """

    with mistakes():
        held = _variants(results, scenarios)
        if query is None:
            listed(held, as_json)
        elif out is not None:
            as_file(held, query, out, as_json)
        elif as_csv:
            rows_csv(held, query)
        elif as_json:
            rows_json(held, query)
        else:
            rows_table(held, query, MOST_SHOWN)


def _variants(results: Path, scenarios: tuple[str, ...]) -> dict[str, Any]:
    from opsim.problems import did_you_mean, shown
    from opsim.results import variants_in

    held = variants_in(results)
    wrong = [
        f"--scenario {shown(name)}: no such results; {did_you_mean(name, held, otherwise='there are')}"
        for name in scenarios
        if name not in held
    ]
    if wrong:
        raise ValueError("\n".join(wrong))
    return {name: result for name, result in held.items() if not scenarios or name in scenarios}


def listed(results: Any, as_json: bool) -> None:
    """Tables with their columns, and worked examples."""
    from opsim.cli.app import print_json, print_table, say
    from opsim.export.sql import EXAMPLES, TABLES

    if as_json:
        tables = [
            {
                "table": table.name,
                "says": table.says,
                "columns": [{"name": name, "type": kind, "says": says} for name, kind, says in table.columns],
            }
            for table in TABLES
        ]
        print_json({"tables": tables, "examples": [{"asks": asks, "query": query} for asks, query in EXAMPLES]})
        return
    say(f"variants: {', '.join(results)}")
    for table in TABLES:
        say(f"{table.name}: {table.says}")
        print_table("", ("column", "type", "what it is"), table.columns, words=3)
    for asks, query in EXAMPLES:
        click.echo(f"{asks}:\n{query}\n")


def rows_table(results: Any, query: str, most: int) -> None:
    """The first rows as a table."""
    from opsim.cli.app import print_table
    from opsim.export.sql import answer

    columns, rows, n = answer(results, query, most)
    words = [any(isinstance(row[at], str) for row in rows) for at in range(len(columns))]
    left = next((at for at, is_word in enumerate(words) if not is_word), len(columns))
    print_table("", columns, [[_shown(value) for value in row] for row in rows], words=left)
    if n > len(rows):
        click.echo(f"{n:,} rows, the first {len(rows)} are shown; -o FILE.csv writes all")
    else:
        click.echo(f"{n:,} row{'' if n == 1 else 's'}")


def rows_csv(results: Any, query: str) -> None:
    """All rows as CSV on stdout; text that a spreadsheet would take for a formula begins with an apostrophe."""
    import csv

    from opsim.export.sql import answer
    from opsim.export.tables import DANGEROUS

    formula = re.compile(DANGEROUS)

    def cell(value: Any) -> Any:
        return f"'{value}" if isinstance(value, str) and formula.search(value) else value

    columns, rows, _ = answer(results, query)
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(map(cell, columns))
    out.writerows([cell(value) for value in row] for row in rows)


def rows_json(results: Any, query: str) -> None:
    """All rows as JSON: the columns, and a list of values of each row."""
    from opsim.cli.app import print_json
    from opsim.export.sql import answer

    columns, rows, n = answer(results, query)
    plain = [[_plain(value) for value in row] for row in rows]
    print_json({"columns": columns, "rows": plain, "n": n})


def as_file(results: Any, query: str, out: Path, as_json: bool) -> None:
    """All rows into a file."""
    from opsim.cli.app import print_json, printable
    from opsim.cli.export import size
    from opsim.cli.report import over_results
    from opsim.export.sql import write_answer
    from opsim.export.tables import CSV, PARQUET

    form = {".csv": CSV, ".parquet": PARQUET}.get(out.suffix.lower())
    if form is None:
        raise ValueError(f"{out}: found the ending {out.suffix!r}, expected .csv or .parquet")
    if wrong := over_results(out, results):
        raise ValueError("\n".join(wrong))
    n = write_answer(results, query, out, form)
    if as_json:
        print_json({"out": str(out), "rows": n, "bytes": out.stat().st_size})
    else:
        click.echo(printable(f"{out}: {n:,} rows, {size(out.stat().st_size)}"))


def _shown(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _plain(value: Any) -> Any:
    """A value as JSON has it."""
    from decimal import Decimal

    if isinstance(value, Decimal):
        return float(value)
    if isinstance(value, timedelta):
        return value.total_seconds()
    if isinstance(value, date | datetime | time):
        return value.isoformat()
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return value if isinstance(value, str | int | float | bool | None) else str(value)
