"""``opsim doctor``: is everything here that opsim needs?"""

from __future__ import annotations

from typing import Any

import click

from opsim.cli.app import Verbs

NOT_WELL = 2


@click.group(
    "doctor",
    cls=Verbs,
    verbs={"engines": "opsim.cli.doctor_engines"},
    invoke_without_command=True,
    no_args_is_help=False,
)
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
@click.pass_context
def command(context: click.Context, as_json: bool) -> Any:
    """Look whether opsim can work here: versions, shipped files, folders, cores. Exit code 2 where it cannot.

    'opsim doctor engines FILE' looks whether both engines give the same rows.
    """
    if context.invoked_subcommand is not None:
        return None
    from dataclasses import asdict

    from opsim.checkup import WRONG, findings
    from opsim.cli.app import print_json, print_table

    found = findings()
    wrong = [one.what for one in found if one.state == WRONG]
    if as_json:
        print_json({"well": not wrong, "findings": [asdict(one) for one in found]})
    else:
        print_table(
            "opsim doctor", ("what", "state", "found"), [(one.what, one.state, one.said) for one in found], words=3
        )
        click.echo(f"wrong: {', '.join(wrong)}" if wrong else "all well")
    return NOT_WELL if wrong else 0
