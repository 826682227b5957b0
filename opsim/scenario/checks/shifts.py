"""Shifts: those that are named exist, their breaks lie within them, and nobody is in two at once."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from pydantic import ValidationError

from opsim.clock import DAY_S, DAYS, WEEK_S, on_the_clock
from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.checks.pauses import pause_problems
from opsim.scenario.checks.references import named
from opsim.scenario.positions import Node, Part, child, entries, items, problem
from opsim.scenario.schema.shifts import Shift

Path = tuple[Part, ...]


def shift_problems(tree: Node) -> Iterator[Problem]:
    """Shifts that do not exist, breaks outside their shift or at the same time, workers in two shifts at once."""
    nodes, places = entries(tree, "shifts"), entries(tree, "layout", "places")
    shifts = {name: shift for name, node in nodes.items() if (shift := _read(node)) is not None}
    for owner, path in _owners(tree):
        yield from _unknown(owner, nodes, path)
    for name, node in nodes.items():
        for kind in ("breaks", "meetings"):
            for pause, said in entries(node, kind).items():
                yield from named(child(said, "place"), places, "place", ("shifts", name, kind, pause, "place"))
        if name in shifts:
            yield from pause_problems(node, shifts[name], ("shifts", name))
    for name, worker in entries(tree, "workers").items():
        yield from _in_two(worker, shifts, nodes, ("workers", name, "shift"))


def _read(node: Node) -> Shift | None:
    """A shift as the schema reads it; None where the schema refuses it."""
    try:
        return Shift.model_validate(node.plain())
    except ValidationError:
        return None


def _owners(tree: Node) -> Iterator[tuple[Node, Path]]:
    """What may follow a shift, each with its path."""
    for section in ("workers", "stations", "sources"):
        for name, node in entries(tree, section).items():
            yield node, (section, name, "shift")
    release = child(tree, "release")
    if release is not None:
        yield release, ("release", "shift")


def _names(owner: Node) -> list[Node]:
    said = child(owner, "shift")
    return [] if said is None else [said] if isinstance(said.value, str) else items(said)


def _unknown(owner: Node, known: dict[str, Node], path: Path) -> Iterator[Problem]:
    several = isinstance(getattr(child(owner, "shift"), "value", None), list)
    for number, node in enumerate(_names(owner)):
        if isinstance(node.value, str) and node.value not in known:
            hint = did_you_mean(node.value, known, otherwise="known shifts")
            hint = hint or f"add a section 'shifts: {{{node.value}: {{from: 06:00, to: 14:00}}}}'"
            yield problem(node.place, (*path, number) if several else path, f"no shift {shown(node.value)}", hint)


def _in_two(worker: Node, shifts: dict[str, Shift], nodes: dict[str, Node], path: Path) -> Iterator[Problem]:
    """The first time in his weeks that a worker's next shift begins before the last one, or its overtime, is over."""
    named_here = _names(worker)
    names = [node.value for node in named_here]
    if not names or not all(isinstance(name, str) and name in shifts for name in names):
        return
    for (start_s, name), (next_s, other) in pairwise(_begins([*names, names[0]], shifts)):
        shift, end_s = shifts[name], start_s + shifts[name].length_s
        if end_s > next_s:
            found = f"{name} ends {_when(end_s)}, and {other} begins {_when(next_s)} already"
            yield problem(child(worker, "shift").place, path, found, "nobody works two shifts at once")  # type: ignore[union-attr]
            return
        if shift.overtime is not None and end_s + shift.overtime.most_s > next_s:
            place = child(nodes[name], "overtime", "most")
            found = (
                f"overtime may last until {_when(end_s + shift.overtime.most_s)}, and {other} begins {_when(next_s)}"
            )
            where = ("shifts", name, "overtime", "most")
            yield problem((place or nodes[name]).place, where, found, f"at most {(next_s - end_s) / 3600:g} h are left")
            return


def _begins(names: list[str], shifts: dict[str, Shift]) -> Iterator[tuple[float, str]]:
    """(start_s, name) of each shift, in seconds from Monday 00:00 of the first week, in order of time."""
    for week, name in enumerate(names):
        for day in shifts[name].days:
            yield week * WEEK_S + DAYS.index(day) * DAY_S + shifts[name].start_s, name


def _when(time_s: float) -> str:
    return f"{DAYS[int(time_s // DAY_S) % 7]} {on_the_clock(time_s)}"
