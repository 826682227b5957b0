"""What stands in a file and where: a tree of nodes, each value with the place it was written at.

Overrides and ``like`` move nodes about; a node keeps its place: an error in an override points at the override's line.

The common ground of all blocks of the language.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from pydantic import BaseModel, ConfigDict, Field

from opsim.problems import Problem

Part = str | int
TreePath = tuple[Part, ...]


@dataclass(frozen=True)
class Source:
    """A file as text, by lines."""

    file: str
    lines: tuple[str, ...]


class Place(NamedTuple):
    """A point of a source; line and column count from 0."""

    source: Source
    line: int
    column: int


@dataclass(frozen=True, slots=True)
class Node:
    """A value (a dict of nodes, a list of nodes, or a scalar), its place, and the place of its key where it has one."""

    value: Any
    place: Place
    key: Place | None = None

    @property
    def name_place(self) -> Place:
        return self.place if self.key is None else self.key

    def plain(self) -> Any:
        """The value without places, ready for a schema or a YAML writer."""
        if isinstance(self.value, dict):
            return {key: node.plain() for key, node in self.value.items()}
        if isinstance(self.value, list):
            return [node.plain() for node in self.value]
        return self.value

    def with_entries(self, entries: dict[str, Node]) -> Node:
        return replace(self, value=entries)


def child(node: Node | None, *path: Part) -> Node | None:
    """The node at a path, or None where the path does not lead."""
    for part in path:
        if node is None:
            return None
        inside: Any = node.value
        if isinstance(inside, list):
            inside = dict(enumerate(inside))
        node = inside.get(part) if isinstance(inside, dict) else None
    return node


def entries(node: Node | None, *path: Part) -> dict[str, Node]:
    """The named entries of a block; empty where there is no block."""
    found = child(node, *path)
    return found.value if found is not None and isinstance(found.value, dict) else {}


def items(node: Node | None, *path: Part) -> list[Node]:
    """The items of a list; empty where there is no list."""
    found = child(node, *path)
    return found.value if found is not None and isinstance(found.value, list) else []


def text(node: Node | None, *path: Part) -> str | None:
    """The text that stands at a path, or None."""
    found = child(node, *path)
    return found.value if found is not None and isinstance(found.value, str) else None


def written_paths(node: Node) -> Iterator[str]:
    """Every dotted path of the keys that stand in the tree, e.g. "run", "run.horizon"; in no order."""
    blocks = [("", node)]
    while blocks:
        before, block = blocks.pop()
        if isinstance(block.value, dict):
            for key, below in block.value.items():
                yield before + key
                blocks.append((f"{before}{key}.", below))


def dotted(path: Iterable[Part]) -> str:
    """A path as people read it: ``layout.places.rack[0]``; characters that do not print become '?'."""
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f".{part}"
    printable = "".join(c if c.isprintable() else "?" for c in text.removeprefix(".")[:120])
    return printable if len(text) <= 120 else printable + "..."


def problem(place: Place, path: Iterable[Part] | str, message: str, hint: str = "") -> Problem:
    """The problem at a place, with the line it stands on."""
    lines = place.source.lines
    source_line = lines[place.line] if place.line < len(lines) else ""
    where = path if isinstance(path, str) else dotted(path)
    return Problem(place.source.file, place.line + 1, place.column + 1, where, message, hint, source_line)


DIST = Field(description="which distribution")
"""Of the key that tells distributions apart."""


class Block(BaseModel):
    """Nothing changes after reading, no unknown key, no silent conversion."""

    # NOTE: validators are built when first used: once for the whole scenario, in place of once a block at import
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False, defer_build=True)
