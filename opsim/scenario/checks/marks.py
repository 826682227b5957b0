"""The marks that the movement of a task has, found without loading it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from opsim.libraries import LibraryMissing, library_marks, resolve_library
from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.checks.references import motion_emulators
from opsim.scenario.positions import Node, Part, child, problem, text

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
