"""Which engine answers the jobs of a study: looked at before any of them is begun, and compiled once, here."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Any

from opsim.engine.choice import REFERENCE, SIMPY, Choice, NotFast, Told, choose, known, make_ready
from opsim.problems import Problem, ScenarioError
from opsim.study.engine_choice import Chosen, problems_of
from opsim.study.jobs.evaluate import plan_of, tree_of
from opsim.study.jobs.job import Job, Point
from opsim.study.jobs.source import Source

_QUANTITY = re.compile(r"\s*([+-]?)([0-9]*\.?[0-9]+|[0-9]+\.)(e[+-]?[0-9]+)?\s*(\D*)", re.IGNORECASE)
Shape = tuple[Any, ...]


class Engines:
    """The engine of every point. Points that differ in numbers alone need the same compiled code and are looked at
    once, so that a design of thousands of points is not planned here before it is planned where it is computed.
    """

    def __init__(self, source: Source, asked: str = SIMPY, chosen: Chosen | None = None):
        """chosen : told each choice that is new; what it gives back is told how far the compiling is"""
        self._source, self._chosen = source, chosen
        self.asked = known(asked)
        self.choices: dict[Shape, Choice] = {}
        self._shapes: dict[Point, Shape] = {}
        self._told: dict[str, Told | None] = {}
        self._runs = 0

    def prepare(self, jobs: Collection[Job], *, compile_here: bool = True) -> None:
        """Look at the points of jobs that are to be computed now; compile what they need, unless others compute them.

        Raises ScenarioError with everything in them that the fast engine does not run, where it is asked for.
        """
        self._runs += len(jobs)
        if self.asked == SIMPY:
            self._tell(REFERENCE)
            return
        new, wrong = dict[Shape, tuple[Point, Choice]](), list[Problem]()
        for shape, point in self._first_of_each(dict.fromkeys(job.point for job in jobs)).items():
            if shape in self.choices and not self.choices[shape].may_pay:
                continue
            try:
                new[shape] = point, choose(self.asked, plan_of(self._source, point), self._runs)
            except NotFast as error:
                wrong += problems_of(error, tree_of(self._source, point), Path(self._source.file))
        if wrong:
            raise ScenarioError(dict.fromkeys(wrong))
        for shape, (point, choice) in new.items():
            told = self._tell(choice)
            self.choices[shape] = choice
            if compile_here:
                make_ready(choice, plan_of(self._source, point), told)

    def of(self, point: Point) -> str:
        """What ``evaluate`` is to be given for a point that was looked at: ``simpy``, or what was asked for."""
        found = self.choices.get(self._shape_of(point)) if self.asked != SIMPY else None
        return SIMPY if found is None or found.engine == SIMPY else self.asked

    def _first_of_each(self, points: Iterable[Point]) -> dict[Shape, Point]:
        found: dict[Shape, Point] = {}
        for point in points:
            found.setdefault(self._shape_of(point), point)
        return found

    def _shape_of(self, point: Point) -> Shape:
        if point not in self._shapes:
            self._shapes[point] = shape_of(point)
        return self._shapes[point]

    def _tell(self, choice: Choice) -> Told | None:
        """Whom to tell how far the compiling is; a choice is told once for each engine."""
        if choice.engine not in self._told:
            self._told[choice.engine] = None if self._chosen is None else self._chosen(choice)
        return self._told[choice.engine]


def shape_of(point: Point) -> Shape:
    """What a point has in common with those that differ from it in numbers alone: signs, units and words stay."""
    return point.variant, tuple(sorted((path, _shape(value)) for path, value in point.changes.items()))


def _shape(value: Any) -> Any:
    if isinstance(value, bool) or value is None:
        return str(value)
    if isinstance(value, int | float):
        return f"{(value > 0) - (value < 0):+d}"
    if isinstance(value, str):
        quantity = _QUANTITY.fullmatch(value)
        return value if quantity is None else f"{quantity[1]}{'0' if float(quantity[2]) == 0 else '1'} {quantity[4]}"
    if isinstance(value, dict):
        return repr(sorted((str(key), _shape(one)) for key, one in value.items()))
    return repr([_shape(one) for one in value])
