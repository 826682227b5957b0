"""``opsim check``: is the scenario right, and can its stations keep up? No run."""

from __future__ import annotations

from typing import Any

import click

from opsim.cli.verbs import mistakes

MOST_ROWS = 60


@click.command("check")
@click.argument("file")
@click.option("--scenario", "names", multiple=True, metavar="NAME", help="Only this variant; may be given again.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(file: str, names: tuple[str, ...], as_json: bool) -> None:
    """Check a scenario FILE: schema, references, and the load of each station. Exit code 2 where something is wrong."""
    from opsim.cli.console import print_json

    with mistakes():
        variants, warnings = _checked(file, names)
    if as_json:
        from dataclasses import asdict

        loads_of = {name: [asdict(load) for load in loads] for name, loads in variants.items()}
        print_json({"file": file, "variants": loads_of, "warnings": warnings})
        return
    for name, loads in variants.items():
        _print_loads(name, loads)
        for warning in warnings[name]:
            click.echo(f"warning: {name}: {warning}", err=True)
    said = ", ".join(variants)
    click.echo(f"{file}: no problems found in {'variant' if len(variants) == 1 else 'variants'} {said}")


def _checked(file: str, names: tuple[str, ...]) -> tuple[dict[str, list[Any]], dict[str, list[str]]]:
    """By variant: the load of each station, and what may go wrong."""
    from opsim.plan import compile_plan, station_loads
    from opsim.plan.joins import wide_joins
    from opsim.plan.unread import unread
    from opsim.scenario import read_scenarios
    from opsim.scenario.risks import risks_of

    loaded = read_scenarios(file, list(names) or None)
    loads, warnings = {}, {}
    for name, variant in loaded.items():
        plan = compile_plan(variant)
        loads[name] = station_loads(plan)
        warnings[name] = [*_too_much(loads[name]), *risks_of(variant.scenario), *unread(plan), *wide_joins(plan)]
    return loads, warnings


def _too_much(loads: list[Any]) -> list[str]:
    return [
        f"{load.station} cannot keep up: {load.load:.0%} of its time is wanted"
        for load in loads
        if load.load is not None and load.load >= 1
    ]


def _print_loads(variant: str, loads: list[Any]) -> None:
    from opsim.cli.console import print_table

    columns = ("station", "servers", "work a visit", "visits a job", "most per h", "arrivals per h", "load")
    shown = loads if len(loads) <= MOST_ROWS else sorted(loads, key=_spare)[:MOST_ROWS]
    print_table(f"{variant}: load of the stations, from mean times", columns, [_cells(load) for load in shown])
    if len(loads) > MOST_ROWS:
        click.echo(f"{variant}: the {MOST_ROWS} busiest of {len(loads)} stations are shown; --json has them all\n")


def _spare(load: Any) -> float:
    """Small for the busiest: by load or, where release is saturated, by the jobs that can pass at most."""
    return load.most_per_h / load.visits if load.visits else float("inf")


def _cells(load: Any) -> tuple[str, ...]:
    return (
        load.station,
        str(load.servers),
        f"{load.work_s:.1f} s",
        f"{load.visits:.2f}",
        f"{load.most_per_h:.1f}",
        "saturated" if load.arrivals_per_h is None else f"{load.arrivals_per_h:.1f}",
        "–" if load.load is None else f"{load.load:.0%}",
    )
