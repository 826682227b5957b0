"""Where hands go: to heights that places have, at marks of their movement, as far as people were seen to reach."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from pydantic_core import PydanticCustomError

from opsim.libraries import (
    REFUSED,
    WRISTS,
    HandTarget,
    LibraryMissing,
    library_marks,
    library_skeletons,
    recorded_reach,
    resolve_library,
)
from opsim.problems import Problem, did_you_mean, nearest, shown
from opsim.scenario.checks.lookup import named, quantity, rework_at, stations_of
from opsim.scenario.fields import DEEPEST_M, HIGHEST_M
from opsim.scenario.tree import Node, Part, child, entries, items, problem, text
from opsim.subjects.sequencing.checks import setup_times
from opsim.subjects.tasks.checks import marks_of
from opsim.subjects.tasks.words import BY_PRODUCT, hand_height, hand_tag
from opsim.subjects.transport.words import SURFACE, Place

_KEYS = {field.alias or name for name, field in Place.model_fields.items()}


@dataclass(frozen=True, slots=True)
class Hand:
    """A target, and where its height was written: at the task, or at the level of a place."""

    target: HandTarget
    node: Node
    path: tuple[Part, ...]


def hand_problems(tree: Node, folder: Path) -> Iterator[Problem]:
    """Marks, products, places and levels that are not there, bodies without wrists, and targets that nobody was seen to
    reach."""
    yield from _one_height(tree)
    for name, task in entries(tree, "tasks").items():
        said = entries(task, "hands")
        if said and text(task, "emulator") is not None:
            wrong = [
                *_marks(tree, name, task, folder),
                *_products(tree, name, said),
                *_levels(tree, name, said),
                *_wrists(tree, name, task, folder),
            ]
            yield from wrong
            if not wrong:
                yield from _beyond(tree, name, task, folder)


def _marks(tree: Node, name: str, task: Node, folder: Path) -> Iterator[Problem]:
    marks = marks_of(tree, task, folder)
    for said, node in entries(task, "hands").items() if marks is not None else ():
        assert marks is not None
        if said not in marks:
            found = f"no mark {shown(said)} in this movement" if marks else "this movement has no marks"
            hint = did_you_mean(said, marks, otherwise="its marks") or "take one that has some, or remove 'hands'"
            yield problem(node.name_place, ("tasks", name, "hands", said), found, hint)


def _one_height(tree: Node) -> Iterator[Problem]:
    """Set-ups, and forgetting, which remembers each task by itself, where a task's height changes."""
    hands = {name: entries(task, "hands").values() for name, task in entries(tree, "tasks").items()}
    varying = [name for name, nodes in hands.items() if any(isinstance(node.value, dict) for node in nodes)]
    forgetting = child(tree, "human", "forgetting")
    for name in varying if forgetting is not None and forgetting.value is not None else ():
        assert forgetting is not None
        found = f"the hands of {shown(name)} go to heights that change, and nobody knows what is forgotten of which"
        yield problem(forgetting.name_place, ("human", "forgetting"), found, "remove it, or take one height")
    for name, station in entries(tree, "stations").items():
        for time in setup_times(station):
            if time.value in varying:
                found = f"the hands of {shown(time.value)} go to heights that change"
                yield problem(time.place, ("stations", name, "setup"), found, "take a task with one height")


def _products(tree: Node, name: str, hands: dict[str, Node]) -> Iterator[Problem]:
    """Of heights by product, products that are not there, and those that come to the task and are left out."""
    products, stations = entries(tree, "products"), entries(tree, "stations")
    at = {key for key, one in stations.items() if any(task.value == name for task in items(one, "tasks"))}
    for mark, node in hands.items():
        if not isinstance(node.value, dict) or hand_tag(_plain(node)) != BY_PRODUCT:
            continue
        said, path = entries(node), ("tasks", name, "hands", mark)
        for product, height in said.items():
            yield from named(Node(product, height.name_place), products, "product", (*path, product))
        coming = [product for product, one in products.items() if at & _reached(tree, one)]
        lacking = [product for product in coming if product not in said]
        near = {nearest(product, lacking) for product in said if product not in products}
        for product in (one for one in lacking if one not in near):  # a mistyped product is one mistake, not two
            found = f"nothing says where hands go for {shown(product)}"
            yield problem(node.name_place, path, found, f"add e.g. '{product}: {_first_height(said)}'")


def _reached(tree: Node, product: Node) -> set[str]:
    """The stations that a product comes to, for rework too."""
    found = stations_of(product)
    reworks = (rework_at(child(tree, "stations", station)) for station in found)
    return found | {rework.value for rework in reworks if rework is not None}


def _first_height(said: dict[str, Node]) -> str:
    return next((node.value for node in said.values() if isinstance(node.value, str)), "rack.low")


