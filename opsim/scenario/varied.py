"""One variant of a file, read once, and the many scenarios that changes of it make."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from opsim.collecting import without_collecting
from opsim.problems import ScenarioError
from opsim.scenario.changes import changes_node
from opsim.scenario.overrides import applied
from opsim.scenario.positions import Node
from opsim.scenario.read import Loaded, loaded_of, variant_trees
from opsim.shipped import find_scenario


@dataclass(frozen=True)
class Varied:
    """A variant as it stands in its file.

    base     : the file without overrides, to which names are compared
    siblings : the trees of all variants of the file by name, this one among them
    """

    file: Path
    variant: str
    tree: Node
    base: Node
    siblings: Mapping[str, Node] = field(repr=False, compare=False)

    @classmethod
    def read(cls, path: str | Path, variant: str | None = None) -> Varied:
        """The variant of a file; by default the first one. Raises ScenarioError with every problem of the file's text.

        Only this variant is checked, and only once changes are laid over it.
        """
        file = find_scenario(path)
        name, trees, base = variant_trees(file, variant)
        return cls(file, name, trees[name], base, trees)

    def of(self, variant: str) -> Varied:
        """Another variant of the same file. Raises KeyError."""
        return replace(self, variant=variant, tree=self.siblings[variant])

    def laid(self, changes: Mapping[str, Any], origin: str = "changes") -> Varied:
        """The variant with changes in its tree, not checked yet. Raises ScenarioError where a path leads nowhere."""
        tree, problems = applied(self.tree, changes_node(changes, origin))
        if problems:
            raise ScenarioError(problems)
        return replace(self, tree=tree)

    @without_collecting()
    def with_changes(self, changes: Mapping[str, Any], variant: str | None = None, origin: str = "changes") -> Loaded:
        """The scenario with dotted paths replaced by plain YAML values, such as {"layout.places.rack": ["6 m", "1 m"]}.

        The order of changes decides nothing: of two of which one lies inside the other, it goes over the other.
        variant : the name of what comes of it; by default the variant's own
        origin  : where the changes come from, such as "--vary": what is wrong with them is said to stand there; a
                  change that is a Node of a file stands where it is written
        Raises ScenarioError with everything that is wrong with paths, values and the scenario, and the nearest words.
        """
        tree, problems = applied(self.tree, changes_node(changes, origin))
        try:
            loaded = loaded_of(tree, self.base, self.file, self.variant if variant is None else variant)
        except ScenarioError as error:
            problems += error.problems
        if problems:
            raise ScenarioError(sorted(set(problems)))
        return loaded
