"""``opsim doctor``: is everything here that opsim needs?"""

from __future__ import annotations

import click

NOT_WELL = 2


@click.command("doctor")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(as_json: bool) -> int:
    """Look whether opsim can work here: versions, shipped files, folders, cores. Exit code 2 where it cannot."""
    from dataclasses import asdict

    from opsim.checkup import WRONG, findings
    from opsim.cli.console import print_json, print_table

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
