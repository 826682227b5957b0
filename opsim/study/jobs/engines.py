"""Which engine answers the jobs of a study: looked at before any of them is begun, and compiled once, here."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Any

from opsim.engine.choice import (
    AUTO,
    FAST,
    REFERENCE,
    SIMPY,
    Choice,
    NotFast,
    Told,
    able_to,
    known,
    make_ready,
    simpy_s,
    worth,
)
from opsim.plan import Plan
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

    def __init__(self, source: Source, asked: str = SIMPY, chosen: Chosen | None = None, at_once: int = 1):
        """chosen : told each choice that is new; what it gives back is told how far the compiling is

        at_once : so many jobs may be computed at the same time
        """
        self._source, self._chosen, self._at_once = source, chosen, at_once
        self.asked = known(asked)
        self.choices: dict[Shape, Choice] = {}
        self._shapes: dict[Point, Shape] = {}
        self._told: dict[str, Told | None] = {}
        self._n_jobs, self._simpy_s = 0, 0.0

    def prepare(self, jobs: Collection[Job], *, here: bool = True) -> None:
        """Look at the points of jobs that are to be computed now; compile what they need, unless other machines do.

        Raises ScenarioError with everything in them that the fast engine does not run, where it is asked for.
        """
        if self.asked == SIMPY:
            self._tell(REFERENCE)
            return
        new = {shape: points for shape, points in self._alike(jobs).items() if self._is_open(shape)}
        able = self._able({shape: next(iter(points)) for shape, points in new.items()})
        if self.asked == AUTO:
            self._add_work(new[shape] for shape, choice in able.items() if choice.engine == FAST)
        for shape, could in able.items():
            plan = self._plan_of(next(iter(new[shape])))
            choice = worth(could, plan, self._simpy_s / max(1, min(self._at_once, self._n_jobs)), here=here)
            told = self._tell(choice)
            self.choices[shape] = choice
            if here:
                make_ready(choice, plan, told)

    def of(self, point: Point) -> str:
        """What ``evaluate`` is to be given for a point that was looked at: ``simpy``, or what was asked for."""
        found = self.choices.get(self._shape_of(point)) if self.asked != SIMPY else None
        return SIMPY if found is None or found.engine == SIMPY else self.asked

    def _is_open(self, shape: Shape) -> bool:
        return shape not in self.choices or self.choices[shape].may_pay

    def _able(self, firsts: Mapping[Shape, Point]) -> dict[Shape, Choice]:
        """What can run a point of each shape. Raises ScenarioError."""
        able, wrong = dict[Shape, Choice](), list[Problem]()
        for shape, point in firsts.items():
            try:
                able[shape] = able_to(self.asked, self._plan_of(point))
            except NotFast as error:
                wrong += problems_of(error, tree_of(self._source, point), Path(self._source.file))
        if wrong:
            raise ScenarioError(dict.fromkeys(wrong))
        return able

    def _add_work(self, alike: Iterable[dict[Point, int]]) -> None:
        """What SimPy would take for more jobs: by the first and the last point of those that are alike."""
        for points in alike:
            ends = {next(iter(points)), next(reversed(points))}
            n_jobs = sum(points.values())
            self._n_jobs += n_jobs
            self._simpy_s += n_jobs * sum(simpy_s(self._plan_of(point)) for point in ends) / len(ends)

    def _alike(self, jobs: Iterable[Job]) -> dict[Shape, dict[Point, int]]:
        """How many jobs each point has, by what points have in common."""
        found: dict[Shape, dict[Point, int]] = {}
        for job in jobs:
            points = found.setdefault(self._shape_of(job.point), {})
            points[job.point] = points.get(job.point, 0) + 1
        return found

    def _plan_of(self, point: Point) -> Plan:
        return plan_of(self._source, point)

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
    """What a point has in common with those that differ from it in numbers alone: signs, units and words stay.

    So do 0, 1 and 100 %: a team of one is no team, a yield of 100 % no quality.
    """
    return point.variant, tuple(sorted((path, _shape(value)) for path, value in point.changes.items()))


def _shape(value: Any) -> Any:
    if isinstance(value, bool) or value is None:
        return str(value)
    if isinstance(value, int | float):
        return f"{(value > 0) - (value < 0):+d}{' one' if value == 1 else ''}"
    if isinstance(value, str):
        quantity = _QUANTITY.fullmatch(value)
        return value if quantity is None else _shape_of_quantity(*quantity.groups(default=""))
    if isinstance(value, dict):
        return repr(sorted((str(key), _shape(one)) for key, one in value.items()))
    return repr([_shape(one) for one in value])


def _shape_of_quantity(sign: str, digits: str, exponent: str, unit: str) -> str:
    number = float(digits + exponent)
    whole = {"": 1, "%": 100}.get(unit.strip())
    return f"{sign}{'0' if number == 0 else 'one' if number == whole else 'some'} {unit}"
