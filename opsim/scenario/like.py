"""``like: ana`` copies the entry ana; a key that is given replaces the copied one whole."""

from __future__ import annotations

from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.positions import Node, entries, problem, text

SECTIONS = ("tasks", "stations", "products", "workers")


def without_likes(root: Node) -> tuple[Node, list[Problem]]:
    """The tree with every ``like`` replaced by what it stands for, and the ones that stand for nothing."""
    problems: list[Problem] = []
    top = entries(root)
    for section in SECTIONS:
        if entries(root, section):
            top = {**top, section: top[section].with_entries(_filled(section, entries(root, section), problems))}
    return root.with_entries(top), problems


def _filled(section: str, known: dict[str, Node], problems: list[Problem]) -> dict[str, Node]:
    done: dict[str, Node] = {}
    for name in known:
        chain = _chain(section, name, known, done, problems)
        for member in reversed(chain):
            done[member] = _merged(known[member], done)
    return {name: done[name] for name in known}


def _chain(
    section: str, name: str, known: dict[str, Node], done: dict[str, Node], problems: list[Problem]
) -> list[str]:
    """The entries from ``name`` along their ``like`` that are not done yet, the first to be copied last."""
    chain: list[str] = []
    while name not in done:
        chain.append(name)
        like = entries(known[name]).get("like")
        if like is None:
            break
        path = (section, name, "like")
        other = like.value
        if not isinstance(other, str) or other not in known:
            hint = did_you_mean(other, set(known) - {name})
            problems.append(problem(like.place, path, f"no {shown(other)} among the {section}", hint))
            break
        if other in chain:
            round_trip = " is like ".join([*chain[chain.index(other) :], other])
            problems.append(problem(like.place, path, f"this goes round in a circle: {round_trip}"))
            break
        name = other
    return chain


def _merged(node: Node, done: dict[str, Node]) -> Node:
    """An entry on top of a copy of what it is like; without a copy where that is not to be had."""
    own = entries(node)
    if "like" not in own:
        return node
    copied = entries(done.get(text(own["like"]) or ""))
    return node.with_entries({**copied, **{key: below for key, below in own.items() if key != "like"}})
