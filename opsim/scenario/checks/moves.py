"""Changes of a layout that a study asks for: of stations and places that are there."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.layout_moves import Moved, read_any_moved, read_moved
from opsim.scenario.positions import Node, Part, problem

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
