"""One job done, in any process: the scenario read, planned, run, audited, and its figures.

Which engine answers the jobs of a study: looked at before any of them is begun, and compiled once, here.

What decides the answers of a point: its answers are found again only where all of it is the same.

A job done in whatever process it was sent to: first it is made sure that this process would answer as others do.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from threading import Lock
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
    runner_of,
    simpy_s,
    worth,
)
from opsim.kpi.catalogue import Figure
from opsim.plan import Plan, compile_plan
from opsim.problems import Problem, ScenarioError
from opsim.scenario.schema.scenario import Loaded
from opsim.scenario.study_checks import Varied
from opsim.scenario.templates import without_likes
from opsim.scenario.tree import Node
from opsim.study.engine_choice import Chosen, problems_of
from opsim.study.jobs.job import Answer, Job, Point, Source
from opsim.study.resolved_scenario import decides_figures
from opsim.study.results_folder import deciding, manifest_of
from opsim.threads import one_blas_thread

Key = tuple[str, int | None, str | None, str, str]
KEPT_VARIANTS, KEPT_PLANS = 16, 4
"""Of what a process has read and planned: jobs come point by point, so that few plans are in use at any time."""


def evaluate(source: Source, job: Job, engine: str = SIMPY) -> list[Figure]:
    """The figures of a job that the source keeps; engine : as asked for, where ``auto`` is what can run it.

    Raises ScenarioError where the point's changes are wrong, NotFast where the fast engine is asked for and cannot run
    it, BrokenLog where a run contradicts itself.
    """
    from opsim.kpi import figures
    from opsim.laws.audit import audit

    key = _key(source, job.point)
    plan = _plan(*key) if job.workforce is None else _staffed(job.workforce, *key)
    log = runner_of(_choice(engine, *key))(plan, job.replication)
    audit(log, plan)
    return [figure for figure in figures(log, plan, source.kpis) if figure.kpi in source.kpis]


def loaded_of(source: Source, point: Point) -> Loaded:
    """The scenario of a point. Raises ScenarioError with everything that is wrong with its changes."""
    return _variant(source.file, point.variant).with_changes({**source.changes, **point.changes}, point.name)


def tree_of(source: Source, point: Point) -> Node:
    """What stands in the file and in the changes of a point, ``like`` filled in, each with its place."""
    changes = {**source.changes, **point.changes}
    return without_likes(_variant(source.file, point.variant).laid(changes).tree)[0]


def plan_of(source: Source, point: Point) -> Plan:
    """The Plan of a point. Raises as ``loaded_of``, ValueError where a library cannot be had."""
    return _plan(*_key(source, point))


def _key(source: Source, point: Point) -> Key:
    """What decides the Plan of a point, beside files, and its name."""
    changes = json.dumps(dict(sorted({**source.changes, **point.changes}.items())))
    return source.file, source.seed, point.variant, changes, point.name


@lru_cache(KEPT_VARIANTS)
def _variant(file: str, variant: str | None) -> Varied:
    return Varied.read(file, variant)


@lru_cache(KEPT_PLANS)
def _plan(file: str, seed: int | None, variant: str | None, changes: str, name: str) -> Plan:
    said: dict[str, Any] = json.loads(changes)
    return compile_plan(_variant(file, variant).with_changes(said, name), seed=seed)


@lru_cache(KEPT_PLANS)
def _staffed(workforce: int, *key: Any) -> Plan:
    """A Plan with its people: one object for all of their days, as the fast engine uses the floor of a Plan again."""
    return replace(_plan(*key), workforce=workforce)


@lru_cache(KEPT_PLANS)
def _choice(engine: str, *key: Any) -> Choice:
    """What runs a Plan, found once and not for each of its replications."""
    return able_to(engine, _plan(*key))


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


ASKED_ONLY = ("outputs", "frontier")
"""What decides neither rows nor figures of a scenario, only which figures stand in front."""


def made_from(source: Source, variant: str | None) -> dict[str, Any]:
    """Everything that decides the answers of a variant without a point's changes, and the versions that make them.

    Raises ScenarioError, OSError.
    """
    held: dict[str, Any] = json.loads(_made_from(source.file, source.seed, variant, _text(source.changes)))
    return held


def decided_by(source: Source, point: Point) -> str:
    """16 hex digits that tell the answers of a point from those of any other: by its variant, changes, the seed, the
    contents of all files, and versions. Raises as ``made_from``.
    """
    variant = deciding(made_from(source, point.variant))
    files = _files_named(source, point)
    return hashlib.blake2b(_text([variant, point.key, files]).encode(), digest_size=8).hexdigest()


@lru_cache(256)
def _made_from(file: str, seed: int | None, variant: str | None, changes: str) -> str:
    source = Source(file, (), seed, json.loads(changes))
    loaded = loaded_of(source, Point(variant or "", {}, variant))
    manifest = manifest_of(loaded, loaded.scenario.run.seed if seed is None else seed)
    figures = {path: value for path, value in decides_figures(loaded.resolved).items() if path not in ASKED_ONLY}
    return _text({**manifest, "figures_sha256": hashlib.sha256(_text(figures).encode()).hexdigest()})


def _files_named(source: Source, point: Point) -> dict[str, str]:
    """The contents of files that changes name, such as another library: the variant's own are in its manifest."""
    named = {text for text in _texts([dict(source.changes), dict(point.changes)]) if len(text) < 256}
    if not named:
        return {}
    folder = _folder(source.file)
    return {name: _sha256(folder / name) for name in sorted(named) if "." in name and (folder / name).is_file()}


@lru_cache(4)
def _folder(file: str) -> Path:
    from opsim.shipped import find_scenario

    return find_scenario(file).parent


@lru_cache(256)
def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for below in value.values():
            yield from _texts(below)
    elif isinstance(value, list | tuple):
        for below in value:
            yield from _texts(below)


def _text(value: Any) -> str:
    return json.dumps(value, sort_keys=True, default=dict)


_one_at_a_time = Lock()
"""Threads of one process share what was planned, and one after the other they are no slower: they share Python too."""


class OtherProcess(Exception):
    """A process with other versions or other files; ``made`` is the JSON text of what its answers are made from."""

    def __init__(self, made: str):
        super().__init__(made)
        self.made: dict[str, Any] = json.loads(made)


class NotThere(Exception):
    """A process that cannot read the scenario or one of its files; the text says which."""


def answer(source: Source, job: Job, engine: str = SIMPY) -> Answer:
    """The answer to a job, on one BLAS thread. Raises as ``evaluate``."""
    with _one_at_a_time, one_blas_thread():
        return Answer.of(evaluate(source, job, engine))


def answer_far_away(source: Source, job: Job, decided: str, engine: str = SIMPY) -> Answer:
    """As ``answer``, in a process of which nothing is known.

    decided : what decides the answer, as who asks knows it. Raises OtherProcess where that is not the same here,
        NotThere.
    """
    try:
        with _one_at_a_time:
            same = decided_by(source, job.point) == decided
    except (ScenarioError, OSError) as error:
        raise NotThere(str(error)) from None
    if not same:
        raise OtherProcess(json.dumps(made_from(source, job.point.variant)))
    return answer(source, job, engine)
