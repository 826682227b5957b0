"""What a sweep says beside its answer: what was not varied or not used, and how its page is to be read."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from opsim.report.frontier import axis_name
from opsim.report.words import listing

DESIGNS = {
    "grid": "every combination",
    "list": "points given one by one",
    "one_at_a_time": "one factor at a time, the others as they are",
    "latin_hypercube": "Latin hypercube",
    "sobol": "scrambled Sobol sequence",
    "sobol_indices": "Saltelli's design for Sobol indices",
    "morris": "Morris' paths, one factor moving at a time",
}


def beside_answer(points: Any, found: Sequence[Any]) -> list[str]:
    """What else has to be known. points : the Points; found : a Found for each figure"""
    return [*_not_varied(points, found), *points.warned, *_hours(points, found)]


def _not_varied(points: Any, found: Sequence[Any]) -> Iterator[str]:
    """A word on factors of which there is one value only."""
    single = [factor.path for factor in points.factors if not factor.is_range and len(factor.values) == 1]
    if points.design == "one_at_a_time" and found:  # there, what the scenario has is another value
        single = [path for path in single if path not in [one.name for one in found[0].swings]]
    if single:
        has = "has one value, so it was" if len(single) == 1 else "have one value each, so they were"
        yield f"{listing(single)} {has} not varied."


def _hours(points: Any, found: Sequence[Any]) -> Iterator[str]:
    """A word on figures per scheduled hour where it is varied what is scheduled."""
    from opsim.study.compare import PER_CALENDAR_HOUR, PER_SCHEDULED_HOUR

    varied = [f.path for f in points.factors if {"shift", "shifts"} & set(f.path.split("."))]
    of = [axis_name(one.key) for one in found if one.key[0] in PER_SCHEDULED_HOUR]
    if varied and of:
        yield (
            f"{listing(varied)} may change which hours are scheduled, and {listing(of)} is per scheduled hour: points "
            f"with other hours are not comparable in it. Take --figure {PER_CALENDAR_HOUR}."
        )


def how_to_read(points: Any, found: Sequence[Any], replications: int, seed: int) -> list[str]:
    """What the page says of its intervals and its fit."""
    n = len(points.values)
    each = "1 replication" if replications == 1 else f"{replications} replications"
    said = [
        f"{n:,} points ({DESIGNS[points.design]}), {each} of each, with the same random numbers at every point "
        f"(seed {seed}).",
        *points.words,
    ]
    if any(one.swings for one in found):
        said.append(
            "Differences are paired, replication by replication; each 95 % interval is for its factor alone, and "
            "counts that the two levels furthest apart were picked (Bonferroni). 'Clear' holds for all factors of a "
            "figure together (Holm)."
        )
    if any(one.how == "fit" and one.swings for one in found):
        said.append(
            "Differences by the fitted response carry its own error too: by how much it misses the points beyond luck."
        )
    if any(one.response is not None for one in found):
        said.append(
            "The fitted response is the polynomial, linear or with squares and interactions, that misses points left "
            "out by least. The intervals of its terms say how replications differ, not how far the polynomial is from "
            "the truth; the error for points left out says that. (Kleijnen 2015; Montgomery 2013)"
        )
    if any(one.sensitivity for one in found):
        said.append("Intervals are by bootstrap over the design (95 %), by SALib (Saltelli 2010; Morris 1991).")
    if any(one.best is not None for one in found):
        said.append(
            "The best of many points is partly lucky: 'opsim select' says with a promise which one is best, on fresh "
            "random numbers."
        )
    return said
