"""The emulator of ``walking:``: one of walking at all, and for people as fast and as slow as the workers."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from opsim import units
from opsim.libraries import LibraryMissing, library_speeds, library_tasks, resolve_library
from opsim.problems import Problem, shown
from opsim.scenario.positions import Node, child, entries, problem, text
from opsim.scenario.schema.workers import Person

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
        speed = _m_per_s(said)
        if speed is not None and not slowest <= speed <= fastest:
            found = f"people of {shown(text(tree, 'walking', 'emulator'))} cannot walk at {speed:g} m/s"
            place = worker.name_place if said is None else said.place
            hint = f"they walk at {slowest:g} to {fastest:g} m/s"
            yield problem(place, ("workers", name, "walk"), found, hint)


def _m_per_s(said: Node | None) -> float | None:
    """The speed of a worker, that of the schema where he says none; None where it cannot be read."""
    try:
        return USUAL_M_PER_S if said is None else units.parse(said.value, "speed")
    except units.UnitError:
        return None
