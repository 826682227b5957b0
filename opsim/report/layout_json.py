"""A layout study for machines."""

from __future__ import annotations

from typing import Any

from opsim.study.layout.flows import Flow
from opsim.study.layout.judge import Against
from opsim.study.layout.moves import Candidate
from opsim.study.layout.study import LayoutFound
from opsim.study.layout.words import said


def summary(found: LayoutFound) -> dict[str, Any]:
    """What came out, for machines."""
    return {
        "replications": found.asked.replications,
        "best": found.asked.best.name,
        "exposure": None if found.asked.exposure is None else found.asked.exposure.name,
        "taken": None if found.taken is None else found.taken.name,
        "gains": found.gains,
        "losses": found.losses,
        "alike": list(found.alike),
        "all_together_left_out": found.asked.clash or None,
        "fresh": {name: _numbers(one) for name, one in found.fresh.items()},
        "layouts": [_as_json(found, one) for one in found.candidates],
        "proposals": _made(found),
        "flows": [_flow_json(flow) for flow in found.flows.largest_first()],
        "walked_m_per_h": found.flows.walked_m_per_h,
    }


def _made(found: LayoutFound) -> dict[str, Any] | None:
    made = found.proposals
    if made is None:
        return None
    names = ("exact", "tried", "now_m_per_h", "best_m_per_h")
    return {name: getattr(made, name) for name in names}


def _as_json(found: LayoutFound, one: Candidate) -> dict[str, Any]:
    return {
        "name": one.name,
        "what": said(found.asked.floor.at, one),
        "proposed": one.proposed,
        "changes": dict(one.changes),
        "predicted_m_per_h": one.predicted_m_per_h,
        "against_now": {name: _numbers(of) for name, of in found.compared[one.name].items()},
    }


def _numbers(one: Against) -> dict[str, Any]:
    difference = one.difference
    return {
        "now": one.now.mean,
        "then": one.then.mean,
        "difference": difference.mean,
        "low": difference.low,
        "high": difference.high,
        "n": difference.n,
        "p": one.p,
        "p_holm": one.p_together,
    }


def _flow_json(flow: Flow) -> dict[str, Any]:
    return {
        "between": [flow.start, flow.end],
        "trips_per_h": float(flow.trips_per_h),
        "with_a_job_per_h": flow.with_a_job_per_h,
        "distance_m": flow.distance_m,
        "metres_per_h": float(flow.metres_per_h),
    }
