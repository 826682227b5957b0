"""``opsim doctor engines``: do both engines give the same rows?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click

from opsim.cli.app import mistakes

DIFFERENT = 1
ROW_COLUMNS = ("kind", "start_s", "end_s", "worker", "station", "source", "job", "operation", "task", "k", "cause")
"""What of the rows around is shown on a screen."""


@click.command("engines")
@click.argument("file")
@click.option("--scenario", "names", multiple=True, metavar="NAME", help="Only this variant; may be given again.")
@click.option("--replications", type=click.IntRange(min=1), default=1, show_default=True, help="Of each variant.")
@click.option("--seed", type=click.IntRange(min=0), help="Instead of the file's own.")
@click.option("--horizon", metavar="TIME", help="Instead of the file's own, such as '8 h'.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    file: str, names: tuple[str, ...], replications: int, seed: int | None, horizon: str | None, as_json: bool
) -> int:
    """Run a scenario FILE by both engines, and show the first row in which they differ. Exit code 1 where they do.

    Nothing is written. What the fast engine does not run at all is said, with exit code 2.
    """
    from opsim.cli.app import print_json
    from opsim.cli.progress import progress, telling
    from opsim.cli.run_variants import failures
    from opsim.study.engine_choice import both_engines, planned
    from opsim.threads import lean

    lean()
    with mistakes():
        plans = planned(file, names, seed, horizon)
    with mistakes(), failures("nothing was written"), progress("both engines") as report:
        found = both_engines(plans, replications, report, telling("both engines", report))
    if as_json:
        print_json({"same": all(one.same for one in found), "variants": [one.as_json() for one in found]})
    else:
        _print(found)
    return 0 if all(one.same for one in found) else DIFFERENT


def _print(found: Sequence[Any]) -> None:
    from opsim.cli.app import print_table

    rows = [(one.variant, one.words, f"{one.simpy_s:.3g} s", f"{one.fast_s:.3g} s", one.times) for one in found]
    print_table("opsim doctor engines", ("variant", "found", "simpy", "fast", "times as fast"), rows, words=2)
    for one in found:
        if one.difference is not None:
            _print_difference(one)


def _print_difference(one: Any) -> None:
    """The row column by column, then the rows around it."""
    from opsim.cli.app import print_table, say

    differ = one.difference
    say(f"{one.variant}, replication {one.replication}: {differ.said}")
    if differ.row is None:
        return
    cells = [(cell.column, cell.one, cell.other, "differs" if cell.differs else "") for cell in differ.cells()]
    print_table(f"row {differ.row:,}", ("column", "simpy", "fast", ""), cells, words=4)
    whose = {"both": "both", "one": "simpy", "other": "fast"}
    rows = [
        (whose[log], f"{number:,}", *(row[column] for column in ROW_COLUMNS)) for log, number, row in differ.around()
    ]
    print_table("the rows around it", ("engine", "row", *ROW_COLUMNS), rows, words=2 + len(ROW_COLUMNS))
