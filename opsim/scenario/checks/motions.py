"""Tasks of several motions: their skeletons are one, and who walks in them has a way to walk."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from opsim.libraries import LibraryMissing, library_skeletons, resolve_library
from opsim.problems import Problem, shown
from opsim.scenario.checks.references import motion_emulators
from opsim.scenario.positions import Node, child, entries, items, problem, text


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
