"""How long the reference engine would take with a replication: an estimate from loads, without a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from opsim.plan import Plan

VISIT_S = 40e-6
"""Processor seconds for each visit of a job to a station, all rows that come of it included.

NOTE: the shipped scenarios take 5 to 90 microseconds, the middle of them 35: an estimate within a factor of 3.
"""


def simpy_s(plan: Plan) -> float:
    """Processor seconds of one replication, about."""
    return visits(plan) * VISIT_S


def visits(plan: Plan) -> float:
    """Visits of jobs to stations in a run, by mean times; no more than the bottleneck lets through."""
    from opsim.plan.loads import loads_of

    loads = loads_of(plan)
    flows, limits = loads.flows, loads.limits
    most_per_h = limits[0].most_per_h if limits else None
    known_per_h = sum(step.per_h for step in flows.steps)
    if most_per_h is None:
        return known_per_h * plan.horizon_s / 3600
    if not flows.saturated:
        share = min(1.0, most_per_h / flows.per_h) if flows.per_h > 0 else 1.0
        return share * known_per_h * plan.horizon_s / 3600
    return (known_per_h + most_per_h * sum(step.per_job for step in flows.steps)) * plan.horizon_s / 3600
