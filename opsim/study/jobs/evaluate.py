"""One job done, in any process: the scenario read, planned, run, audited, and its figures."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import lru_cache
from typing import Any

from opsim.kpi.figure import Figure
from opsim.plan import Plan, compile_plan
from opsim.scenario.read import Loaded
from opsim.scenario.varied import Varied
from opsim.study.jobs.job import Job, Point
from opsim.study.jobs.source import Source

KEPT_VARIANTS, KEPT_PLANS = 16, 4
"""Of what a process has read and planned: jobs come point by point, so that few plans are in use at any time."""


def evaluate(source: Source, job: Job) -> list[Figure]:
    """The figures of a job that the source keeps.

    Raises ScenarioError where the point's changes are wrong, BrokenLog where a run contradicts itself.
    """
    from opsim.engine.simpy_engine import run_plan
    from opsim.kpi import figures
    from opsim.laws import audit

    plan = plan_of(source, job.point)
    if job.workforce is not None:
        plan = replace(plan, workforce=job.workforce)
    log = run_plan(plan, job.replication)
    audit(log, plan)
    return [figure for figure in figures(log, plan, source.kpis) if figure.kpi in source.kpis]


def loaded_of(source: Source, point: Point) -> Loaded:
    """The scenario of a point. Raises ScenarioError with everything that is wrong with its changes."""
    return _variant(source.file, point.variant).with_changes({**source.changes, **point.changes}, point.name)


def plan_of(source: Source, point: Point) -> Plan:
    """The Plan of a point. Raises as ``loaded_of``, ValueError where a library cannot be had."""
    changes = json.dumps(dict(sorted({**source.changes, **point.changes}.items())))
    return _plan(source.file, source.seed, point.variant, changes, point.name)


@lru_cache(KEPT_VARIANTS)
def _variant(file: str, variant: str | None) -> Varied:
    return Varied.read(file, variant)


@lru_cache(KEPT_PLANS)
def _plan(file: str, seed: int | None, variant: str | None, changes: str, name: str) -> Plan:
    said: dict[str, Any] = json.loads(changes)
    return compile_plan(_variant(file, variant).with_changes(said, name), seed=seed)
