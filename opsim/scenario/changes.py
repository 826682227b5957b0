"""Changes from elsewhere than the file, as a block of it: dotted paths and plain YAML values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from opsim.scenario.positions import Node, Place, Source


def changes_node(changes: Mapping[str, Any], origin: str = "changes") -> Node:
    """Changes as an override would have them, a line each, so that what is wrong with them has a place too.

    origin : where they come from, such as "--vary", in place of the name of a file. A value that is a Node keeps its
             own place. They come by name, so that the order in which they were given decides nothing.
    """
    source = Source(origin, tuple(f"{path}: {flow_text(value)}" for path, value in changes.items()))
    nodes = {
        path: value
        if isinstance(value, Node)
        else _node(value, Place(source, line, len(path) + 2), Place(source, line, 0))
        for line, (path, value) in enumerate(changes.items())
    }
    return Node(dict(sorted(nodes.items())), Place(source, 0, 0))


def flow_text(value: Any) -> str:
    """A plain value in a line of YAML, as people write it: ``[6 m, 1 m]``, ``{like: ana}``, ``true``."""
    if isinstance(value, Node):
        return flow_text(value.plain())
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{name}: {flow_text(below)}" for name, below in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(flow_text, value)) + "]"
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _node(value: Any, place: Place, key: Place | None = None) -> Node:
    """A plain value as a tree; everything in it stands where the whole stands."""
    if isinstance(value, Mapping):
        return Node({str(name): _node(below, place, place) for name, below in value.items()}, place, key)
    if isinstance(value, list | tuple):
        return Node([_node(below, place) for below in value], place, key)
    return Node(value, place, key)
