"""``like: ana`` copies the entry ana; ``defaults: {workers: {...}}`` is what every worker starts from.

A key that is given replaces the copied one whole: an entry's own keys go over what it is like, that over the defaults.
"""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import MOST_FOUND, Problem, ScenarioError, did_you_mean, shown
from opsim.scenario.merging import entry_over
from opsim.scenario.positions import Node, entries, problem, text

SECTIONS = ("tasks", "stations", "products", "workers", "shifts")
WORKFORCE = "workforce"
"""One block of keys for many workers: like a worker, or on the defaults of workers."""

MOST_COPIED = 1_000_000
"""Keys that likes and defaults may copy altogether: a chain of thousands could copy without end."""


def without_likes(root: Node) -> tuple[Node, list[Problem]]:
    """The tree with every ``like`` and all defaults filled in, and the ones that stand for nothing."""
    problems = [*_wrong_defaults(root)]
    top = {key: node for key, node in entries(root).items() if key != "defaults"}
    for section in SECTIONS:
        if entries(root, section):
            filled = _filled(section, entries(root, section), entries(root, "defaults", section), problems)
            top = {**top, section: top[section].with_entries(filled)}
    if entries(root, WORKFORCE):
        top = {**top, WORKFORCE: _workforce(root, entries(top.get("workers")), problems)}
    return root.with_entries(top), problems


def _filled(
    section: str, known: dict[str, Node], defaults: dict[str, Node], problems: list[Problem]
) -> dict[str, Node]:
    done: dict[str, Node] = {}
    n_copied = 0
    for name in known:
        chain = _chain(section, name, known, done, problems)
        for member in reversed(chain):
            done[member] = _merged(section, known[member], done, defaults)
            n_copied += len(entries(done[member]))
            if n_copied > MOST_COPIED:
                found = f"likes and defaults of the {section} copy more than {MOST_COPIED:,} keys"
                raise ScenarioError(sorted([*problems, problem(known[member].name_place, (section, member), found)]))
    return {name: done[name] for name in known}


def _wrong_defaults(root: Node) -> Iterator[Problem]:
    """Defaults of what has none, or that are no block of keys."""
    node = entries(root).get("defaults")
    if node is not None and not isinstance(node.value, dict):
        found = f"expected a block of sections, found {shown(node.value)}"
        yield problem(node.name_place, ("defaults",), found, "such as {workers: {walk: 1.2 m/s}}")
    for section, default in entries(root, "defaults").items():
        path = ("defaults", section)
        if section not in SECTIONS:
            hint = did_you_mean(section, SECTIONS, otherwise="sections with defaults")
            yield problem(default.name_place, path, f"no defaults for {shown(section)}", hint)
        elif not isinstance(default.value, dict):
            found = f"expected a block of keys, found {shown(default.value)}"
            yield problem(default.name_place, path, found, "such as {walk: 1.2 m/s}")
        elif "like" in default.value:
            found = "defaults are like nothing"
            yield problem(default.value["like"].name_place, (*path, "like"), found, "give the keys themselves")


def _chain(
    section: str, name: str, known: dict[str, Node], done: dict[str, Node], problems: list[Problem]
) -> list[str]:
    """The entries from ``name`` along their ``like`` that are not done yet, the first to be copied last."""
    chain: dict[str, None] = {}
    while name not in done:
        chain[name] = None
        like = entries(known[name]).get("like")
        if like is None:
            break
        path = (section, name, "like")
        other = like.value
        if len(problems) >= MOST_FOUND:
            raise ScenarioError(sorted(problems))
        if not isinstance(other, str) or other not in known:
            hint = did_you_mean(other, set(known) - {name})
            problems.append(problem(like.place, path, f"no {shown(other)} among the {section}", hint))
            break
        if other in chain:
            members = list(chain)
            round_trip = " is like ".join([*members[members.index(other) :], other][-8:])
            problems.append(problem(like.place, path, f"this goes round in a circle: {round_trip}"))
            break
        name = other
    return list(chain)


def _merged(section: str, node: Node, done: dict[str, Node], defaults: dict[str, Node]) -> Node:
    """An entry on top of a copy of what it is like, or of the defaults; without a copy where that is not to be had."""
    if not isinstance(node.value, dict):
        return node
    like = node.value.get("like")
    if like is None:
        return entry_over(section, defaults, node) if defaults else node
    own = node.with_entries({key: below for key, below in node.value.items() if key != "like"})
    return entry_over(section, entries(done.get(text(like) or "")), own)


def _workforce(root: Node, workers: dict[str, Node], problems: list[Problem]) -> Node:
    """The workforce on top of the worker it is like, but for the person he is, or of the defaults of workers."""
    node = entries(root)[WORKFORCE]
    like = entries(node).get("like")
    if like is not None and (not isinstance(like.value, str) or like.value not in workers):
        hint = did_you_mean(like.value, workers) or "there are no workers by name"
        problems.append(problem(like.place, (WORKFORCE, "like"), f"no {shown(like.value)} among the workers", hint))
    below = entries(root, "defaults", "workers") if like is None else entries(workers.get(text(like) or ""))
    own = node.with_entries({key: one for key, one in entries(node).items() if key != "like"})
    return entry_over("workers", {key: one for key, one in below.items() if key != "person"}, own)
