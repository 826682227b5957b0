"""``opsim labour``: what differences between people cost, and what buys it back."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from opsim.cli.study_options import Asked, Common, Kind, Told, study_options

if TYPE_CHECKING:
    from opsim.study.jobs import Answers


def kept(asked: Asked) -> Sequence[str]:
    """Names of the figures of each replication that the study needs.

    Raises ValueError where there is nothing to split: before a folder is made.
    """
    from opsim.plan import compile_plan
    from opsim.study.labour.study import kept_figures, refuse_nothing

    refuse_nothing(asked.loaded, compile_plan(asked.loaded, seed=asked.source.seed))
    return kept_figures(asked.block, asked.loaded)


def study(asked: Asked, answers: Answers) -> Told:
    """Split, budget, buy back, tell. Raises ScenarioError, ValueError."""
    from opsim.plan import compile_plan
    from opsim.report.studies.labour import labour_page
    from opsim.study.labour.study import labour, labour_summary

    plan = compile_plan(asked.loaded, seed=asked.source.seed)
    found = labour(asked.block, asked.loaded, plan, asked.variant, answers)
    return Told(labour_summary(found), labour_page(found, asked.loaded.scenario.name))


KIND = Kind("labour", study, kept)


@click.command("labour")
@click.argument("file")
@study_options()
@click.option("--workforces", type=int, help="How many other sets of people are hired.  [default: 40]")
@click.option(
    "--design",
    type=click.Choice(["crossed", "nested"]),
    help="The same days for all workforces, or days of their own.  [default: crossed]",
)
@click.option("--target", metavar="TEXT", help="What a day has to reach: '480 a day', or 'throughput_per_h >= 60'.")
@click.option("--figure", "figures", multiple=True, metavar="NAME", help="Budget this too; may be given again.")
@click.option("--budget/--no-budget", default=None, help="What each source of variability costs.  [default: on]")
@click.option("--alone", is_flag=True, help="Also try each source as the only one.")
@click.option(
    "--add", "like", multiple=True, metavar="WORKER", help="People to add are like this one; may be given again."
)
@click.option("--most-workers", type=click.IntRange(min=0), metavar="N", help="People to add at most.  [default: 2]")
@click.option("--most-skills", type=click.IntRange(min=0), metavar="N", help="Steps of cross-training.  [default: 6]")
@click.option("--no-buy-back", is_flag=True, help="Do not ask what buys the loss back.")
def command(file: str, common: Common, **options: Any) -> None:
    """What differences between people cost in a scenario FILE: luck of staffing, a budget of variability, a way back.

    Other people are hired again and again (workforces), and each works several days (replications).
    """
    from opsim.cli.study import run_study

    run_study(KIND, file, common, _block(options))


def _block(options: dict[str, Any]) -> dict[str, Any]:
    """Options as keys of the block ``studies: labour``."""
    said = {key: options[key] for key in ("workforces", "design", "target", "figures")}
    said["budget"] = {None: None, True: "on", False: "off"}[options["budget"]]
    said["alone"] = "on" if options["alone"] else None
    if options["no_buy_back"]:
        return said | {"buy_back": "off"}
    return said | {f"buy_back.{key}": options[key] for key in ("like", "most_workers", "most_skills")}
