"""One variant of a file, read once, and the many scenarios that changes of it make.

What is wrong with a variant once changes are laid over it, said at these changes.

Keys of studies: each has one meaning, and is looked after wherever it stands.

``vary`` are paths and values, ``points`` blocks of changes, ``variants`` names of the file's variants, ``figures`` what
is told, and so on.

What is wrong with the studies of a scenario, as far as it can be known without a run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import Any

from opsim.problems import MOST_FOUND, Problem, ScenarioError, did_you_mean, shown
from opsim.scenario.checks.names import PLACES, SECTION_OF, figure_problems, move_problems
from opsim.scenario.fields import EXAMPLES
from opsim.scenario.read import loaded_of, variant_trees
from opsim.scenario.schema.scenario import Loaded
from opsim.scenario.tree import Node, Part, child, entries, items, problem, written_paths
from opsim.scenario.variants import MOST_CHECKED, applied, changes_node, flow_text
from opsim.shipped import find_scenario
from opsim.threads import without_collecting


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


def change_problems(
    varied: Varied,
    changes: Mapping[str, Any],
    at: tuple[Part, ...] = (),
    origin: str = "changes",
    but: frozenset[Problem] = frozenset(),
) -> Iterator[Problem]:
    """What is wrong with a variant once some changes are laid over it, said at these changes.

    changes : dotted path -> plain value, or a Node that stands in a file. at : the way to them in that file
    but     : what is wrong without them, and is not said again
    """
    try:
        varied.with_changes(changes, origin=origin)
    except ScenarioError as error:
        places = {_line(place) for node in _nodes(changes) for place in (node.place, node.name_place)}
        for one in error.problems:
            if one not in but:
                near = not changes or one.file == origin or (one.file, one.line) in places
                yield one if near else _moved(one, changes, at)


def _nodes(changes: Mapping[str, Any]) -> list[Node]:
    return [value for value in changes.values() if isinstance(value, Node)]


def _line(place: Any) -> tuple[str, int]:
    return place.source.file, place.line + 1


def _moved(found: Problem, changes: Mapping[str, Any], at: tuple[Part, ...]) -> Problem:
    """A problem that the changes make elsewhere in the file."""
    said = ", ".join(f"{path}: {flow_text(value)}" for path, value in changes.items())
    message = f"with {said if len(said) < 80 else said[:77] + '...'}: {found.path}: {found.message}"
    for node in _nodes(changes):
        return problem(node.place, (*at, next(iter(changes))), message, found.hint)
    return replace(found, message=message, path="")


STUDIES = "studies"
FEWEST_TRIES, MOST_TRIES = 20, 2000
NO_FACTORS = {
    "name": "vary what does",
    "outputs": "say which figures are told with 'figures'",
    "frontier": "say which figures are told with 'figures'",
    "run.seed": "replications have other luck each: take more of them",
    "run.replications": "say how many with 'replications'",
}
TreePath = tuple[Part, ...]
Check = Callable[[Node, TreePath], Iterator[Problem]]
FIGURES = ("figure", "figures", "best", "exposure", "subject_to", "target")
"""Keys of texts that name a figure, alone or with a limit."""
NAMES = {"workers": "workers", "like": "workers", "stations": "stations", "fixed": "stations", PLACES: PLACES}
"""Keys of names, and what is called so."""


@dataclass(frozen=True)
class StudyKeys:
    """A study under check. ``base`` : what is wrong with the variant itself."""

    varied: Varied
    base: frozenset[Problem]

    def block(self, block: Node, path: TreePath) -> Iterator[Problem]:
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

    def factors(self, node: Node, path: TreePath) -> Iterator[Problem]:
        """Every value of a list, and both ends of a range, laid over the variant by itself."""
        for name, factor in entries(node).items():
            if wrong := list(_no_factor(name, factor, path)):
                yield from wrong
                continue
            for value in _values(factor):
                yield from self._changed({name: replace(value, key=factor.key)}, path)

    def points(self, node: Node, path: TreePath) -> Iterator[Problem]:
        """Every point of a list."""
        for number, point in enumerate(items(node)):
            if entries(point):
                yield from self._changed(entries(point), (*path, number))

    def variants(self, node: Node, path: TreePath) -> Iterator[Problem]:
        """Names of variants of the file."""
        seen: set[str] = set()
        for one in _texts(node):
            if one.value in seen:
                yield problem(one.place, path, f"{shown(one.value)} is named twice", "name each variant once")
            seen.add(one.value)
            if one.value not in self.varied.siblings:
                hint = did_you_mean(one.value, self.varied.siblings, otherwise="variants of this file")
                yield problem(one.place, path, f"no variant {shown(one.value)} in this file", hint)

    def figures(self, node: Node, path: TreePath) -> Iterator[Problem]:
        """Figures, alone or with a limit."""
        for one in _texts(node):
            yield from figure_problems(one, self.in_any_variant, path)

    def named(self, section: str) -> Check:
        """Names of things of a section."""

        def check(node: Node, path: TreePath) -> Iterator[Problem]:
            for one in _texts(node):
                if one.value not in self.in_any_variant[section]:
                    hint = did_you_mean(one.value, self.in_any_variant[section], otherwise=f"known {section}")
                    hint = hint or f"there are no {section} in this file"
                    yield problem(one.place, path, f"no {shown(one.value)} among the {section}", hint)

        return check

    def moves(self, kind: str) -> Check:
        """Changes of the layout of one kind, or, where it is "", of any."""
        return lambda node, path: move_problems(_texts(node), kind, self.in_any_variant, path)

    def what_ifs(self, node: Node, path: TreePath) -> Iterator[Problem]:
        """Changes of the layout by name."""
        for name, below in entries(node).items():
            yield from self.moves("")(below, (*path, name))

    def _changed(self, changes: Mapping[str, Node], path: TreePath) -> Iterator[Problem]:
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


def _no_factor(name: str, factor: Node, path: TreePath) -> Iterator[Problem]:
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


MOST_TRIED = 20
"""Variants for which the studies of a file are checked."""


def check_study(varied: Varied, verb: str | None = None) -> None:
    """Raises ScenarioError with all that is wrong with a variant and one of its studies, or all of them."""
    base = _wrong_as_it_is(varied)
    if problems := {*base, *_found(varied, verb, base)}:
        raise ScenarioError(sorted(problems))


def study_problems(file: str | Path, names: Sequence[str] | None = None) -> list[Problem]:
    """What is wrong with the studies of a file for each of its variants (or those named): a study may be meant for one
    of them. Empty where the file cannot be read, or its variants are not there, which ``read_scenarios`` says.
    """
    try:
        first = Varied.read(file)
        variants = [first.of(name) for name in names or first.siblings if name in first.siblings]
    except ScenarioError:
        return []
    everywhere: set[Problem] | None = None
    for varied in variants[:MOST_TRIED]:
        found = _found(varied, None, _wrong_as_it_is(varied)) if entries(varied.tree, STUDIES) else set[Problem]()
        everywhere = found if everywhere is None else everywhere & found
        if not everywhere:
            break
    return sorted(everywhere or ())


def _wrong_as_it_is(varied: Varied) -> frozenset[Problem]:
    return frozenset(change_problems(varied, {}))


def _found(varied: Varied, verb: str | None, base: frozenset[Problem]) -> set[Problem]:
    """What is wrong with studies and not with the variant itself."""
    asked = {name: node for name, node in entries(varied.tree, STUDIES).items() if verb in (None, name)}
    study = StudyKeys(varied, base)
    found = (one for name, node in asked.items() for one in study.block(node, (STUDIES, name)))
    return set(islice(found, MOST_FOUND))
