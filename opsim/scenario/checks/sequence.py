"""Mistakes of rules (dispatch, routing, pre-emption), set-ups, stops, and teams of several people at one task."""

from __future__ import annotations

import math
from collections.abc import Iterator

from pydantic import ValidationError

from opsim.engine.rules import BY_DUE_DATE, ROUTING_RULES, SEQUENCING_RULES
from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.checks.lookup import stations_of, visited
from opsim.scenario.schema.tasks import Maintenance
from opsim.scenario.tree import Node, Part, Place, child, entries, items, problem, text
from opsim.units import UnitError, parse


def sequence_problems(tree: Node) -> Iterator[Problem]:
    """What is wrong with ``flow``, and with dispatch, preempt and setup of stations."""
    stations = entries(tree, "stations")
    asked: dict[tuple[Part, ...], Node | None] = {("flow", "dispatch"): child(tree, "flow", "dispatch")}
    asked |= {("stations", name, "dispatch"): child(station, "dispatch") for name, station in stations.items()}
    for path, rule in asked.items():
        yield from rule_problems(rule, path, "opsim.sequencing", SEQUENCING_RULES)
        if rule is not None and rule.value in BY_DUE_DATE and not _has_due_dates(tree):
            hint = "give a product one, such as 'due: 4 h', or a schedule with a column due"
            yield problem(rule.place, path, f"{rule.value} goes by due dates, and no job has one", hint)
    yield from rule_problems(child(tree, "flow", "routing"), ("flow", "routing"), "opsim.routing", ROUTING_RULES)
    for name, station in stations.items():
        yield from _preempt(station, ("stations", name))
        yield from batch_before_problems(tree, station, ("stations", name))
        yield from _setup(tree, name, child(station, "setup"))


def setup_times(station: Node) -> list[Node]:
    """What a station's set-ups take: times, and names of tasks."""
    times = [time for row in entries(station, "setup", "times").values() for time in entries(row).values()]
    otherwise = child(station, "setup", "otherwise")
    return times if otherwise is None else [*times, otherwise]


def rule_problems(rule: Node | None, path: tuple[Part, ...], group: str, ours: dict) -> Iterator[Problem]:
    """A rule that is none of ours, and no plug-in that can be used."""
    if rule is None or not isinstance(rule.value, str) or rule.value in ours:
        return
    from opsim.plugins import NoSuchPlugin, PluginError, plugins, rule_of

    try:
        rule_of(group, rule.value)
    except NoSuchPlugin:
        hint = did_you_mean(rule.value, {*ours, *plugins(group)}, otherwise="known rules")
        yield problem(rule.place, path, f"no rule {shown(rule.value)}", hint)
    except PluginError as error:
        yield problem(rule.place, path, str(error))


def _has_due_dates(tree: Node) -> bool:
    sources = [child(tree, "release"), *entries(tree, "sources").values()]
    by_schedule = any(text(source, "kind") == "schedule" for source in sources)
    return by_schedule or any(child(product, "due") is not None for product in entries(tree, "products").values())


