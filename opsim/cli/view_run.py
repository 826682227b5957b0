"""The run that ``opsim view FILE`` makes first: only so many replications as are looked at, in a folder of its own."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import click

from opsim.cli.view_asked import Asked, stretch, usual, wrong_file, wrong_names


def run_first(file: str, asked: Asked, engine: str | None = None) -> tuple[Path, Asked, list[str]]:
    """The results folder, what is asked for with the names of the variants that were run, and the names of all.

    The folder is ``results/<file's name>_view``; what it holds of another scenario is removed. Raises ScenarioError,
    ValueError with all that is wrong with what is asked for, before anything is run, OSError.
    """
    from opsim.cli.running import run_variants
    from opsim.scenario import read_scenarios
    from opsim.study.folder import other_run

    known = read_scenarios(file)
    names = tuple(name for name in asked.names if name in known) or (usual(known),)
    wrong = [*wrong_names(asked.names, known, file), *wrong_file(asked.out, {})]
    try:
        stretch(asked, [known[name].scenario.run for name in names])
    except ValueError as error:
        wrong.append(str(error))
    if wrong:
        raise ValueError("\n".join(wrong))
    out = Path("results") / f"{known[names[0]].file.stem}_view"
    stale = any(other_run(out / name, known[name], known[name].scenario.run.seed) for name in names)
    if stale:
        click.echo(f"{out}: holds the run of a scenario that has changed since; run anew", err=True)
    run_variants(file, out, names=names, replications=asked.replication + 1, overwrite=stale, engine=engine)
    return out, replace(asked, names=names), list(known)
