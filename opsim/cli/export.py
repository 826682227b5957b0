"""``opsim export``: results in open formats, and any performance as BVH."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.export_asked import FORMATS
from opsim.cli.verbs import mistakes


@click.command("export")
@click.argument("results", type=click.Path(path_type=Path))
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path), help="The file; by its ending a format.")
@click.option("--format", "form", type=click.Choice(FORMATS), help="The format, where the ending does not say it.")
@click.option(
    "--scenario", "scenarios", multiple=True, metavar="NAME", help="A variant; may be given again.  [default: all]"
)
@click.option("--replication", metavar="N", help="Such as 3, 0-4, or all.  [default: 0 for OCEL and BVH, else all]")
@click.option("--figures", is_flag=True, help="The figures of each replication instead of the events (Parquet, CSV).")
@click.option("--date", metavar="MONDAY", help="The Monday the run's week begins with.  [default: 2026-01-05]")
@click.option("--by-task", is_flag=True, help="OCEL: work is an event type for each task.")
@click.option("--worker", metavar="NAME", help="BVH: whose performance.")
@click.option("--task", metavar="NAME", help="BVH: of this task, the --k-th.")
@click.option("--walk", is_flag=True, help="BVH: the --k-th walk instead.")
@click.option("--k", type=click.IntRange(min=0), help="BVH: which one of the worker's, from 0.  [default: 0]")
@click.option("--at", metavar="TIME", help="BVH: instead what is performed then: 'Tue 10:15:30', '95 min'.")
@click.option("--fps", type=click.FloatRange(min=1, max=1000), help="BVH: frames a second.  [default: 60]")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    results: Path,
    out: Path,
    form: str | None,
    scenarios: tuple[str, ...],
    replication: str | None,
    as_json: bool,
    **how: Any,
) -> None:
    """Write the RESULTS of a run for other programs.

    \b
    .jsonocel .json  OCEL 2.0, an object-centric event log (process mining), as JSON
    .sqlite          OCEL 2.0 as an SQLite database
    .parquet .csv    the event rows of all replications, or with --figures every figure
    .bvh             one performance, for programs of animation and motion capture

    OCEL is of one replication of one variant: of several, each gets a file of its own, with its name before the ending.
    In CSV files, text that a spreadsheet would take for a formula begins with an apostrophe.
    """
    from opsim.cli.console import print_json
    from opsim.cli.export_asked import BVH, CSV, PARQUET, asked

    with mistakes():
        wanted = asked(results, out, form, scenarios, replication, **how)
        if wanted.form == BVH:
            from opsim.cli.export_bvh import export_bvh as export
        elif wanted.form in (PARQUET, CSV):
            from opsim.cli.export_rows import export_rows as export
        else:
            from opsim.cli.export_ocel import export_ocel as export
        told = export(wanted)
    if as_json:
        print_json(told.plain)
    else:
        for line in told.lines:
            click.echo(line)
