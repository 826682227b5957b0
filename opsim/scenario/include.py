"""``include: [common.yaml]``: other files laid below this one; of two, the later one wins, and the file over all.

An included file lies in the folder of the file that names it, below that, or among the shipped scenarios.
"""

from __future__ import annotations

from pathlib import Path

from opsim.files import NotInside, inside
from opsim.problems import Problem, ScenarioError, did_you_mean, shown
from opsim.scenario.merging import laid_over
from opsim.scenario.positions import Node, Part, Place, Source, child, entries, items, problem
from opsim.scenario.yaml_nodes import Budget, read_tree
from opsim.scenario.yaml_text import read_bytes
from opsim.shipped import shipped_folder

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
            hint = did_you_mean(node.value, beside, otherwise="files there")
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
