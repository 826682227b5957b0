"""Among which points a choice is made: variants of a file, or combinations of what is varied."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from math import prod
from typing import Any

from opsim.problems import did_you_mean, shown
from opsim.study.jobs import Point
from opsim.study.select.constants import check_confidence
from opsim.study.sweep.factors import Factor, factors_of

MOST_POINTS = 2000
USUAL_TRIALS = 60


@dataclass(frozen=True)
class Candidates:
    """points : to choose from, empty before a search has found them; base : what the chosen one is compared with."""

    points: tuple[Point, ...]
    base: Point
    factors: tuple[Factor, ...] = ()
    trials: int = 0


def candidates_of(block: Any, siblings: Sequence[str], variant: str) -> Candidates:
    """block : of ``studies: select:``; siblings : all variants of the file; variant : the one to start from.

    Raises ValueError: no such variant, only one, too many combinations, a confidence that a guess has too.
    """
    if block.vary is None:
        found = _variants(block, siblings, variant)
    else:
        _known([block.base] if block.base else [], siblings)
        base = Point(block.base or variant, {}, block.base or variant)
        factors = factors_of(block.vary)
        if block.search or block.trials:
            found = _to_search(block, factors, base)
        else:
            found = Candidates(tuple(_grid(factors, variant)), base, factors)
    n = min(block.finalists, found.trials) if found.trials else len(found.points)
    if n > 1:
        check_confidence(block.confidence, n)
    return found


def _variants(block: Any, siblings: Sequence[str], variant: str) -> Candidates:
    names = list(dict.fromkeys(block.variants or siblings))
    _known([*names, *([block.base] if block.base else [])], siblings)
    if len(names) < 2:
        hint = "name several with --among, add some under 'scenarios:', or vary something with --vary"
        raise ValueError(f"only {names[0]!r} is there: nothing to choose from; {hint}")
    base = block.base or variant
    return Candidates(tuple(Point(name, {}, name) for name in names), Point(base, {}, base))


def _known(names: Sequence[str], siblings: Sequence[str]) -> None:
    wrong = [name for name in names if name not in siblings]
    if wrong:
        hints = [f"no variant {shown(one)}; {did_you_mean(one, siblings, otherwise='there are')}" for one in wrong]
        raise ValueError("\n".join(hints))


def _grid(factors: Sequence[Factor], variant: str) -> list[Point]:
    ranges = [factor.path for factor in factors if factor.is_range and factor.levels is None]
    if ranges:
        hint = "list values, or let an optimiser look with --search"
        raise ValueError(f"{', '.join(ranges)}: a range has no end of values to choose from; {hint}")
    n = _combinations(factors)
    if n < 2:
        raise ValueError("only one combination: nothing to choose from; give two values or more of something")
    if n > MOST_POINTS:
        raise ValueError(
            f"{n:,} combinations, at most {MOST_POINTS:,} are run one by one; take --search, or fewer values"
        )
    return [named(factors, values, variant) for values in product(*(factor.grid_values() for factor in factors))]


def named(factors: Sequence[Factor], values: Sequence[Any], variant: str) -> Point:
    """The point with these values, called by them."""
    return Point(called(factors, values), {factor.path: value for factor, value in zip(factors, values)}, variant)


def called(factors: Sequence[Factor], values: Sequence[Any]) -> str:
    """``saw 2, every 40 s``: no more of each path than tells it from the others."""
    names = short_names([factor.path for factor in factors])
    return ", ".join(f"{name} {factor.words(value)}" for name, factor, value in zip(names, factors, values))


def short_names(paths: Sequence[str]) -> list[str]:
    """The last part of each path; of those that share it the part before; where that is not enough, the whole path."""
    last = [path.split(".")[-1] for path in paths]
    before = [path.split(".")[-2:][0] for path in paths]
    names = [parent if last.count(end) > 1 else end for end, parent in zip(last, before)]
    return [name if names.count(name) == 1 else path for name, path in zip(names, paths)]


def _combinations(factors: Sequence[Factor]) -> int:
    return prod(len(factor.grid_values()) for factor in factors)


def _to_search(block: Any, factors: Sequence[Factor], base: Point) -> Candidates:
    trials = block.trials or USUAL_TRIALS
    if not any(factor.is_range for factor in factors) and (n := _combinations(factors)) <= trials:
        hint = "without --search all of them are compared"
        raise ValueError(f"a search of {trials} trials, and there are only {n} combinations; {hint}")
    return Candidates((), base, tuple(factors), trials)
