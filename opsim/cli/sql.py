"""``opsim sql``: a question over the results of a run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.verbs import mistakes

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
    from opsim.cli.sql_told import as_file, listed, rows_csv, rows_json, rows_table

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
