"""``opsim sweep``: many points of some factors of a scenario."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click

from opsim.cli.app import mistakes
from opsim.cli.study_options import Asked, Common, Kind, Told, study_options

_BY_VARY = "grid where every factor is a list or --levels is given, else latin_hypercube"
_POINTS = "10 a factor; of sobol_indices 64 base points, of morris 10 paths"
_DESIGNS = ("grid", "one_at_a_time", "latin_hypercube", "sobol", "sobol_indices", "morris")


def kept(asked: Asked) -> tuple[str, ...]:
    """Names of the figures that are kept of each replication."""
    from opsim.study.sweep.study import kept

    return kept(asked)


def study(asked: Asked, answers: Any) -> Told:
    """A pure function of what is asked and its answers."""
    from opsim.study.sweep.study import study

    return Told(*study(asked, answers))


KIND = Kind("sweep", study, kept)


@click.command("sweep")
@click.argument("file")
@click.option(
    "--vary",
    multiple=True,
    metavar="PATH=VALUES",
    help="A factor, as 'stations.saw.buffer=1,2,4' or 'release.every=40 s..60 s'; again for others.",
)
@click.option(
    "--design", type=click.Choice(_DESIGNS), help=f"Where to look in the room of factors.  [default: {_BY_VARY}]"
)
@click.option(
    "--points", type=click.IntRange(min=2), help=f"How many, of a design that spreads them.  [default: {_POINTS}]"
)
@click.option(
    "--levels", type=click.IntRange(min=2), help="Of a grid: how many values every range has; a range needs it."
)
@click.option("--figure", "figures", multiple=True, metavar="NAME", help="This figure; may be given again.")
@study_options(shards=True)
def command(file: str, common: Common, vary: Sequence[str], **options: Any) -> None:
    """Run many points of some factors of a scenario FILE: what each does, a fitted response, the best point.

    What is asked may stand in the file too, under 'studies: sweep:'. A range goes from one value to another of the same
    unit; between whole numbers only whole numbers are taken. Paths are those of 'overrides', such as run.variability.
    """
    from opsim.cli.study import run_study
    from opsim.cli.study_options import vary_of

    with mistakes():
        factors = vary_of(vary)
        if options["points"] and options["design"] in ("grid", "one_at_a_time"):
            design = options["design"]
            raise ValueError(f"--points: with --design {design} the factors say which points there are; leave it out")
    run_study(KIND, file, common, {"vary": factors or None, **options})