def _plain(node: Node) -> object:
    """A node's value, a block's with the values that stand in it."""
    return {key: one.value for key, one in entries(node).items()} if isinstance(node.value, dict) else node.value


def _heights_said(hands: dict[str, Node]) -> Iterator[tuple[str, Node, tuple[Part, ...]]]:
    """(mark, height, its path below ``hands``) of every height: the one at a mark, those by product, and of layers."""
    for mark, node in hands.items():
        if not isinstance(node.value, dict):
            yield mark, node, (mark,)
        elif hand_tag(_plain(node)) == BY_PRODUCT:
            yield from ((mark, one, (mark, product)) for product, one in entries(node).items())
        else:
            yield from ((mark, one, (mark, "layers", at)) for at, one in enumerate(items(node, "layers")))


def _levels(tree: Node, name: str, hands: dict[str, Node]) -> Iterator[Problem]:
    """Places without such a height; what the schema refuses is passed over."""
    places = entries(tree, "layout", "places")
    for _, node, below in _heights_said(hands):
        height, path = _height(node), ("tasks", name, "hands", *below)
        if not isinstance(height, tuple):
            continue
        place, level = height
        heights = _heights(places.get(place))
        if place not in places:
            hint = did_you_mean(place, places, otherwise="known places")
            yield problem(node.place, path, f"no place {shown(place)}", hint)
        elif not heights and entries(places[place]).keys() <= _KEYS:
            hint = f"such as {place}: {{at: [9 m, 1 m], levels: {{{level}: 0.3 m}}}}"
            yield problem(node.place, path, f"the place {shown(place)} has no heights", hint)
        elif heights and level not in heights:
            hint = did_you_mean(level, heights, otherwise="its heights")
            yield problem(node.place, path, f"no height {shown(level)} at the place {shown(place)}", hint)


def _wrists(tree: Node, name: str, task: Node, folder: Path) -> Iterator[Problem]:
    """A body whose hands nobody knows."""
    library, _, inside = (text(task, "emulator") or "").partition("/")
    try:
        file = resolve_library(text(tree, "libraries", library) or "", folder)
        joints, _ = library_skeletons(file).get(inside, (WRISTS, ()))
    except LibraryMissing:  # a problem of its own
        return
    lacking = [joint for joint in WRISTS if joint not in joints]
    if lacking:
        found = f"the bodies of {shown(text(task, 'emulator'))} have no {' and no '.join(lacking)}"
        yield problem(task.value["hands"].name_place, ("tasks", name, "hands"), found, "take another emulator")


def _beyond(tree: Node, name: str, task: Node, folder: Path) -> Iterator[Problem]:
    """Targets that lie too far from all that was recorded, said where their heights stand."""
    library, _, inside = (text(task, "emulator") or "").partition("/")
    try:
        file = resolve_library(text(tree, "libraries", library) or "", folder)
        if inside not in library_marks(file):
            return
        for hand in hands_of(tree, name, task):
            word, sentence = recorded_reach(file, inside, hand.target)
            if word == REFUSED:
                yield problem(hand.node.place, hand.path, f"tasks.{name}: {sentence}")
    except LibraryMissing:  # a problem of its own
        return
    except ValueError as error:
        yield problem(task.value["hands"].name_place, ("tasks", name, "hands"), str(error), "remove 'hands'")


def hands_of(tree: Node, name: str, task: Node) -> list[Hand]:
    """The targets of a task whose words are right; what the schema refuses is left out."""
    places = entries(tree, "layout", "places")
    found = []
    for mark, node, below in _heights_said(entries(task, "hands")):
        height, path = _height(node), ("tasks", name, "hands", *below)
        if isinstance(height, float):
            found.append(Hand(HandTarget(mark, height), node, path))
        elif height is not None:
            place, level = height
            written = _heights(places[place]).get(level)
            height_m, depth_m = _metres(written), _metres(child(places[place], "depth"), DEEPEST_M)
            if written is not None and height_m is not None:
                path = ("layout", "places", place, *((SURFACE,) if level == SURFACE else ("levels", level)))
                found.append(Hand(HandTarget(mark, height_m, depth_m), written, path))
    return found


def _heights(place: Node | None) -> dict[str, Node]:
    """Where the heights of a place stand, by name."""
    surface = child(place, SURFACE)
    return entries(place, "levels") | ({} if surface is None else {SURFACE: surface})


def _height(node: Node) -> float | tuple[str, str] | None:
    try:
        return hand_height(node.value)
    except PydanticCustomError:
        return None


def _metres(node: Node | None, most_m: float = HIGHEST_M) -> float | None:
    """None where nothing is said, or the schema refuses it."""
    found_m = quantity(node, "length")
    return found_m if found_m is not None and 0 <= found_m <= most_m else None
