"""A name that an override adds and nothing uses is most likely a slip of the pen.

Figures that a study names: of a worker, station, task or product that is there.

Stations, stores and conveyors are steps of the same routes: no two of them have one name.

The shares of what is released must sum to 1.

The files a scenario names: they exist, can be read, and hold what is asked of them.

Plug-ins that a scenario names: they are installed, can be used, and take what is said to them.

Changes of a layout that a study asks for: of stations and places that are there.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from opsim.csv_input import RecordedError, WrongRows, read_times, resolve_times
from opsim.engine.rules import ALLOCATION_RULES
from opsim.kpi.catalogue import KPIS, AskedFigure, read_asked, subject_of
from opsim.libraries import LibraryMissing, library_tasks, resolve_library
from opsim.problems import Problem, did_you_mean, nearest, shown
from opsim.scenario.checks.lookup import POINTS, emulators, in_the_file, releases, says_products, visited
from opsim.scenario.fields import Moved, read_any_moved, read_moved, to_sum_to_1
from opsim.scenario.tree import Node, Part, child, entries, items, problem, text
from opsim.subjects.breakdowns.checks import stop_times
from opsim.subjects.sequencing.checks import setup_times


def addition_problems(tree: Node, base: Node) -> Iterator[Problem]:
    """Places, levels, tasks and stations that are not in the base, are used by nobody, and read like one that is."""
    stations, workers = entries(tree, "stations").values(), entries(tree, "workers").values()
    places = {text(station, "at") for station in stations} | {text(worker, "home") for worker in workers}
    tasks = {task.value for station in stations for task in items(station, "tasks") if isinstance(task.value, str)}
    tasks |= {time.value for station in stations for time in setup_times(station) if isinstance(time.value, str)}
    hands = list(_hands(tree))
    yield from _unused(tree, base, ("layout", "places"), places | {place for place, _ in hands}, "place")
    yield from _unused(tree, base, ("tasks",), tasks, "task")
    yield from _unused(tree, base, ("stations",), visited(tree), "station")
    for name in entries(tree, "layout", "places"):
        levels = {level for place, level in hands if place == name}
        yield from _unused(tree, base, ("layout", "places", name, "levels"), levels, "level")


def _hands(tree: Node) -> Iterator[tuple[str, str]]:
    """(place, level) wherever hands go to one."""
    for task in entries(tree, "tasks").values():
        for hand in entries(task, "hands").values():
            for height in (hand, *entries(hand).values(), *items(hand, "layers")):
                place, _, level = (text(height) or "").partition(".")
                yield place.strip(), level.strip()


def _unused(tree: Node, base: Node, path: tuple[str, ...], used: Collection, what: str) -> Iterator[Problem]:
    known = entries(base, *path)
    for name, node in entries(tree, *path).items():
        near = nearest(name, known) if name not in known and name not in used else None
        if near is not None:
            found = f"this adds a {what} {shown(name)} that nothing uses"
            yield problem(node.name_place, (*path, name), found, f"did you mean {shown(near)}?")


SECTION_OF = {
    "worker": "workers",
    "station": "stations",
    "task": "tasks",
    "product": "products",
    "store": "stores",
    "conveyor": "conveyors",
    "line": "lines",
    "tool": "tools",
}
_COMPARED = re.compile("[<>]=?|=")
NOT_ONE = ("none", "worst")
"""Subjects that are no thing by name: nobody, and whoever has most of it."""


def figure_problems(node: Node, known: Mapping[str, Collection[str]], path: tuple[Part, ...]) -> Iterator[Problem]:
    """Of a text that names a figure, alone or with a limit behind it; what the schema refuses is passed over.

    known : names of the things of each section, in any variant
    """
    if not isinstance(node.value, str):
        return
    asked = read_asked(_COMPARED.split(node.value)[0])
    section = SECTION_OF.get(subject_of(asked.kpi), "")
    if asked.kpi not in KPIS or not section:
        return
    yield from _subject_problems(node, asked, known.get(section, ()), path)


def _subject_problems(
    node: Node, asked: AskedFigure, names: Collection[str], path: tuple[Part, ...]
) -> Iterator[Problem]:
    kind = subject_of(asked.kpi)
    if asked.subject and asked.subject not in (*names, *NOT_ONE):
        hint = did_you_mean(asked.subject, names, otherwise=f"known {kind}s") or f"there are no {kind}s in this file"
        yield problem(node.place, path, f"{asked.name}: no {kind} {shown(asked.subject)}", hint)


def point_problems(tree: Node) -> Iterator[Problem]:
    """Names that stand in two of the sections."""
    section_of: dict[str, str] = {}
    for section in POINTS:
        for name, node in entries(tree, section).items():
            other = section_of.setdefault(name, section)
            if other != section:
                found = f"{shown(name)} is the name of one of the {other} too"
                yield problem(node.name_place, (section, name), found, "a route could not tell them apart")


def material_problems(tree: Node) -> Iterator[Problem]:
    """The shares of the products sum to 1, where a source goes by them; one left out counts as 1."""
    if not any(_by_shares(release) for release in releases(tree).values()):
        return
    products = entries(tree, "products")
    nodes = [child(product, "share") for product in products.values()]
    shares = [1.0 if node is None else node.value for node in nodes]
    if not shares or not all(
        isinstance(s, int | float) and not isinstance(s, bool) and math.isfinite(s) for s in shares
    ):
        return
    total = math.fsum(shares)
    if abs(total - 1.0) > 1e-6:
        unsaid = [name for name, node in zip(products, nodes) if node is None]
        hint = f"{unsaid[0]} has no share, which counts as 1" if unsaid and len(products) > 1 else to_sum_to_1(total)
        place = tree.value["products"].name_place
        yield problem(place, ("products",), f"the shares sum to {total:g}; they must sum to 1", hint)


def _by_shares(release: Node) -> bool:
    """Whether a source makes every product by its share."""
    return not says_products(release) and text(release, "kind") not in ("schedule", "base_stock")


def file_problems(tree: Node, folder: Path) -> Iterator[Problem]:
    """Libraries that are missing or broken, tasks they do not have, recorded times that cannot be read."""
    tasks_of: dict[str, list[str]] = {}
    for name, node in entries(tree, "libraries").items():
        if not isinstance(node.value, str):
            continue
        try:
            tasks_of[name] = library_tasks(resolve_library(node.value, folder))
        except LibraryMissing as error:
            yield problem(node.place, ("libraries", name), error.message, error.hint)
    for path, model in emulators(tree):
        library, _, inside = model.value.partition("/")
        if inside and library in tasks_of and inside not in tasks_of[library]:
            hint = did_you_mean(inside, tasks_of[library], otherwise="tasks in it")
            yield problem(model.place, path, f"no task {shown(inside)} in library {shown(library)}", hint)
    for name, task in entries(tree, "tasks").items():
        yield from _recorded(task, ("tasks", name), folder)
    for path, release in releases(tree).items():
        gap = child(release, "every")
        if gap is not None:
            yield from _recorded(gap, (*path, "every"), folder)
    for path, time in stop_times(tree):
        yield from _recorded(time, path, folder)


def _recorded(model: Node, path: tuple[Part, ...], folder: Path) -> Iterator[Problem]:
    """What is wrong with a file of recorded times."""
    file = text(model, "recorded")
    if file is None:
        return
    try:
        read_times(resolve_times(file, folder), text(model, "column"))
    except WrongRows as error:
        yield from in_the_file(folder / file, (*path, "recorded"), error.mistakes)
    except RecordedError as error:
        yield problem(model.value["recorded"].place, (*path, "recorded"), error.message, error.hint)


def plugin_problems(tree: Node) -> Iterator[Problem]:
    """What is wrong with tasks that say ``plugin`` and with an allocation rule that is none of ours."""
    for name, task in entries(tree, "tasks").items():
        if text(task, "plugin"):
            yield from _emulator(task, ("tasks", name))
    rule = child(tree, "allocation", "rule")
    if rule is not None and isinstance(rule.value, str) and rule.value not in ALLOCATION_RULES:
        yield from _rule(rule)


def _emulator(task: Node, path: tuple[str, ...]) -> Iterator[Problem]:
    from opsim.plugins import plugin_problems as problems_of

    said = child(task, "with")
    values = said.plain() if said is not None and isinstance(said.value, dict) else {}
    for key, message, hint in problems_of(text(task, "plugin") or "", values):
        node, where = child(said, key), (*path, "with", key)
        if node is None:
            node, where = task.value["plugin"], (*path, "plugin")
        yield problem(node.place, where, message, hint)


def _rule(rule: Node) -> Iterator[Problem]:
    from opsim.plugins import NoSuchPlugin, PluginError, dispatch_rule, plugins

    try:
        dispatch_rule(rule.value)
    except NoSuchPlugin:
        hint = did_you_mean(rule.value, {*ALLOCATION_RULES, *plugins("opsim.dispatch")}, otherwise="known rules")
        yield problem(rule.place, ("allocation", "rule"), f"no rule {shown(rule.value)}", hint)
    except PluginError as error:
        yield problem(rule.place, ("allocation", "rule"), str(error))


STATIONS, PLACES = "stations", "places"
_NAMED = {"move": (PLACES,), "swap": (STATIONS, STATIONS), "place": (STATIONS, PLACES), "add": ("", STATIONS, PLACES)}
"""What the names of a change are names of; "" of something new."""


def move_problems(
    nodes: Collection[Node], kind: str, known: Mapping[str, Collection[str]], path: tuple[Part, ...]
) -> Iterator[Problem]:
    """Of texts that each name a change; what the schema cannot read is passed over.

    kind : as the key says; "" where the texts begin with it. known : names by section; what is added counts from there
    """
    there = {section: {*names} for section, names in known.items()}
    for node in nodes:
        moved = _read(kind, node)
        if moved is None:
            continue
        for section, name in zip(_NAMED[moved.kind], moved.what):
            if not section:
                there[STATIONS].add(name)
            elif name not in there[section]:
                hint = did_you_mean(name, there[section], otherwise=f"known {section}")
                yield problem(node.place, path, f"{moved}: no {section[:-1]} {shown(name)}", hint)


def _read(kind: str, node: Node) -> Moved | None:
    try:
        return read_moved(kind, node.value) if kind else read_any_moved(node.value)
    except ValueError:
        return None
