"""Which stream of luck stands behind the id that the engine has for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from opsim.engine.fast_engine.luck.draws import BlockDraws
from opsim.engine.fast_engine.parts import luck
from opsim.plan import Plan

Named = Callable[[BlockDraws, Plan, int, int, int], Any]


def _chance(word: str) -> Named:
    """Of (operation, source, visit)."""
    return lambda draws, plan, operation, source, visit: draws.chances(
        (word, plan.operations[operation], plan.sources[source].name, visit)
    )


def _hold(plan: Plan, task: int) -> Any:
    """The hold of a task that has one."""
    return plan.tasks[task].hold


NAMED: dict[int, Named] = {
    luck.DURATION: lambda draws, _plan, worker, task, _: draws.durations(task, worker),
    luck.AUTOMATIC: lambda draws, _plan, station, task, _: draws.automatic_runs(task, station),
    luck.HOLD: lambda draws, plan, worker, task, _: draws.durations_with(_hold(plan, task), task, worker),
    luck.HOLD_RUN: lambda draws, plan, station, task, _: draws.runs_with(_hold(plan, task), task, station),
    luck.GAP: lambda draws, _plan, source, *_: draws.gaps(source),
    luck.MIX: lambda draws, _plan, source, *_: draws.products(source),
    luck.REPAIR: lambda draws, plan, stop, *_: draws.repairs(plan.stops[stop]),
    luck.UPTIME: lambda draws, plan, stop, *_: draws.uptimes(plan.breakdowns[stop]),
    luck.ROUTING: _chance("routing"),
    luck.YIELD: _chance("yield"),
    luck.QUALITY: _chance("quality"),
    luck.START: lambda draws, _plan, source, *_: draws.ways("start", 0, source),
    luck.ABSENCE: lambda draws, plan, worker, *_: draws.chances(("absence", plan.workers[worker].name)),
}
"""By purpose, the stream of up to three ranks."""
