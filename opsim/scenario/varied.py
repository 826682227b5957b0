"""One variant of a file, read once, and the many scenarios that changes of it make."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from opsim.collecting import without_collecting
from opsim.problems import ScenarioError
from opsim.scenario.changes import changes_node
from opsim.scenario.overrides import applied
from opsim.scenario.positions import Node
from opsim.scenario.read import Loaded, loaded_of, variant_of
from opsim.shipped import find_scenario


@dataclass(frozen=True)
class Varied:
    """A variant as it stands in its file; ``base`` is the file without overrides, to which names are compared."""

    file: Path
    variant: str
    tree: Node
    base: Node

    @classmethod
    def read(cls, path: str | Path, variant: str | None = None) -> Varied:
        """The variant of a file; by default the first one. Raises ScenarioError with every problem of the file's text.

        Only this variant is checked, and only once changes are laid over it.
        """
        file = find_scenario(path)
        name, tree, base = variant_of(file, variant)
        return cls(file, name, tree, base)

    @without_collecting()
    def with_changes(self, changes: Mapping[str, Any], variant: str | None = None) -> Loaded:
        """The scenario with dotted paths replaced by plain YAML values, such as {"layout.places.rack": ["6 m", "1 m"]}.

        variant : the name of what comes of it; by default the variant's own
        Raises ScenarioError with everything that is wrong with it, and the nearest words.
        """
        tree, problems = applied(self.tree, "changes", changes_node(changes))
        if problems:
            raise ScenarioError(sorted(problems))
        return loaded_of(tree, self.base, self.file, self.variant if variant is None else variant)
