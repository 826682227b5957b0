"""The sources of a scenario as they stand in the tree: its one release, or each of its sources."""

from __future__ import annotations

from opsim.scenario.positions import Node, Part, child, entries, items

Path = tuple[Part, ...]


def releases(tree: Node) -> dict[Path, Node]:
    """Every source by its path."""
    one = child(tree, "release")
    found: dict[Path, Node] = {} if one is None else {("release",): one}
    return found | {("sources", name): node for name, node in entries(tree, "sources").items()}


def made_by(tree: Node, release: Node) -> list[str]:
    """The products that a source may make, as far as the tree says: those it names, else all."""
    in_order = [node.value for node in items(release, "sequence") if isinstance(node.value, str)]
    named = list(entries(release, "products")) or [
        node.value for node in items(release, "products") if isinstance(node.value, str)
    ]
    return list(dict.fromkeys(in_order)) or named or list(entries(tree, "products"))


def says_products(release: Node) -> bool:
    """Whether a source says itself what it makes."""
    return child(release, "products") is not None or child(release, "sequence") is not None
