"""``opsim check``: is the scenario right, can everything keep up, and what may lock? No run."""

from __future__ import annotations

from typing import Any

import click

from opsim.cli.verbs import mistakes


@click.command("check")
@click.argument("file")
@click.option("--scenario", "names", multiple=True, metavar="NAME", help="Only this variant; may be given again.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(file: str, names: tuple[str, ...], as_json: bool) -> None:
    """Check a scenario FILE: schema, references, what may lock, and the load of stations, skills and all that is
    shared; and its studies: each value that is varied is laid over the scenario once. Exit code 2 where something is
    wrong."""
    from opsim.cli.check_tables import print_loads
    from opsim.cli.console import print_json
    from opsim.collecting import without_collecting

    with mistakes(), without_collecting():
        loaded = _read(file, names)
        variants, warnings, without = _checked(loaded)
    if as_json:
        print_json({"file": file, **_plain(variants), "warnings": warnings})
        return
    for name, loads in variants.items():
        print_loads(name, loads, without[name])
        for warning in warnings[name]:
            click.echo(f"warning: {name}: {warning}", err=True)
    said = ", ".join(variants)
    where = f"{'variant' if len(variants) == 1 else 'variants'} {said}{_studies(loaded)}"
    click.echo(f"{file}: no problems found in {where}")


def _studies(loaded: dict[str, Any]) -> str:
    """The studies that were checked too."""
    of_all = [one.scenario.studies for one in loaded.values()]
    asked = {verb: None for one in of_all if one is not None for verb, block in one if block is not None}
    return f", nor in what is asked of {'it' if len(loaded) == 1 else 'them'}: {', '.join(asked)}" if asked else ""


def _checked(loaded: dict[str, Any]) -> tuple[dict[str, Any], dict[str, list[str]], dict[str, str]]:
    """By variant: the loads of everything, what may go wrong, and the effects that loads know nothing of."""
    from opsim.cli.check_tables import left_out
    from opsim.plan import compile_plan
    from opsim.plan.joins import wide_joins
    from opsim.plan.loads import loads_of, overloads
    from opsim.plan.orders import late_orders
    from opsim.plan.risks import hour_risks
    from opsim.plan.unmoved import unmoved_bodies
    from opsim.plan.unread import unread
    from opsim.plan.unseen import unseen
    from opsim.scenario.risks import risks_of

    loads, warnings, without = {}, {}, {}
    for name, variant in loaded.items():
        plan = compile_plan(variant)
        loads[name], without[name] = loads_of(plan), left_out(plan)
        warnings[name] = [*overloads(plan, loads[name]), *risks_of(variant.scenario), *late_orders(plan)]
        warnings[name] += [*hour_risks(plan, loads[name]), *unread(plan), *unmoved_bodies(plan), *wide_joins(plan)]
        warnings[name] += unseen(plan, variant.scenario.outputs)
    return loads, warnings, without


def _read(file: str, names: tuple[str, ...]) -> dict[str, Any]:
    """The variants by name. Raises ScenarioError with what is wrong with them and with the studies of the file."""
    from opsim.problems import ScenarioError
    from opsim.scenario import read_scenarios
    from opsim.scenario.studied import study_problems

    of_studies = study_problems(file, names)
    try:
        loaded = read_scenarios(file, list(names) or None)
    except ScenarioError as error:
        raise ScenarioError(sorted({*error.problems, *of_studies})) from None
    if of_studies:
        raise ScenarioError(of_studies)
    return loaded


def _plain(variants: dict[str, Any]) -> dict[str, Any]:
    """By what, then by variant, as values for JSON."""
    from dataclasses import asdict

    def listed(what: str) -> dict[str, Any]:
        return {name: [asdict(one) for one in getattr(loads, what)] for name, loads in variants.items()}

    skills, crews = listed("skills"), {name: loads.crew for name, loads in variants.items()}
    people = {
        name: {"skills": skills[name], "together": None if crew is None else asdict(crew)}
        for name, crew in crews.items()
    }
    return {
        "variants": listed("stations"),
        "people": people,
        "shared": listed("shared"),
        "bottleneck": listed("limits"),
        "scheduled_share": {name: loads.scheduled_share for name, loads in variants.items()},
    }
