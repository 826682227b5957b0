"""A Plan as far as its run has come."""

from __future__ import annotations

from dataclasses import replace

from opsim.plan.calendar import OPEN, Duty
from opsim.plan.plan import Plan


def until(plan: Plan, end_s: float) -> Plan:
    """The Plan with its horizon at an earlier time, in seconds from its start; no warm-up where that is not over."""
    if end_s >= plan.horizon_s:
        return plan
    return replace(
        plan,
        horizon_s=end_s,
        warm_up_s=plan.warm_up_s if plan.warm_up_s < end_s else 0.0,
        stations=tuple(replace(one, open_s=_open_until(one.open_s, end_s)) for one in plan.stations),
        sources=tuple(
            replace(
                one,
                open_s=_open_until(one.open_s, end_s),
                orders=tuple(order for order in one.orders if order.time_s <= end_s),
            )
            for one in plan.sources
        ),
        workers=tuple(replace(one, duties=_duties_until(one.duties, end_s)) for one in plan.workers),
    )


def _open_until(open_s: OPEN | None, end_s: float) -> OPEN | None:
    if open_s is None:
        return None
    return tuple((from_s, min(to_s, end_s)) for from_s, to_s in open_s if from_s < end_s)


def _duties_until(duties: tuple[Duty, ...] | None, end_s: float) -> tuple[Duty, ...] | None:
    return None if duties is None else tuple(_cut(one, end_s) for one in duties if one.start_s < end_s)


def _cut(duty: Duty, end_s: float) -> Duty:
    pauses = tuple(replace(one, end_s=min(one.end_s, end_s)) for one in duty.pauses if one.start_s < end_s)
    cut = duty.cut or duty.end_s > end_s
    return replace(duty, end_s=min(duty.end_s, end_s), pauses=pauses, cut=cut)
