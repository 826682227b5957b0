"""One block laid over another: what the upper says stands, the rest shines through.

``include: [common.yaml]``: other files laid below this one; of two, the later one wins, and the file over all.

An included file lies in the folder of the file that names it, below that, or among the shipped scenarios.

``like: ana`` copies the entry ana; ``defaults: {workers: {...}}`` is what every worker starts from.

A key that is given replaces the copied one whole: an entry's own keys go over what it is like, that over the defaults.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from opsim.files import NotInside, inside
from opsim.problems import MOST_FOUND, Problem, ScenarioError, did_you_mean, shown
from opsim.scenario.schema import KIND_KEYS
from opsim.scenario.tree import Node, Part, Place, Source, child, entries, items, problem, text
from opsim.scenario.yaml import Budget, read_bytes, read_tree
from opsim.shipped import shipped_folder

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


MOST_INCLUDES = 100


def with_includes(root: Node, file: Path, budget: Budget) -> tuple[Node, list[Problem]]:
    """The tree of a file over those it includes, and what is wrong with them.

    Raises ScenarioError where an included file cannot be read: nothing else could be said of this one.
    """
    reader = _Reader(budget)
    whole = reader.merged(root, (file,))
    if reader.broken:
        raise ScenarioError(sorted([*reader.problems, *reader.broken]))
    return whole, reader.problems


class _Reader:
    """Reads included files, each once, however many others name it."""

    def __init__(self, budget: Budget):
        self.budget = budget
        self.problems: list[Problem] = []
        self.broken: list[Problem] = []
        self.trees: dict[Path, Node] = {}
        self.n_includes = 0

    def merged(self, root: Node, trail: tuple[Path, ...]) -> Node:
        """The tree over those it includes; ``trail`` is the way from the first file to this one."""
        below = Node({}, root.place)
        for path, node in _names(root):
            self.n_includes += 1
            if self.n_includes > MOST_INCLUDES:
                self.broken.append(problem(node.place, path, f"more than {MOST_INCLUDES} includes"))
                break
            tree = self.tree(path, node, trail)
            if tree is not None:
                below = laid_over(below, tree)
        own = root.with_entries({key: node for key, node in entries(root).items() if key != "include"})
        return laid_over(below, own)

    def tree(self, path: tuple[Part, ...], node: Node, trail: tuple[Path, ...]) -> Node | None:
        """The tree behind one name of an include, or None with a problem said."""
        file = self.file(path, node, trail[-1].parent)
        if file is None:
            return None
        if file in trail:
            circle = " includes ".join(one.name for one in [*trail[trail.index(file) :], file])
            self.problems.append(problem(node.place, path, f"this goes round in a circle: {circle}"))
            return None
        if file not in self.trees:
            self.trees[file] = self.merged(self.read(file), (*trail, file))
        return self.trees[file]

    def file(self, path: tuple[Part, ...], node: Node, folder: Path) -> Path | None:
        if not isinstance(node.value, str):
            found = f"expected the name of a file, found {shown(node.value)}"
            self.problems.append(problem(node.place, path, found, "such as [common.yaml]"))
            return None
        try:
            file = inside(node.value, folder, shipped_folder())
        except NotInside as error:
            found = f"cannot include {shown(node.value)}: {error}"
            self.problems.append(problem(node.place, path, found, "copy the file there"))
            return None
        if file is None:
            beside = [one.name for one in folder.glob("*.y*ml")]
            hint = did_you_mean(node.value, beside, otherwise="files there", files=True)
            self.broken.append(problem(node.place, path, f"no file {shown(node.value)} to include", hint))
        return file

    def read(self, file: Path) -> Node:
        empty = Node({}, Place(Source(str(file), ()), 0, 0))
        try:
            root, problems = read_tree(read_bytes(file), str(file), self.budget)
        except ScenarioError as error:
            self.broken += error.problems
            return empty
        self.problems += problems
        if not isinstance(root.value, dict):
            self.broken.append(problem(root.place, "", f"expected a part of a scenario, found {shown(root.value)}"))
            return empty
        return root


def _names(root: Node) -> list[tuple[tuple[Part, ...], Node]]:
    """The names that stand under ``include``, one or a list, each with its path."""
    include = child(root, "include")
    if include is None:
        return []
    if isinstance(include.value, list):
        return [(("include", number), node) for number, node in enumerate(items(include))]
    return [(("include",), include)]


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
