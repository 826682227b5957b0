"""One job done, in any process: the scenario read, planned, run, audited, and its figures."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import lru_cache
from typing import Any

from opsim.engine.choice import SIMPY, Choice, able_to, runner_of
from opsim.kpi.figure import Figure
from opsim.plan import Plan, compile_plan
from opsim.scenario.like import without_likes
from opsim.scenario.positions import Node
from opsim.scenario.read import Loaded
from opsim.scenario.varied import Varied
from opsim.study.jobs.job import Job, Point
from opsim.study.jobs.source import Source

Key = tuple[str, int | None, str | None, str, str]
KEPT_VARIANTS, KEPT_PLANS = 16, 4
"""Of what a process has read and planned: jobs come point by point, so that few plans are in use at any time."""


def evaluate(source: Source, job: Job, engine: str = SIMPY) -> list[Figure]:
    """The figures of a job that the source keeps; engine : as asked for, where ``auto`` is what can run it.

    Raises ScenarioError where the point's changes are wrong, NotFast where the fast engine is asked for and cannot run
    it, BrokenLog where a run contradicts itself.
    """
    from opsim.kpi import figures
    from opsim.laws import audit

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
