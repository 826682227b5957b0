"""What lies between two plain values of a scenario: numbers, quantities with their unit, and lists of them.

What a study varies: dotted paths, each with a list of values or a range.

Figures as a scenario names them: ``throughput_per_h``, ``walked_m/ana``, ``less walked_m/ana``.

Many points of some factors: what is asked.
"""

from __future__ import annotations

import math
import re
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from opsim.kpi.catalogue import KPIS, AskedFigure, read_asked
from opsim.problems import did_you_mean, shown
from opsim.scenario.fields import Whole, plain_error
from opsim.scenario.tree import Block

_QUANTITY = re.compile(
    r"\s*([-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*([^\W\d_]+(?:/[^\W\d_]+)?|\u00b0)\s*"
)
_STEPS = 4
"""Digits of a range that a value in it is written with: finer ones would show how it was computed, and no more."""


class NotARange(ValueError):
    """Two values between which nothing lies: ``message`` in plain words, ``hint`` the way out."""

    def __init__(self, message: str, hint: str = ""):
        super().__init__(f"{message}; {hint}" if hint else message)
        self.message, self.hint = message, hint


def number_of(value: Any) -> tuple[float, str] | None:
    """(number, unit) of a plain value, ``""`` where it has no unit; None where it is no number: ``"40 s"``, 4."""
    if isinstance(value, bool):
        return None
    if isinstance(value, int | float):
        return (float(value), "") if math.isfinite(value) else None
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    return None if match is None else (float(match[1]), match[2])


def is_whole(low: Any, high: Any) -> bool:
    """Whether only whole numbers lie between two values."""
    return all(isinstance(end, int) and not isinstance(end, bool) for end in (low, high))


def check_range(low: Any, high: Any) -> None:
    """Raises NotARange where nothing lies between two values, or they are not in order."""
    if isinstance(low, list) and isinstance(high, list):
        _check_lists(low, high)
        return
    (first, unit), (last, other) = _known(low), _known(high)
    if unit != other:
        said = [f"'{one}'" if one else "no unit" for one in (unit, other)]
        raise NotARange(f"the ends of a range need the same unit, found {said[0]} and {said[1]}", "write both alike")
    if not first < last:
        what = "are the same" if first == last else "are the wrong way round"
        raise NotARange(f"the ends of the range, {shown(low)} and {shown(high)}, {what}", "the lower one comes first")


def between(low: Any, high: Any, share: float) -> Any:
    """The value at a share of the way, from 0 (low) to 1 (high), as a file has it: ``52.5 s``, ``[7 m, 1 m]``.

    Between whole numbers every one of them has the same part of the way.
    """
    if isinstance(low, list):
        return [_way(a, b, share) for a, b in zip(low, high)]
    if is_whole(low, high):
        return min(high, low + math.floor(share * (high - low + 1)))
    if share in (0, 1):
        return high if share else low
    (first, unit), (last, _) = _known(low), _known(high)
    number = round(first + share * (last - first), _STEPS - math.floor(math.log10(last - first)))
    number = min(max(number, first), last)  # an end may have more digits than what lies in between
    return f"{number:.12g} {unit}" if unit else number


def _way(a: Any, b: Any, share: float) -> Any:
    """Of a part of a list, which may also go down."""
    if a == b:
        return a
    return between(a, b, share) if _known(a)[0] < _known(b)[0] else between(b, a, 1 - share)


def steps(low: Any, high: Any, levels: int) -> list[Any]:
    """So many values at even steps, both ends among them; of whole numbers no more than there are."""
    if is_whole(low, high):
        found = [low + round(k * (high - low) / (levels - 1)) for k in range(levels)]
        return list(dict.fromkeys(found))
    return [between(low, high, k / (levels - 1)) for k in range(levels)]


def _known(end: Any) -> tuple[float, str]:
    found = number_of(end)
    if found is None:
        hint = "a range goes between numbers, or quantities with one unit such as '90 s'; others are given as a list"
        raise NotARange(f"{shown(end)} cannot be the end of a range", hint)
    return found


def _check_lists(low: list[Any], high: list[Any]) -> None:
    if len(low) != len(high):
        raise NotARange(f"the ends of a range need to be alike, found lists of {len(low)} and {len(high)}")
    if low == high:
        raise NotARange("the ends of the range are the same")
    for a, b in zip(low, high):
        if a != b:
            check_range(*sorted((a, b), key=lambda end: _known(end)[0]))


class Range(Block):
    """From one value to another of the same unit, both ends included."""

    low: Any = Field(alias="from", description="the least value, with its unit", examples=["40 s"])
    high: Any = Field(alias="to", description="the largest value, with its unit", examples=["60 s"])
    levels: Whole | None = Field(
        None, ge=2, le=1000, description="of a grid: so many values, both ends among them", examples=[3]
    )

    @model_validator(mode="after")
    def _is_a_range(self) -> Range:
        try:
            check_range(self.low, self.high)
        except NotARange as error:
            raise plain_error(error.message, error.hint) from None
        return self


def _refuse_twice(values: list[Any]) -> None:
    """A value that stands twice would count for two."""
    seen: set[str] = set()
    for number, value in enumerate(values):
        written = repr(value)
        if written in seen:
            raise plain_error(f"{shown(value)} stands twice among the values", "give each value once", on=number)
        seen.add(written)


