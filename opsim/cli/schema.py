"""``opsim schema``: the JSON Schema by which editors complete and check a scenario while it is written."""

from __future__ import annotations

from pathlib import Path

import click

from opsim.cli.app import mistakes


@click.command("schema")
@click.option("-o", "--out", type=click.Path(path_type=Path), help="File to write.  [default: standard output]")
@click.option("--json", "as_json", is_flag=True, help="With -o, JSON for machines on what was written.")
def command(out: Path | None, as_json: bool) -> None:
    """Print the JSON Schema of scenarios. A scenario names it in its first line:

    # yaml-language-server: $schema=./opsim.schema.json
    """
    from opsim.cli.app import print_json
    from opsim.files import write_text
    from opsim.scenario.json_schema import json_schema, schema_text

    if out is None:
        print_json(json_schema())
        return
    with mistakes(OSError):
        write_text(out, schema_text())
    if as_json:
        print_json({"schema": str(out)})
    else:
        click.echo(f"schema {out}")
