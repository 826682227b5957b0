"""What stands in the tree, read as the schema reads it: quantities, whole numbers, blocks.

The way of a product as it stands in the tree: the stations of a route, or those of a routing by probability.

A name that is used must be the name of something.

The sources of a scenario as they stand in the tree: its one release, or each of its sources.

Mistakes of a CSV file that a scenario names, at their places in it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from pathlib import Path
from typing import TypeVar

from pydantic import ValidationError

from opsim import units
from opsim.csv_input import Mistake
from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.tree import Block, Node, Part, Place, Source, TreePath, child, entries, items, problem, text
from opsim.subjects.routes.words import OUT, START

Read = TypeVar("Read", bound=Block)
POINTS = ("stations", "stores", "conveyors")


def quantity(node: Node | None, kind: str) -> float | None:
    """A quantity in SI units, kind : of ``opsim.units``; None where nothing is said, or the schema refuses it."""
    try:
        return None if node is None else units.parse(node.value, kind)
    except units.UnitError:
        return None


def whole_number(node: Node | None) -> int | None:
    """A whole number; None where nothing is said, or the schema refuses it."""
    return node.value if node is not None and type(node.value) is int else None


def block_read(model: type[Read], node: Node) -> Read | None:
    """A block as the schema reads it; None where the schema refuses it."""
    try:
        return model.model_validate(node.plain())
    except ValidationError:
        return None


def visited(tree: Node) -> set[str]:
    """The stations that some product goes to, if only for rework."""
    on_a_way = {name for product in entries(tree, "products").values() for name in stations_of(product)}
    reworks = (rework_at(station) for name, station in entries(tree, "stations").items() if name in on_a_way)
    return on_a_way | {rework.value for rework in reworks if rework is not None}


def rework_at(station: Node | None) -> Node | None:
    """Where the rework of a station's inspection is named, or None."""
    rework = child(station, "inspect", "then", "rework")
    return rework if rework is not None and isinstance(rework.value, str) else None


def stations_of(product: Node) -> set[str]:
    """The stations that a product goes to, those with probability 0 too."""
    in_route = {name for step in items(product, "route") for name in one_of(step)}
    routing = entries(product, "routing")
    in_routing = {name for row in routing.values() for name, _ in onward(row)} | set(routing)
    return in_route | in_routing - {START, OUT}


def first_of(product: Node) -> list[str]:
    """The stations at which a product may begin."""
    start = child(product, "routing", START)
    first = next(iter(items(product, "route")), None)
    if start is not None:
        return [name for name, _ in onward(start)]
    return [] if first is None else one_of(first)


def one_of(step: Node) -> list[str]:
    """The stations of a step: one, or the ones of which one does it."""
    return [node.value for node in [step, *items(step)] if isinstance(node.value, str)]


def onward(row: Node) -> Iterator[tuple[str, Node]]:
    """Where a job goes from a station of a routing, each with the node that says so."""
    if isinstance(row.value, str):
        yield row.value, row
    for name, probability in entries(row).items():
        yield name, Node(name, probability.name_place)


def points(tree: Node) -> dict[str, Node]:
    """The points of the flow: stations, stores and conveyors, which share their names."""
    return {name: node for section in POINTS for name, node in entries(tree, section).items()}


def reference_problems(tree: Node) -> Iterator[Problem]:
    """Places, tasks, stations and libraries that are named and do not exist."""
    places, tasks, stations = entries(tree, "layout", "places"), entries(tree, "tasks"), entries(tree, "stations")
    for name, station in stations.items():
        yield from named(child(station, "at"), places, "place", ("stations", name, "at"))
        for number, task in enumerate(items(station, "tasks")):
            yield from named(task, tasks, "task", ("stations", name, "tasks", number))
    yield from path_problems(items(tree, "layout", "paths"), places, ("layout", "paths"))
    steps = points(tree)
    for name, product in entries(tree, "products").items():
        for number, step in enumerate(items(product, "route")):
            path = ("products", name, "route", number)
            for one in [step, *items(step)]:
                yield from named(one, steps, "station", path)
        yield from _routing(product, steps, ("products", name, "routing"))
    for name, worker in entries(tree, "workers").items():
        yield from named(child(worker, "home"), places, "place", ("workers", name, "home"))
        for skill, rating in entries(worker, "skills").items():
            yield from named(Node(skill, rating.name_place), stations, "station", ("workers", name, "skills", skill))
        for number, station in enumerate(items(worker, "patrol")):
            yield from named(station, stations, "station", ("workers", name, "patrol", number))
    yield from _libraries(tree)


