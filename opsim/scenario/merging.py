"""One block laid over another: what the upper says stands, the rest shines through."""

from __future__ import annotations

from dataclasses import replace

from opsim.scenario.positions import Node, entries
from opsim.scenario.schema import KIND_KEYS

_KEPT_OF_A_TASK = {"load", "repeat", "automatic", "per", "like"}
_WAYS = {"route", "routing"}
_OF_A_KIND = {"every", "at_once", "file", "store", "level"}
_MIX = {"products", "sequence"}


def laid_over(lower: Node, upper: Node, path: tuple[str, ...] = ()) -> Node:
    """The upper tree with what the lower has beyond it; blocks are laid over each other key by key, lists are not."""
    if not isinstance(lower.value, dict) or not isinstance(upper.value, dict):
        return upper
    below = without_outdated(path, lower.value, upper.value)
    both = {key: laid_over(node, upper.value[key], (*path, key)) for key, node in below.items() if key in upper.value}
    return replace(upper, value={**below, **upper.value, **both})


def without_outdated(path: tuple[str, ...], lower: dict[str, Node], upper: dict[str, Node]) -> dict[str, Node]:
    """The lower block without what the upper makes void by saying anew of what kind it is.

    A task that says where its time comes from, a product its way, a release its kind: what the lower says of that goes.
    """
    section = path[0] if path else ""
    if section == "tasks" and len(path) == 2 and any(key in upper for key in KIND_KEYS):
        return {key: node for key, node in lower.items() if key in _KEPT_OF_A_TASK}
    if section == "products" and len(path) == 2 and any(key in upper for key in _WAYS):
        return {key: node for key, node in lower.items() if key not in _WAYS}
    if path == ("release",) or (section == "sources" and len(path) == 2):
        outdated = _OF_A_KIND if "kind" in upper else set()
        outdated = outdated | (_MIX if any(key in upper for key in _MIX) else set())
        return {key: node for key, node in lower.items() if key not in outdated}
    return lower


def entry_over(section: str, lower: dict[str, Node], upper: Node) -> Node:
    """An entry of a section with the keys of another below its own; a key that is given replaces the other whole."""
    own = entries(upper)
    return upper.with_entries({**without_outdated((section, ""), lower, own), **own})
