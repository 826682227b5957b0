"""``opsim select``: the best of several variants, with a promise."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click

from opsim.cli.app import mistakes
from opsim.cli.study_options import Asked, Common, Kind, Told, study_options

NO_SHARDS = (
    "which replications are needed next depends on the answers so far, so they cannot be shared out beforehand; "
    "use --processes, or --executor dask:ADDRESS for several machines"
)


def kept(asked: Asked) -> tuple[str, ...]:
    """Names of the figures that are kept of each replication. Raises ValueError where there is nothing to choose from,
    before a folder is made.
    """
    from opsim.study.select.study import kept_of

    _candidates(asked)
    return kept_of(asked.block)


def _candidates(asked: Asked) -> Any:
    from opsim.study.select.search import candidates_of

    return candidates_of(asked.block, list(asked.varied.siblings), asked.variant)


def study(asked: Asked, answers: Any) -> Told:
    """A pure function of what is asked and its answers."""
    from opsim.report.studies.selection import select_page
    from opsim.study.select.search import OptunaSearch
    from opsim.study.select.study import choose, summary_of

    run = asked.loaded.scenario.run
    candidates = _candidates(asked)
    seed = run.seed if asked.source.seed is None else asked.source.seed
    search = OptunaSearch(candidates.factors, seed, candidates.trials) if candidates.trials else None
    found = choose(asked.block, candidates, answers, search)
    return Told(summary_of(found), select_page(found, asked.loaded.scenario.name))


KIND = Kind("select", study, kept, no_shards=NO_SHARDS)


@click.command("select")
@click.argument("file")
@click.option(
    "--best", "figure", metavar="FIGURE", help="What is to be best, as 'less walked_m/ana'.  [throughput_per_h]"
)
@click.option(
    "--indifference", metavar="AMOUNT", help="A difference too small to matter: 2, '20 s', '1 %' of the base."
)
@click.option("--confidence", type=float, metavar="P", help="The chance at least of being right.  [default: 0.95]")
@click.option("--procedure", type=click.Choice(["kn", "rinott", "dudewicz-dalal", "ocba"]), help="[default: kn]")
@click.option(
    "--subject-to", multiple=True, metavar="LIMIT", help="Such as 'rula_mean/worst <= 4 +- 0.1'; may be given again."
)
@click.option("--among", "variants", metavar="A,B,C", help="These variants of the file.  [default: all]")
@click.option("--base", metavar="NAME", help="The variant to compare the best with.  [default: the first]")
@click.option(
    "--vary", multiple=True, metavar="PATH=VALUES", help="Instead of variants: every combination of such values."
)
@click.option("--search", is_flag=True, help="Let an optimiser look for good values of what is varied.")
@click.option("--trials", type=click.IntRange(min=2), help="Of a search.  [default: 60]")
@click.option(
    "--most", "most_replications", type=click.IntRange(min=5), help="Replications of each at most.  [default: 1000]"
)
@study_options(shards=False)
def command(file: str, common: Common, vary: Sequence[str], variants: str | None, **options: Any) -> None:
    """Choose the best of a scenario FILE's variants, with a promise that the choice is right.

    Whoever is clearly beaten is run no further. The chosen one is looked at again on fresh replications (--replications
    says how many), beside the base. What is asked may stand in the file too, under 'studies: select:'.
    """
    from opsim.cli.study import run_study
    from opsim.cli.study_options import vary_of

    with mistakes():
        factors = vary_of(vary)
    names = None if variants is None else [name.strip() for name in variants.split(",") if name.strip()]
    run_study(KIND, file, common, {"vary": factors or None, "variants": names, **options})