def path_problems(ways: Iterable[Node], places: Collection[str], path: tuple[Part, ...]) -> Iterator[Problem]:
    """Places that paths or roads name and that do not exist."""
    for number, way in enumerate(ways):
        for place, node in enumerate(items(way)):
            yield from named(node, places, "place", (*path, number, place))
        for end in ("from", "to"):
            yield from named(child(way, end), places, "place", (*path, number, end))


def _routing(product: Node, stations: Collection[str], path: tuple[Part, ...]) -> Iterator[Problem]:
    """Stations that a routing leads to; a row of its own is named where jobs are sent to it."""
    known = {*stations, START, OUT}
    for name, row in entries(product, "routing").items():
        yield from named(Node(name, row.name_place), known, "station", (*path, name))
        for _, node in onward(row):
            yield from named(node, known, "station", (*path, name))


def _libraries(tree: Node) -> Iterator[Problem]:
    """Emulators, of tasks and of walking, that do not name a task of a library of the file."""
    libraries = entries(tree, "libraries")
    for path, model in emulators(tree):
        library, slash, inside = model.value.partition("/")
        if not (library and slash and inside):
            found = f"expected library/task, found {shown(model.value)}"
            hint = f"such as {next(iter(libraries), 'moves')}/{'walk' if path[0] == 'walking' else 'deep_squat'}"
            yield problem(model.place, path, found, hint)
        elif library not in libraries:
            hint = (
                did_you_mean(library, libraries)
                or "there are no libraries in this file: add 'libraries: {moves: FILE.npz}'"
            )
            yield problem(model.place, path, f"no library {shown(library)}", hint)


def emulators(tree: Node) -> Iterator[tuple[tuple[Part, ...], Node]]:
    """Where a scenario names an emulator as a text: in its tasks, in their motions, and for walking."""
    for name, task in entries(tree, "tasks").items():
        if text(task, "emulator") is not None:
            yield ("tasks", name, "emulator"), task.value["emulator"]
        yield from ((path, node) for path, _, node in motion_emulators(tree, name, task) if path[-1] != "walk")
    if text(tree, "walking", "emulator") is not None:
        yield ("walking", "emulator"), tree.value["walking"].value["emulator"]


def motion_emulators(tree: Node, name: str, task: Node) -> Iterator[tuple[tuple[Part, ...], str, Node]]:
    """(path, emulator, where it stands) of each motion of a task; of a walk, the emulator of walking."""
    for number, motion in enumerate(items(task, "motions")):
        path = ("tasks", name, "motions", number)
        if isinstance(motion.value, str):
            yield path, motion.value, motion
        elif (said := text(motion, "emulator")) is not None:
            yield (*path, "emulator"), said, motion.value["emulator"]
        elif child(motion, "walk") is not None and (walking := text(tree, "walking", "emulator")) is not None:
            yield (*path, "walk"), walking, motion.value["walk"]


def named(node: Node | None, known: Collection[str], what: str, path: tuple[Part, ...]) -> Iterator[Problem]:
    """The problem of one name, where it is a text and not known."""
    if node is not None and isinstance(node.value, str) and node.value not in known:
        hint = did_you_mean(node.value, known, otherwise=f"known {what}s") or f"there are no {what}s yet"
        yield problem(node.place, path, f"no {what} {shown(node.value)}", hint)


def releases(tree: Node) -> dict[TreePath, Node]:
    """Every source by its path."""
    one = child(tree, "release")
    found: dict[TreePath, Node] = {} if one is None else {("release",): one}
    return found | {("sources", name): node for name, node in entries(tree, "sources").items()}


def made_by(tree: Node, release: Node) -> list[str]:
    """The products that a source may make, as far as the tree says: those it names, else all."""
    in_order = [node.value for node in items(release, "sequence") if isinstance(node.value, str)]
    named = list(entries(release, "products")) or [
        node.value for node in items(release, "products") if isinstance(node.value, str)
    ]
    return list(dict.fromkeys(in_order)) or named or list(entries(tree, "products"))


def says_products(release: Node) -> bool:
    """Whether a source says itself what it makes."""
    return child(release, "products") is not None or child(release, "sequence") is not None


def in_the_file(file: Path, path: TreePath, mistakes: list[Mistake]) -> Iterator[Problem]:
    """Mistakes at their places in a CSV file; in a line with quotes at its beginning."""
    lines = file.read_text(encoding="utf-8-sig").splitlines() if mistakes else []
    mark = next((mark for mark in (",", ";", "\t") if lines and mark in lines[0]), ",")
    source = Source(str(file), tuple(lines))
    for one in mistakes:
        line = lines[one.line - 1]
        before = [] if '"' in line else line.split(mark)[: one.cell]
        column = sum(len(cell) + 1 for cell in before)
        yield problem(Place(source, one.line - 1, column), path, one.message, one.hint)
