"""``opsim layout``: which station stands where."""

from __future__ import annotations

from typing import Any

import click

from opsim.cli.study_options import Asked, Common, Kind, Told, study_options

NO_SHARDS = (
    "the proposals come out of the replications of the present layout, so what is to be simulated is not known "
    "beforehand; use --processes or --executor"
)


@click.command("layout")
@click.argument("file")
@study_options(shards=False)
@click.option("--proposals", type=click.IntRange(0, 50), help="How many to make and simulate.  [default: 5]")
@click.option("--fixed", multiple=True, metavar="A,B", help="Stations that stay where they are.")
@click.option("--places", multiple=True, metavar="P,Q", help="The only places where the others may be put.")
@click.option("--best", metavar="FIGURE", help="By which figure to choose.  [default: throughput_per_h]")
@click.option("--exposure", metavar="FIGURE", help="What bodies go through, as second criterion.")
@click.option("--move", multiple=True, metavar="'PLACE=6 m, 1 m'", help="What if this place were elsewhere?")
@click.option("--swap", multiple=True, metavar="A,B", help="What if these two stations changed places?")
@click.option("--place", multiple=True, metavar="A=PLACE", help="What if this station stood there?")
@click.option("--add", multiple=True, metavar="'NEW=like A at PLACE'", help="What if there were one more of these?")
def command(file: str, common: Common, **options: Any) -> None:
    """Which station should stand where? Trips of people in a scenario FILE, proposals that shorten them, simulated.

    Changes that you ask for are simulated beside the proposals: each by itself, and all of them together.
    """
    from opsim.cli.study import run_study
    from opsim.scenario.fields import split_names

    for key in ("fixed", "places"):
        options[key] = tuple(name for text in options[key] for name in split_names(text))
    run_study(KIND, file, common, options)


def kept(asked: Asked) -> tuple[str, ...]:
    """Names of the figures that are kept; what makes no sense is refused here, before anything is written."""
    layout = _asked(asked)
    layout.check()
    return layout.kept


def study(asked: Asked, answers: Any) -> Told:
    """A pure function of what is asked and of the answers to its jobs."""
    from opsim.report.studies.layout import layout_page
    from opsim.study.layout.study import study_layout, summary

    found = study_layout(_asked(asked), answers)
    return Told(summary(found), layout_page(found))


def _asked(asked: Asked) -> Any:
    from opsim.study.layout.study import asked_of

    return asked_of(asked.varied, asked.loaded, asked.block, asked.variant, asked.source.seed)


KIND = Kind("layout", study, kept, no_shards=NO_SHARDS)
