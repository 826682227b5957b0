"""``opsim effects``: what may become of people as they work, by name, with parameters, defaults and sources."""

from __future__ import annotations

from typing import Any

import click

BESIDE = (
    "acts_on: posture (default: who is slowed moves as people do who take longer) or time (the time alone); it stands "
    "under human: itself, for all effects.",
    "absence: 0.05: the share of shifts missed, of everybody with a shift who does not say his own; under human: too.",
)
"""Keys under ``human:`` that are no models."""


@click.command("effects")
@click.argument("effect", required=False)
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(effect: str | None, as_json: bool) -> None:
    """List the human effects that a scenario may switch on under `human:`; of one EFFECT, every parameter.

    human: {learning: {model: wright, rate: 0.85}, forgetting: {model: lfcm}}
    """
    from opsim.cli.app import print_json
    from opsim.subjects.human.catalogue import EFFECTS, catalogue

    if effect is not None and effect not in EFFECTS:
        raise _unknown(effect, EFFECTS)
    found = [one for one in catalogue() if effect in (None, one.effect)]
    if as_json:
        print_json({"effects": [_plain(one) for one in found]})
    elif effect is None:
        _print_all(found)
    else:
        _print_one(found)


def _unknown(effect: str, known: tuple[str, ...]) -> Exception:
    from opsim.cli.app import Mistake
    from opsim.problems import did_you_mean

    return Mistake(f"no effect {effect!r}; {did_you_mean(effect, known, otherwise='effects')}")


def _print_all(found: list[Any]) -> None:
    from opsim.cli.app import print_table
    from opsim.subjects.human.catalogue import parameters_written

    rows = [(one.effect, one.model, one.does, parameters_written(one)) for one in found]
    print_table("human effects", ("effect", "model", "what it does", "parameters with defaults"), rows, words=4)
    for one in found:
        click.echo(f"{one.effect} {one.model}: {one.source}.")
    for line in BESIDE:
        click.echo(line)


def _print_one(found: list[Any]) -> None:
    from opsim.cli.app import print_table
    from opsim.subjects.human.catalogue import as_written, name_written

    columns = ("parameter", "what it is", "unit", "default", "no effect at")
    for one in found:
        rows = [
            (name_written(p), p.meaning, p.unit, as_written(p, p.default), as_written(p, p.neutral))
            for p in one.parameters
        ]
        print_table(f"{one.effect} {one.model}: {one.does}", columns, rows, words=3)
        click.echo(f"{one.source}.")


def _plain(one: Any) -> dict[str, Any]:
    parameters = [
        {"name": p.name, "meaning": p.meaning, "unit": p.unit, "default": p.default, "neutral": p.neutral}
        for p in one.parameters
    ]
    return {"effect": one.effect, "model": one.model, "does": one.does, "source": one.source, "parameters": parameters}
