"""``opsim check``: is the scenario right, can everything keep up, and what may lock? No run.

The tables of ``opsim check``: loads of stations, people and what is shared, and what limits the floor.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from opsim.cli.app import mistakes

if TYPE_CHECKING:
    from opsim.plan import Plan


@click.command("check")
@click.argument("file")
@click.option("--scenario", "names", multiple=True, metavar="NAME", help="Only this variant; may be given again.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(file: str, names: tuple[str, ...], as_json: bool) -> None:
    """Check a scenario FILE: schema, references, what may lock, and the load of stations, skills and all that is
    shared; and its studies: each value that is varied is laid over the scenario once. Exit code 2 where something is
    wrong.

    Loads are from mean times, with everybody's skill rating and pace. Stations and tools count the fastest who can do
    the work, so that their loads are at least what is shown; skills count each worker at his own speed."""
    from opsim.cli.app import print_json
    from opsim.threads import lean, without_collecting

    lean()
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
    from opsim.plan import compile_plan
    from opsim.plan.loads import loads_of, overloads
    from opsim.plan.warnings import hour_risks, risks_of
    from opsim.subjects.release.plan import late_orders
    from opsim.subjects.tasks.warnings import stretched, unmoved_bodies, unread, unseen, wide_joins

    loads, warnings, without = {}, {}, {}
    for name, variant in loaded.items():
        plan = compile_plan(variant)
        loads[name], without[name] = loads_of(plan), left_out(plan)
        warnings[name] = [*overloads(plan, loads[name]), *risks_of(variant.scenario), *late_orders(plan)]
        warnings[name] += [*hour_risks(plan, loads[name]), *unread(plan), *unmoved_bodies(plan), *wide_joins(plan)]
        warnings[name] += [*unseen(plan, variant.scenario.outputs), *stretched(plan)]
    return loads, warnings, without


def _read(file: str, names: tuple[str, ...]) -> dict[str, Any]:
    """The variants by name. Raises ScenarioError with what is wrong with them and with the studies of the file."""
    from opsim.problems import ScenarioError
    from opsim.scenario import read_scenarios
    from opsim.scenario.study_checks import study_problems

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


MOST_ROWS = 60
MOST_STATIONS, MOST_SKILLS = 30, 20
"""Rows, where there are more than ``MOST_ROWS``."""
NEXT = 2
"""Of what limits the floor after the bottleneck, so many are named."""


def print_loads(variant: str, loads: Any, without: str = "") -> None:
    """Everything that ``opsim check`` has found about a variant. without : what its mean times leave out, in words"""
    _print_stations(variant, loads.stations, loads.scheduled_share)
    _print_people(variant, loads.skills, loads.crew)
    _print_shared(variant, loads.shared)
    if loads.limits:
        first, *others = (_limit(one) for one in loads.limits[: NEXT + 1])
        rest = f"; next {', '.join(others)}" if others else ""
        click.echo(f"{variant}: bottleneck by mean times: {first}{rest}\n")
    if without:
        click.echo(f"{variant}: {without}\n")


def left_out(plan: Plan) -> str:
    """Effects on people that are on and that mean times know nothing of; nothing where none is."""
    from opsim.report.numbers import listing
    from opsim.subjects.human.plan import EFFECTS

    names = {"rest": "rest by need", "state_pace": "state-dependent pace", "circadian": "the time of day"}
    on = [names.get(effect, effect) for effect in EFFECTS if getattr(plan.human, effect) is not None]
    return f"these loads and this bottleneck are without {listing(on)} (on under 'human')" if on else ""


def _limit(one: Any) -> str:
    if one.most_per_scheduled_h is None:
        said = f"{one.most_per_h:.1f} jobs per h at most"
    else:
        said = (
            f"at most {one.most_per_scheduled_h:.1f} jobs per scheduled hour, {one.most_per_h:.1f} per hour of the run"
        )
    return f"{one.what} ({said})" if one.load is None else f"{one.what} ({_share(one.load)}, {said})"


def _share(load: float | None) -> str:
    """A load; of what never works, there is none."""
    if load is None:
        return "–"
    return f"{load:.0%}" if load < float("inf") else "never there"


def _print_stations(variant: str, loads: list[Any], scheduled_share: float | None) -> None:
    from opsim.cli.app import print_table

    setups, stops = any(load.setup_s for load in loads), any(load.up < 1 for load in loads)
    hours = any(load.hours < 1 for load in loads)
    more = (*(("set-up",) if setups else ()), *(("up",) if stops else ()), *(("hours",) if hours else ()))
    columns = ("station", "servers", "work a visit", *more, "visits a job", "most per h", "arrivals per h", "load")
    shown = loads if len(loads) <= MOST_ROWS else sorted(loads, key=_spare)[:MOST_STATIONS]
    rows = [_cells(load, setups, stops, hours) for load in shown]
    title = f"{variant}: load of the stations at least, from mean times of the fastest who can"
    print_table(f"{title}{_of_hours(scheduled_share)}", columns, rows)
    if len(loads) > MOST_ROWS:
        click.echo(f"{variant}: the {MOST_STATIONS} busiest of {len(loads)} stations are shown; --json has them all\n")


def _of_hours(scheduled_share: float | None) -> str:
    """Which hours the table means, where the floor keeps some."""
    if scheduled_share is None:
        return ""
    return f"; per h: of the run, for {scheduled_share:.1%} of which the floor is scheduled to be open"


def _spare(load: Any) -> float:
    """Small for the busiest: by load or, where release is saturated, by the jobs that can pass at most."""
    return load.most_per_h / load.visits if load.visits else float("inf")


def _cells(load: Any, setups: bool, stops: bool, hours: bool) -> tuple[str, ...]:
    return (
        load.station,
        str(load.servers) if load.servers else "–",
        f"{load.work_s:.1f} s",
        *((f"{load.setup_s:.1f} s",) if setups else ()),
        *((f"{load.up:.1%}",) if stops else ()),
        *((f"{load.hours:.1%}",) if hours else ()),
        f"{load.visits:.2f}" if load.visits or not load.arrivals_per_h else "–",  # of sources beside a saturated one
        f"{load.most_per_h:.1f}" if load.most_per_h < float("inf") else "–",
        "saturated" if load.arrivals_per_h is None else f"{load.arrivals_per_h:.1f}",
        _share(load.load),
    )


def _print_people(variant: str, skills: Any, crew: Any) -> None:
    from opsim.cli.app import print_table

    if not skills:
        return
    rated = any(load.load is not None for load in skills)
    shown = skills if len(skills) <= MOST_ROWS else sorted(skills, key=lambda load: -load.wanted / max(1, load.able))
    shown = shown if len(skills) <= MOST_ROWS else shown[:MOST_SKILLS]
    hours = any(load.there < load.able for load in skills)
    there = ("at work",) if hours else ()
    columns = ("skill", "workers", *there, "work a visit", *(("wanted", "load") if rated else ()))
    rows = [_skill_cells(load, rated, hours) for load in shown]
    print_table(f"{variant}: load of the skills, from everybody's own mean times, walks not counted", columns, rows)
    if crew is not None and rated:
        who = f"{len(crew.workers)} workers" if len(crew.workers) > 1 else crew.workers[0]
        more = "" if crew.with_overtime is None else f", {crew.with_overtime:.0%} with all overtime"
        where = ", ".join(crew.skills[:6]) + (" and others" if len(crew.skills) > 6 else "")
        click.echo(
            f"{variant}: shared as evenly as can be, work takes {crew.share:.0%} of the time of {who} ({where}){more}\n"
        )


def _skill_cells(load: Any, rated: bool, hours: bool) -> tuple[str, ...]:
    wanted = (f"{load.wanted:.2f}", _share(load.load)) if rated else ()
    there = (f"{load.there:.2f}",) if hours else ()
    return (load.skill, str(load.able), *there, f"{load.work_s:.1f} s", *wanted)


def _print_shared(variant: str, shared: list[Any]) -> None:
    from opsim.cli.app import print_table

    if shared:
        rows = [
            (load.name, load.what, str(load.n), "–" if load.load is None else f"{load.load:.0%}") for load in shared
        ]
        print_table(f"{variant}: load of what is shared, at least", ("name", "what", "there are", "load"), rows)
