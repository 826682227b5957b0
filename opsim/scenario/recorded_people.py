"""The people that the libraries of a scenario were learned from, as far as its tasks are emulated."""

from __future__ import annotations

from pathlib import Path

from opsim.libraries import LibraryMissing, library_people, resolve_library
from opsim.names import natural_key
from opsim.scenario.checks.references import emulators
from opsim.scenario.positions import Node, entries, text


def recorded_people(tree: Node, folder: Path) -> list[str] | None:
    """In natural order, whoever was recorded for an emulated task of the scenario.

    None where a library cannot be read: then nothing can be said of its people, and that is a problem of its own.
    """
    files = {name: text(node) for name, node in entries(tree, "libraries").items()}
    found: set[str] = set()
    for path, model in emulators(tree):
        library, _, inside = model.value.partition("/")
        if not inside or path[0] != "tasks":
            continue
        file = files.get(library)
        if file is None:
            return None
        try:
            found.update(library_people(resolve_library(file, folder)).get(inside, ()))
        except LibraryMissing:
            return None
    return sorted(found, key=natural_key)
