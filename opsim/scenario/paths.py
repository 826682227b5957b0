"""The dotted paths of a scenario: what stands in its tree, and the keys that may stand there.

The path of a scenario that is most like one that leads nowhere: parts mistyped, left out, or too many.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from functools import cache, lru_cache
from heapq import heappop, heappush
from itertools import chain, count
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from opsim.scenario.schema import Block, Scenario
from opsim.scenario.schema.subjects import scenario_model
from opsim.scenario.templates import SECTIONS, WORKFORCE
from opsim.scenario.tree import Node, child, entries, text

Shapes = tuple[Any, ...]
DEFAULTS = "defaults"
_OF_THE_FILE = "opsim"
"""The key that no override changes."""


@dataclass(frozen=True, slots=True)
class Spot:
    """A path, what stands there (its own, or copied by ``like`` and defaults), and what may stand there: blocks, dicts,
    lists, anything else.
    """

    path: tuple[str, ...]
    node: Node | None
    shapes: Shapes

    @property
    def blocks(self) -> list[type[Block]]:
        return [one for one in self.shapes if isinstance(one, type) and issubclass(one, Block) and one is not Block]

    @property
    def by_name(self) -> list[Any]:
        """Dicts whose keys are names."""
        return [one for one in self.shapes if get_origin(one) is dict or one is dict]

    @property
    def anything(self) -> bool:
        return Any in self.shapes or Block in self.shapes

    @property
    def only_a_list(self) -> bool:
        return bool(self.shapes) and all(get_origin(one) in (list, tuple) for one in self.shapes)

    @property
    def may_hold(self) -> bool:
        """Whether something may lie inside."""
        return self.anything or bool(self.blocks) or bool(self.by_name)


def top(root: Node, model: type[Scenario] = Scenario) -> Spot:
    """Where all paths begin; model : of the language whose words they are."""
    return Spot((), root, (model,))


def words(root: Node, spot: Spot) -> list[str]:
    """The parts that may come next: those that stand there first, then keys that may."""
    standing = chain.from_iterable(entries(node) for node in _layers(root, spot))
    may = chain.from_iterable(keys_of(block) for block in spot.blocks)
    found = dict.fromkeys([*standing, *may, *_beside(spot)])
    return [word for word in found if spot.path or word != _OF_THE_FILE]


def step(root: Node, spot: Spot, part: str) -> Spot | None:
    """One part further; None where nothing is called so and no name may be new there."""
    node = next((entries(layer)[part] for layer in _layers(root, spot) if part in entries(layer)), None)
    shapes = _shapes_below(spot, part)
    if shapes is None:
        shapes = (Any,) if node is not None and spot.path else None
    return None if shapes is None else Spot((*spot.path, part), node, shapes)


def stands(root: Node, spot: Spot, part: str) -> bool:
    """Whether the part is there, or is a key that may be: no new name."""
    return any(part in entries(layer) for layer in _layers(root, spot)) or part in words(root, spot)


def _shapes_below(spot: Spot, part: str) -> Shapes | None:
    if spot.path == (DEFAULTS,):
        sections = keys_of(scenario_model())
        return _values(sections[part]) if part in SECTIONS else None
    if not spot.path and part == DEFAULTS:
        return (dict,)
    if part in _beside(spot):
        return (str,)
    found = [keys_of(block)[part] for block in spot.blocks if part in keys_of(block)]
    if not spot.path and part == _OF_THE_FILE:
        return None
    named = _values(tuple(spot.by_name)) if spot.by_name else ()
    every = tuple(dict.fromkeys(chain(*found, named, (Any,) if spot.anything else ())))
    return every or None


def _beside(spot: Spot) -> tuple[str, ...]:
    """Keys that the schema does not know, since they are gone when it reads a scenario."""
    if not spot.path:
        return (DEFAULTS,)
    if spot.path == (DEFAULTS,):
        return SECTIONS
    entry = len(spot.path) == 2 and spot.path[0] in SECTIONS
    return ("like",) if entry or spot.path == (WORKFORCE,) else ()


def _layers(root: Node, spot: Spot) -> list[Node]:
    """Blocks whose keys shine through at a spot: its own, those of what it is like, the defaults."""
    own = [] if spot.node is None else [spot.node]
    section = "workers" if spot.path == (WORKFORCE,) else spot.path[0] if len(spot.path) == 2 else ""
    if section not in SECTIONS:
        return own
    seen: set[str] = set()
    other = text(spot.node, "like")
    while other is not None and other not in seen:
        seen.add(other)
        copied = child(root, section, other)
        own += [] if copied is None else [copied]
        other = text(copied, "like")
    default = child(root, DEFAULTS, section)
    return own if default is None else [*own, default]


@cache
def keys_of(block: type[Block]) -> dict[str, Shapes]:
    """What may stand at each key of a block, by its name in the file."""
    return {field.alias or name: _shapes(field.annotation) for name, field in block.model_fields.items()}


def _values(dicts: Shapes) -> Shapes:
    """What may stand at the names of dicts."""
    return tuple(chain.from_iterable(_shapes(get_args(one)[1]) if get_args(one) else (Any,) for one in dicts))


def _shapes(annotation: Any) -> Shapes:
    """The ways in which a value may be written, without nothing."""
    if get_origin(annotation) is Annotated:
        return _shapes(get_args(annotation)[0])
    if get_origin(annotation) in (Union, UnionType):
        return tuple(chain.from_iterable(map(_shapes, get_args(annotation))))
    return () if annotation is NoneType else (annotation,)


LEAST_LIKE = 0.6
"""Of two words, as in difflib: less is another word."""
LEFT_OUT, TOO_MANY = 0.3, 0.7
MOST_STEPS = 5000
"""That are looked at: a hint must be quick."""


def nearest_path(root: Node, parts: Sequence[str]) -> str | None:
    """The dotted path that stands in the tree, or may, with the fewest changes of parts; None where none is near.

    The cheapest way through the tree (Dijkstra): a mistyped part costs what it lacks in likeness, one left out 0.3, one
    too many 0.7; the last part is always one that was meant.
    """
    most = 0.25 + 0.35 * len(parts)
    order = count()
    waiting: list[tuple[float, int, int, Spot]] = [(0.0, next(order), 0, top(root, scenario_model()))]
    done: set[tuple[tuple[str, ...], int]] = set()
    while waiting:
        cost, _, n_used, spot = heappop(waiting)
        if n_used == len(parts) and spot.path:
            return ".".join(spot.path)
        if (spot.path, n_used) in done:
            continue
        done.add((spot.path, n_used))
        for more, used, part in _next(root, spot, parts[n_used:]):
            below = spot if part is None else step(root, spot, part)
            if cost + more <= most and below is not None and len(waiting) < MOST_STEPS:
                heappush(waiting, (cost + more, next(order), n_used + used, below))
    return None


def _next(root: Node, spot: Spot, left: Sequence[str]) -> list[tuple[float, int, str | None]]:
    """(cost, parts used, word or None) of each way to go on."""
    if not left:
        return []
    ways: list[tuple[float, int, str | None]] = [(TOO_MANY, 1, None)] if len(left) > 1 else []
    for word in words(root, spot):
        alike = _likeness(left[0].casefold()[:60], word.casefold()[:60])
        if alike >= LEAST_LIKE:
            ways.append((1 - alike, 1, word))
        ways.append((LEFT_OUT, 0, word))
    return ways


@lru_cache(50_000)
def _likeness(one: str, other: str) -> float:
    if one == other:
        return 1.0
    matcher = SequenceMatcher(None, one, other)
    if matcher.real_quick_ratio() < LEAST_LIKE or matcher.quick_ratio() < LEAST_LIKE:
        return 0.0
    return matcher.ratio()
