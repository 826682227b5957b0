"""Keys of studies: each has one meaning, and is looked after wherever it stands.

``vary`` are paths and values, ``points`` blocks of changes, ``variants`` names of the file's variants, ``figures`` what
is told, and so on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.changes_checked import change_problems
from opsim.scenario.checks.figures import SECTION_OF, figure_problems
from opsim.scenario.checks.moves import PLACES, move_problems
from opsim.scenario.layout_moves import EXAMPLES
from opsim.scenario.positions import Node, Part, child, entries, items, problem, written_paths
from opsim.scenario.variants import MOST_CHECKED
from opsim.scenario.varied import Varied

STUDIES = "studies"
FEWEST_TRIES, MOST_TRIES = 20, 2000
NO_FACTORS = {
    "name": "vary what does",
    "outputs": "say which figures are told with 'figures'",
    "frontier": "say which figures are told with 'figures'",
    "run.seed": "replications have other luck each: take more of them",
    "run.replications": "say how many with 'replications'",
}
Path = tuple[Part, ...]
Check = Callable[[Node, Path], Iterator[Problem]]
FIGURES = ("figure", "figures", "best", "exposure", "subject_to", "target")
"""Keys of texts that name a figure, alone or with a limit."""
NAMES = {"workers": "workers", "like": "workers", "stations": "stations", "fixed": "stations", PLACES: PLACES}
"""Keys of names, and what is called so."""


@dataclass(frozen=True)
class StudyKeys:
    """A study under check. ``base`` : what is wrong with the variant itself."""

    varied: Varied
    base: frozenset[Problem]

    def block(self, block: Node, path: Path) -> Iterator[Problem]:
        """Of all keys of a block and of the blocks in it."""
        for key, node in entries(block).items():
            check = self.checks.get(key)
            if check is not None:
                yield from check(node, (*path, key))
            elif isinstance(node.value, dict):
                yield from self.block(node, (*path, key))

    @cached_property
    def checks(self) -> dict[str, Check]:
        """By the name of a key."""
        return {
            **dict.fromkeys(FIGURES, self.figures),
            **{key: self.named(section) for key, section in NAMES.items()},
            **{kind: self.moves(kind) for kind in EXAMPLES},
            "what_ifs": self.what_ifs,
            "vary": self.factors,
            "points": self.points,
            "variants": self.variants,
            "base": self.variants,
        }

    def factors(self, node: Node, path: Path) -> Iterator[Problem]:
        """Every value of a list, and both ends of a range, laid over the variant by itself."""
        for name, factor in entries(node).items():
            if wrong := list(_no_factor(name, factor, path)):
                yield from wrong
                continue
            for value in _values(factor):
                yield from self._changed({name: replace(value, key=factor.key)}, path)

    def points(self, node: Node, path: Path) -> Iterator[Problem]:
        """Every point of a list."""
        for number, point in enumerate(items(node)):
            if entries(point):
                yield from self._changed(entries(point), (*path, number))

    def variants(self, node: Node, path: Path) -> Iterator[Problem]:
        """Names of variants of the file."""
        seen: set[str] = set()
        for one in _texts(node):
            if one.value in seen:
                yield problem(one.place, path, f"{shown(one.value)} is named twice", "name each variant once")
            seen.add(one.value)
            if one.value not in self.varied.siblings:
                hint = did_you_mean(one.value, self.varied.siblings, otherwise="variants of this file")
                yield problem(one.place, path, f"no variant {shown(one.value)} in this file", hint)

    def figures(self, node: Node, path: Path) -> Iterator[Problem]:
        """Figures, alone or with a limit."""
        for one in _texts(node):
            yield from figure_problems(one, self.in_any_variant, path)

    def named(self, section: str) -> Check:
        """Names of things of a section."""

        def check(node: Node, path: Path) -> Iterator[Problem]:
            for one in _texts(node):
                if one.value not in self.in_any_variant[section]:
                    hint = did_you_mean(one.value, self.in_any_variant[section], otherwise=f"known {section}")
                    hint = hint or f"there are no {section} in this file"
                    yield problem(one.place, path, f"no {shown(one.value)} among the {section}", hint)

        return check

    def moves(self, kind: str) -> Check:
        """Changes of the layout of one kind, or, where it is "", of any."""
        return lambda node, path: move_problems(_texts(node), kind, self.in_any_variant, path)

    def what_ifs(self, node: Node, path: Path) -> Iterator[Problem]:
        """Changes of the layout by name."""
        for name, below in entries(node).items():
            yield from self.moves("")(below, (*path, name))

    def _changed(self, changes: Mapping[str, Node], path: Path) -> Iterator[Problem]:
        if next(self._tries, None) is None:
            return iter(())
        return change_problems(self._floor, changes, path, but=self.base)

    @cached_property
    def _floor(self) -> Varied:
        """The variant without its studies, which no value decides anything of: they are long, and were checked once."""
        tree = self.varied.tree
        floor = {key: node for key, node in entries(tree).items() if key != STUDIES}
        return replace(self.varied, tree=tree.with_entries(floor))

    @cached_property
    def _tries(self) -> Iterator[int]:
        """One for each time that the scenario may still be checked as a whole; the others are when they are run."""
        n_values = sum(1 for _ in written_paths(self.varied.tree))
        return iter(range(min(MOST_TRIES, max(FEWEST_TRIES, MOST_CHECKED // max(n_values, 1)))))

    @cached_property
    def in_any_variant(self) -> dict[str, set[str]]:
        """Names by section, of this variant and all others of the file, and those that the study itself adds."""
        scenario = None if self.base else self.varied.with_changes({}).scenario
        found: dict[str, set[str]] = {section: {*getattr(scenario, section, ())} for section in SECTION_OF.values()}
        found[PLACES] = set()
        for section, names in found.items():
            way = ("layout", PLACES) if section == PLACES else (section,)
            for tree in (self.varied.tree, *self.varied.siblings.values()):
                names.update(entries(tree, *way))
                names.update(_added(child(tree, STUDIES), ".".join(way)))
        return found


def _no_factor(name: str, factor: Node, path: Path) -> Iterator[Problem]:
    """Of what nobody would vary: it decides nothing but luck, names, or what is asked."""
    if name.partition(".")[0] in (STUDIES, *NO_FACTORS) or name in NO_FACTORS:
        hint = NO_FACTORS.get(name, "vary what does")
        yield problem(factor.name_place, (*path, name), f"{name} decides nothing of what happens on the floor", hint)


def _values(factor: Node) -> Sequence[Node]:
    if isinstance(factor.value, list):
        return factor.value
    return [end for key in ("from", "to") if (end := child(factor, key)) is not None]


def _texts(node: Node) -> list[Node]:
    """The texts of a list, or one alone."""
    return [one for one in (items(node) or [node]) if isinstance(one.value, str)]


def _added(node: Node | None, section: str) -> Iterator[str]:
    """Names that a study adds to a section, wherever in it: a longer path leads to a key of what must be there."""
    for key, below in entries(node).items():
        name = key.removeprefix(f"{section}.")
        if name != key and "." not in name:
            yield name
        yield from _added(below, section)
    for below in items(node):
        yield from _added(below, section)
