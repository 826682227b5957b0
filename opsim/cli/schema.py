"""``opsim schema``: the JSON Schema by which editors complete and check a scenario while it is written."""

from __future__ import annotations

from pathlib import Path

import click

from opsim.cli.verbs import mistakes


@click.command("schema")
@click.option("-o", "--out", type=click.Path(path_type=Path), help="File to write.  [default: standard output]")
@click.option("--json", "as_json", is_flag=True, help="With -o, JSON for machines on what was written.")
def command(out: Path | None, as_json: bool) -> None:
    """Print the JSON Schema of scenarios. A scenario names it in its first line:

    # yaml-language-server: $schema=./opsim.schema.json
    """
    from opsim.cli.console import print_json
    from opsim.scenario.json_schema import json_schema, schema_text
    from opsim.whole import write_text

    if out is None:
        print_json(json_schema())
        return
    with mistakes(OSError):
        write_text(out, schema_text())
    if as_json:
        print_json({"schema": str(out)})
    else:
        click.echo(f"schema {out}")