def _preempt(station: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    preempt, buffer = child(station, "preempt"), child(station, "buffer")
    if preempt is None:
        return
    if buffer is not None and buffer.value == 0 and not isinstance(buffer.value, bool):
        found = "nothing is ever pre-empted where no job can wait: it would have no place to go"
        yield problem(preempt.place, (*path, "preempt"), found, "give the station a buffer, or remove 'preempt'")
    if child(station, "batch") is not None:
        found = "the jobs of a batch are not pre-empted"
        yield problem(preempt.place, (*path, "preempt"), found, "remove 'preempt', or 'batch'")


def batch_before_problems(tree: Node, station: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    """A batch would begin when its first job has a place downstream; the others would wait after all."""
    batch, own, of_all = child(station, "batch"), child(station, "blocking"), child(tree, "flow", "blocking")
    blocking = of_all if own is None else own
    if batch is not None and blocking is not None and blocking.value == "before":
        found = "the jobs of a batch go on one by one, and cannot all be sure of a place before it begins"
        yield problem(batch.name_place, (*path, "batch"), found, "write 'blocking: after' at this station")


def _setup(tree: Node, name: str, setup: Node | None) -> Iterator[Problem]:
    if setup is None or not entries(setup):
        return
    path = ("stations", name, "setup")
    families = text(setup, "by") == "family"
    known, here = _classes(tree, families, None), _classes(tree, families, name)
    named = list(_named(setup, path))
    for word, node, where in named:
        if word not in known:
            what = "family" if families else "product"
            yield problem(node, where, f"no {what} {shown(word)}", did_you_mean(word, known))
    for last, row in entries(setup, "times").items():
        for new, time in entries(row).items():
            yield from _task(tree, time, (*path, "times", last, new))
    yield from _task(tree, child(setup, "otherwise"), (*path, "otherwise"))
    if child(setup, "otherwise") is None and all(word in known for word, _, _ in named):
        yield from _gaps(setup, here, path)


def _named(setup: Node, path: tuple[str, ...]) -> Iterator[tuple[str, Place, tuple[str, ...]]]:
    """Products or families that a set-up names, each with its place and path."""
    first = child(setup, "first")
    if first is not None and isinstance(first.value, str):
        yield first.value, first.place, (*path, "first")
    for last, row in entries(setup, "times").items():
        yield last, row.name_place, (*path, "times", last)
        for new, time in entries(row).items():
            yield new, time.name_place, (*path, "times", last, new)


def _gaps(setup: Node, here: list[str], path: tuple[str, ...]) -> Iterator[Problem]:
    """Changes that happen here and that nothing is said of."""
    times, first = entries(setup, "times"), text(setup, "first")
    gaps = [
        (a, b)
        for a in dict.fromkeys([*here, first or here[0]] if here else [])
        for b in here
        if a != b and b not in entries(times.get(a))
    ]
    if gaps:
        last, new = gaps[0]
        more = f" (and of {len(gaps) - 1} other changes)" if len(gaps) > 1 else ""
        found = f"nothing says how long the set-up from {shown(last)} to {shown(new)} takes{more}"
        yield problem(setup.name_place, path, found, "add it to times, or e.g. 'otherwise: 10 min'")


def _task(tree: Node, time: Node | None, path: tuple[Part, ...]) -> Iterator[Problem]:
    """The name of a task that does not exist; what begins with a digit is a time."""
    if time is None or not isinstance(time.value, str) or not time.value[:1].isalpha():
        return
    tasks = entries(tree, "tasks")
    if time.value not in tasks:
        hint = did_you_mean(time.value, tasks, otherwise="a time such as 5 min, or one of the tasks")
        yield problem(time.place, path, f"no task {shown(time.value)}", hint)


def _classes(tree: Node, families: bool, station: str | None) -> list[str]:
    """What set-ups tell apart, of all products or of those that come to a station: products, or their families."""
    found = {
        (text(product, "family") if families else None) or name: None
        for name, product in entries(tree, "products").items()
        if station is None or station in stations_of(product)
    }
    return list(found)


KINDS = ("breakdowns", "maintenance")


def failure_problems(tree: Node) -> Iterator[Problem]:
    """Teams that do not exist, two stops of one name, maintenance that takes all the time there is."""
    for name, station in entries(tree, "stations").items():
        path = ("stations", name)
        for kind in KINDS:
            for stop, node in entries(station, kind).items():
                yield from _team(tree, node, (*path, kind, stop))
        if child(station, "maintenance") is not None:
            yield from _one_name(station, path)
            yield from _time_left(tree, station, path)


def stop_times(tree: Node) -> Iterator[tuple[tuple[Part, ...], Node]]:
    """Where times stand in the stops of stations, each with its path."""
    for name, station in entries(tree, "stations").items():
        for kind in KINDS:
            for stop, node in entries(station, kind).items():
                for key in ("every", "repair", "lasts"):
                    time = child(node, key)
                    if time is not None:
                        yield ("stations", name, kind, stop, key), time


def _team(tree: Node, stop: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    team, known = child(stop, "team"), entries(tree, "repair_teams")
    if team is not None and isinstance(team.value, str) and team.value not in known:
        hint = did_you_mean(team.value, known, otherwise="known teams")
        hint = hint or f"add a section 'repair_teams: {{{team.value}: {{n: 1}}}}'"
        yield problem(team.place, (*path, "team"), f"no repair team {shown(team.value)}", hint)


def _one_name(station: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    for name, node in entries(station, "maintenance").items():
        if name in entries(station, "breakdowns"):
            found = f"a breakdown of this station is called {shown(name)} as well"
            yield problem(node.name_place, (*path, "maintenance", name), found, "figures go by these names: change one")


def _time_left(tree: Node, station: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    """A stop that outlasts the run, and stops that together take all the time."""
    horizon_s = _seconds(child(tree, "run", "horizon"))
    share = 0.0
    for name, node in entries(station, "maintenance").items():
        read = _read(node)
        if read is None or read.lasts_s is None:
            continue
        share += read.lasts_s / read.every_s
        if read.lasts_s >= horizon_s:
            found = f"lasts {read.lasts_s:g} s, and the whole run only {horizon_s:g} s"
            place = node.value["lasts"].place
            yield problem(place, (*path, "maintenance", name, "lasts"), found, "make it shorter, or the run longer")
    if share >= 1 and len(entries(station, "maintenance")) > 1:
        found = f"these together take {share:.0%} of the time: the station would never work"
        node = station.value["maintenance"]
        yield problem(node.name_place, (*path, "maintenance"), found, "make them shorter, or rarer")


def _read(node: Node) -> Maintenance | None:
    """A maintenance as the schema reads it; None where the schema refuses it."""
    try:
        return Maintenance.model_validate(node.plain())
    except ValidationError:
        return None


def _seconds(node: Node | None) -> float:
    try:
        return math.inf if node is None else parse(node.value, "time")
    except UnitError:
        return math.inf


def team_problems(tree: Node) -> Iterator[Problem]:
    """Tasks for more workers than have the skill, and teams of people who serve only where they stand."""
    patrols, on_a_way = text(tree, "allocation", "idle") == "patrol", visited(tree)
    for name, station in entries(tree, "stations").items():
        team = _team_of(tree, station) if name in on_a_way else None
        if team is None:
            continue
        task, wanted = team
        able = [worker for worker, node in entries(tree, "workers").items() if name in entries(node, "skills")]
        if 0 < len(able) < wanted:  # nobody at all is told of elsewhere
            found = (
                f"task {shown(task)} takes a team of {wanted}, and only {len(able)} of the workers can work at {name}"
            )
            yield problem(
                station.name_place, ("stations", name), found, "give more workers the skill, or a smaller team"
            )
        if patrols:
            found = (
                f"task {shown(task)} takes a team, and workers who patrol serve each only the station where he stands"
            )
            yield problem(station.name_place, ("stations", name), found, "write 'idle: stay' or 'idle: home'")


def _team_of(tree: Node, station: Node) -> tuple[str, int] | None:
    """The task of a station for most workers, and how many; None where one is enough everywhere."""
    teams = []
    for node in items(station, "tasks"):
        size = child(tree, "tasks", node.value, "team") if isinstance(node.value, str) else None
        if size is not None and type(size.value) is int and size.value > 1:
            teams.append((node.value, size.value))
    return max(teams, key=lambda team: team[1], default=None)