def _list_or_range(value: object) -> object:
    if isinstance(value, list) and value:
        _refuse_twice(value)
        return value
    if isinstance(value, dict | Range):
        return value
    hint = "such as [40 s, 50 s] or {from: 40 s, to: 60 s}"
    raise plain_error(f"expected values or a range, found {shown(value)}", hint)


def _tag(value: object) -> str:
    return "<values>" if isinstance(value, list) else "<range>"


Factor = Annotated[
    Annotated[Range, Tag("<range>")] | Annotated[list[Any], Tag("<values>")],
    Discriminator(_tag),
    BeforeValidator(_list_or_range),
]
Factors = Annotated[
    dict[str, Factor],
    Field(
        min_length=1,
        description="dotted path of the scenario: values, or a range {from: 40 s, to: 60 s}",
        examples=["{stations.saw.buffer: [1, 2, 4], release.every: {from: 40 s, to: 60 s}}"],
    ),
]


def _known_figure(value: object) -> AskedFigure:
    if not isinstance(value, str):
        raise plain_error(f"expected a figure, found {shown(value)}", "such as throughput_per_h")
    asked = read_asked(value)
    if asked.kpi not in KPIS:
        raise plain_error(f"unknown figure {shown(asked.kpi)}", did_you_mean(asked.kpi, KPIS))
    return asked


def _figure(value: object) -> object:
    _known_figure(value)
    return value


def _with_a_way(value: object) -> object:
    asked = _known_figure(value)
    if not asked.better:
        hint = f"write 'more {asked.name}' or 'less {asked.name}'"
        raise plain_error(f"nothing says whether more or less of {asked.name} is better", hint)
    return value


FigureText = Annotated[str, BeforeValidator(_figure)]
"""A KPI with the subject and the part that are meant, if any, as text; ``read_asked`` takes it apart."""
WayFigureText = Annotated[str, BeforeValidator(_with_a_way)]
"""As FigureText, and which way is better is known: from the KPI, or from ``more`` or ``less`` before it."""


Design = Literal["grid", "list", "one_at_a_time", "latin_hypercube", "sobol", "sobol_indices", "morris"]
FILLING = ("latin_hypercube", "sobol")
"""Designs that spread their points over the whole room."""
SENSITIVITY = ("sobol_indices", "morris")
COUNTED = (*FILLING, *SENSITIVITY)
"""Designs of as many points as are asked for."""


class Sweep(Block):
    """Many points of some factors."""

    vary: Factors | None = None
    design: Design | None = Field(
        None,
        description="grid: every combination; list: the points given; one_at_a_time: each factor's ends alone; "
        "latin_hypercube, sobol: points spread over the ranges; sobol_indices, morris: which factor matters, alone "
        "and with others (by SALib). By default list where points are given, grid where every factor is a list or has "
        "levels, else latin_hypercube",
        examples=["grid"],
    )
    points: Whole | list[dict[str, Any]] | None = Field(
        None,
        description="how many points a latin_hypercube or sobol has; how many base points sobol_indices and how many "
        "paths morris has; or a list of points, each a block of paths and values",
        examples=[64],
    )
    levels: Whole | None = Field(
        None, ge=2, le=1000, description="of a grid: how many values every range has", examples=[3]
    )
    replications: Whole | None = Field(
        None,
        ge=1,
        le=1_000_000,
        description="of each point, the same luck in all; by default as the scenario runs",
        examples=[20],
    )
    figures: list[FigureText] | None = Field(
        None,
        min_length=1,
        description="figures that are told, such as 'throughput_per_h' or 'less walked_m/ana'; by default the outputs",
        examples=[["throughput_per_h"]],
    )

    @property
    def chosen(self) -> Design:
        """The design that is meant."""
        if self.design is not None:
            return self.design
        if isinstance(self.points, list):
            return "list"
        ranges = [one for one in (self.vary or {}).values() if isinstance(one, Range)]
        counted = self.points is not None or any(one.levels is None and self.levels is None for one in ranges)
        return "latin_hypercube" if counted else "grid"

    @model_validator(mode="after")
    def _fits_together(self) -> Sweep:
        design, points = self.chosen, self.points
        if design == "list":
            self._check_list()
        elif not self.vary:
            raise plain_error("nothing says what is varied", "add e.g. vary: {release.every: [40 s, 50 s]}")
        elif isinstance(points, list):
            raise plain_error(f"a list of points is no {design}", "leave the design out, or give a number", on="points")
        elif points is not None and not 2 <= points <= 1_000_000:
            raise plain_error(f"must be from 2 to 1000000 points, found {points}", on="points")
        if design == "grid":
            self._check_levels()
        return self

    def _check_list(self) -> None:
        if self.vary:
            raise plain_error("points are given one by one, so nothing is left to vary", "keep one of both", on="vary")
        if not isinstance(self.points, list) or not self.points or not all(self.points):
            found = "the design list needs its points, each a block of paths and values"
            raise plain_error(found, "such as points: [{release.every: 40 s}, {release.every: 50 s}]", on="points")

    def _check_levels(self) -> None:
        for path, one in (self.vary or {}).items():
            if isinstance(one, Range) and one.levels is None and self.levels is None:
                found = f"a grid needs to know how many values the range of {path} has"
                raise plain_error(found, "add e.g. levels: 3, or take the design latin_hypercube", on="vary")
