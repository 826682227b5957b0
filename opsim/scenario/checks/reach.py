"""Where hands go: to heights that places have, at marks of their movement, as far as people were seen to reach."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from pydantic_core import PydanticCustomError

from opsim import units
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
from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.checks.motions import marks_of
from opsim.scenario.fields import DEEPEST_M, HIGHEST_M
from opsim.scenario.schema.layout import SURFACE, Place
from opsim.scenario.schema.task_block import hand_height
from opsim.scenario.tree import Node, Part, child, entries, problem, text

_KEYS = {field.alias or name for name, field in Place.model_fields.items()}


@dataclass(frozen=True, slots=True)
class Hand:
    """A target, and where its height was written: at the task, or at the level of a place."""

    target: HandTarget
    node: Node
    path: tuple[Part, ...]


def hand_problems(tree: Node, folder: Path) -> Iterator[Problem]:
    """Marks, places and levels that are not there, bodies without wrists, and targets that nobody was seen to reach."""
    for name, task in entries(tree, "tasks").items():
        said = entries(task, "hands")
        if said and text(task, "emulator") is not None:
            wrong = [*_marks(tree, name, task, folder), *_levels(tree, name, said), *_wrists(tree, name, task, folder)]
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


def _levels(tree: Node, name: str, hands: dict[str, Node]) -> Iterator[Problem]:
    """Places without such a height; what the schema refuses is passed over."""
    places = entries(tree, "layout", "places")
    for mark, node in hands.items():
        height, path = _height(node), ("tasks", name, "hands", mark)
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
    for mark, node in entries(task, "hands").items():
        height, path = _height(node), ("tasks", name, "hands", mark)
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
    try:
        found_m = None if node is None else units.parse(node.value, "length")
    except units.UnitError:
        return None
    return found_m if found_m is not None and 0 <= found_m <= most_m else None
