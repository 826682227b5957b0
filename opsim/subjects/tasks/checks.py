"""Tasks of several motions: their skeletons are one, and who walks in them has a way to walk.

The marks that the movement of a task has, found without loading it.

The emulator of ``walking:``: one of walking at all, and for people as fast and as slow as the workers.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from opsim.libraries import (
    LibraryMissing,
    library_marks,
    library_skeletons,
    library_speeds,
    library_tasks,
    resolve_library,
)
from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.checks.lookup import motion_emulators, quantity
from opsim.scenario.tree import Node, Part, child, entries, items, problem, text
from opsim.subjects.people.words import Person


def motion_problems(tree: Node, folder: Path) -> Iterator[Problem]:
    """Walks where nothing says how people walk, and motions of bodies with other joints than the first one's."""
    for name, task in entries(tree, "tasks").items():
        for number, motion in enumerate(items(task, "motions")):
            walk = child(motion, "walk")
            if walk is not None and child(tree, "walking") is None:
                path, hint = (
                    ("tasks", name, "motions", number, "walk"),
                    "add 'walking: {emulator: walking/walk}' to the file",
                )
                yield problem(walk.name_place, path, "nothing says how people walk", f"{hint}, and its library")
        yield from _one_skeleton(tree, name, task, folder)


def _one_skeleton(tree: Node, name: str, task: Node, folder: Path) -> Iterator[Problem]:
    """Motions whose joints are not those of the first motion that is known."""
    first: tuple[str, tuple[tuple[str, ...], tuple[int, ...]]] | None = None
    for path, model, node in motion_emulators(tree, name, task):
        skeleton = _skeleton(tree, model, folder)
        if skeleton is None:
            continue
        if first is None:
            first = model, skeleton
        elif skeleton != first[1]:
            found = f"{shown(model)} has {_difference(first[1][0], skeleton[0])}, unlike {shown(first[0])}"
            yield problem(node.place, path, found, "motions of one task are of one skeleton")


def _skeleton(tree: Node, model: str, folder: Path) -> tuple[tuple[str, ...], tuple[int, ...]] | None:
    """Joints and parents behind an emulator, or None where they cannot be known; that is a problem of its own."""
    library, _, inside = model.partition("/")
    file = text(tree, "libraries", library)
    if file is None:
        return None
    try:
        return library_skeletons(resolve_library(file, folder)).get(inside)
    except LibraryMissing:
        return None


def _difference(one: tuple[str, ...], other: tuple[str, ...]) -> str:
    """How the second skeleton's joints differ from the first's, in words."""
    parts = (("no", [j for j in one if j not in other]), ("also", [j for j in other if j not in one]))
    said = [f"{word} {', '.join(names[:4])}{' and more' if len(names) > 4 else ''}" for word, names in parts if names]
    return " and ".join(said) or "the same joints, hung together in another way"


WALK = "walk"
MOMENTS = ("from", "to")


def moment_problems(tree: Node, task: Node, path: tuple[Part, ...], folder: Path) -> Iterator[Problem]:
    """Moments of ``hold`` or ``loaded`` that are names: of a movement without such a mark, or in the wrong order."""
    said = {key: node for key in MOMENTS if (node := child(task, path[-1], key)) is not None}
    names = {key: node for key, node in said.items() if isinstance(node.value, str)}
    marks = marks_of(tree, task, folder) if names else None
    if marks is None:
        return
    for key, node in names.items():
        if node.value not in marks:
            hint = did_you_mean(node.value, marks, otherwise="its marks") or "say it as a share, such as 0.25"
            found = f"no mark {shown(node.value)} in this movement" if marks else "this task has no marks"
            yield problem(node.place, (*path, key), found, hint)
    both = [marks.index(node.value) for node in names.values() if node.value in marks]
    if len(both) == 2 and both[0] > both[1]:
        yield problem(names["to"].place, (*path, "to"), f"{names['to'].value} comes before {names['from'].value}")


def marks_of(tree: Node, task: Node, folder: Path) -> list[str] | None:
    """Names of marks, in order; empty for a time without a body, None where they cannot be known here."""
    emulator = text(task, "emulator")
    if emulator is not None:
        return _of_emulator(tree, emulator, folder)
    if child(task, "motions") is not None:
        return _of_motions(tree, task, folder)
    return _of_plugin(task) if text(task, "plugin") else []


def _of_emulator(tree: Node, emulator: str, folder: Path) -> list[str] | None:
    library, _, inside = emulator.partition("/")
    file = text(tree, "libraries", library)
    if file is None:
        return None
    try:
        marks = library_marks(resolve_library(file, folder)).get(inside)
    except LibraryMissing:  # a problem of its own
        return None
    return None if marks is None else list(marks)


def _of_motions(tree: Node, task: Node, folder: Path) -> list[str] | None:
    """``reach.touch``, ``fasten.2.start``: as the emulator of many motions calls them."""
    parts: list[tuple[str, list[str]]] = []
    for path, model, _ in motion_emulators(tree, "", task):
        marks = _of_emulator(tree, model, folder)
        if marks is None:
            return None
        motion = task.value["motions"].value[path[3]]
        repeat = child(motion, "repeat")
        times = repeat.value if repeat is not None and type(repeat.value) is int else 1
        parts += [(WALK if path[-1] == "walk" else model.partition("/")[2], marks)] * times
    counts, seen, named = Counter(name for name, _ in parts), Counter[str](), []
    for name, marks in parts:
        seen[name] += 1
        label = name if counts[name] == 1 else f"{name}.{seen[name]}"
        named += [f"{label}.{mark}" for mark in marks]
    return named


def _of_plugin(task: Node) -> list[str] | None:
    """What a plug-in's model says; nothing is known where it cannot be made, which is a problem of its own."""
    from opsim.plugins import PluginError, plugin_model

    said = child(task, "with")
    values = said.plain() if said is not None and isinstance(said.value, dict) else {}
    try:
        return list(getattr(plugin_model(text(task, "plugin") or "", values), "mark_names", ()))
    except (PluginError, ValueError, TypeError):
        return None


USUAL_M_PER_S = float(Person.model_fields["walk_m_per_s"].default)


def walking_emulator_problems(tree: Node, folder: Path) -> Iterator[Problem]:
    """A task that is no walking, and workers who walk faster or slower than the emulator can."""
    model = child(tree, "walking", "emulator")
    library, _, inside = (text(model) or "").partition("/")
    file = text(tree, "libraries", library) if inside else None
    if model is None or file is None:
        return
    try:
        path = resolve_library(file, folder)
        speeds, known = library_speeds(path), library_tasks(path)
    except LibraryMissing:  # a problem of its own, said where the library is named
        return
    if inside in speeds:
        yield from _speeds(tree, *speeds[inside])
    elif inside in known:
        hint = f"walking in it: {', '.join(speeds)}" if speeds else "the shipped libraries/walking.npz has one: walk"
        yield problem(model.place, ("walking", "emulator"), f"{shown(inside)} is not an emulator of walking", hint)


def _speeds(tree: Node, slowest: float, fastest: float) -> Iterator[Problem]:
    for name, worker in entries(tree, "workers").items():
        said = child(worker, "walk")
        speed = USUAL_M_PER_S if said is None else quantity(said, "speed")
        if speed is not None and not slowest <= speed <= fastest:
            found = f"people of {shown(text(tree, 'walking', 'emulator'))} cannot walk at {speed:g} m/s"
            place = worker.name_place if said is None else said.place
            hint = f"they walk at {slowest:g} to {fastest:g} m/s"
            yield problem(place, ("workers", name, "walk"), found, hint)
