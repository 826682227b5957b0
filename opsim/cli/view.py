"""``opsim view``: a run as a moving picture, one offline page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.engine_option import engine_option
from opsim.cli.verbs import mistakes


@click.command("view")
@click.argument("of", metavar="RESULTS|FILE")
@click.option(
    "--scenario",
    "names",
    multiple=True,
    metavar="NAME",
    help="The variant to show; given twice, two side by side on one clock.  [default: base, or the first]",
)
@click.option("--replication", type=click.IntRange(min=0), default=0, show_default=True, help="Which one, from 0 on.")
@click.option("--from", "low", metavar="TIME", help="From here on: '2 h' of the run, or a clock, 'Mon 07:30'.")
@click.option("--to", "high", metavar="TIME", help="As far as here.  [default: all of the run]")
@engine_option(None)
@click.option("-o", "--out", type=click.Path(path_type=Path), help="An .html file.  [default: replay.html in RESULTS]")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(of: str, engine: str | None, as_json: bool, **options: Any) -> None:
    """Write the replay of a run: layout, parts and people moving in step with the clock, in one offline page.

    RESULTS is the folder of a run or of one of its variants. A scenario FILE is run once first.
    Keys in the page: space plays and pauses, arrows step, 1 to 4 choose the speed, ? opens the notes with all of them.
    """
    from opsim.cli.console import print_json
    from opsim.cli.replay_drawn import draw_replay
    from opsim.cli.view_asked import Asked
    from opsim.cli.view_run import run_first
    from opsim.results import variants_in

    asked = Asked(**options)
    with mistakes():
        if Path(of).is_dir():
            if engine is not None:
                raise ValueError(f"--engine: only where a scenario FILE is run; {of} is a folder of results")
            folder, results = Path(of), variants_in(Path(of))
            known = list(results)
        else:
            folder, asked, known = run_first(of, asked, engine)
            results = variants_in(folder)
        wanted = asked.checked(folder, results)
    drawn = draw_replay(wanted)
    if as_json:
        print_json(drawn.as_json())
        return
    for line in drawn.words(others=[name for name in known if name not in wanted.runs]):
        click.echo(line)
