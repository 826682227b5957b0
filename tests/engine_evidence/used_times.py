"""What a Plan uses of tasks: where their times come from, how they are done, how they are left."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from engine_evidence.used_material import reached

from opsim.engine.rules import INTERRUPTION_RULES
from opsim.plan import Plan
from opsim.scenario.schema import DISTRIBUTIONS
from opsim.subjects.tasks.plan import TaskPlan

LAWS = ("Fixed", *(kind.__name__ for kind in DISTRIBUTIONS.values()))
FROM_FILES = ("recorded, resampled", "recorded, trace", "emulated", "motions")
SWITCHES = ("WithinOnly", "BetweenOnly", "NoSpread", "Shuffled")
TIME_WORDS = (
    *(f"time: {name}" for name in (*LAWS, *FROM_FILES, "between workers", *SWITCHES)),
    *(
        "people: redrawn",
        "people: same pace",
        "people: bodies",
        "task: repeat",
        "task: automatic",
        "task: attended",
        "task: team",
    ),
    *("task: attended team", "task: needs", "task: hold by share", "task: hold by marks", "task: per lot"),
    *("task: once for each unit", *(f"task rule: {rule}" for rule in INTERRUPTION_RULES)),
    *(f"cycles: {name}" for name in ("Fixed", "Geometric", "UniformCount")),
    *(f"between stops: {name}" for name in ("Fixed", "Exponential")),
)


def used_tasks(plan: Plan) -> set[int]:
    """Tasks of stations to which jobs can come."""
    return {task for rank in reached(plan) for task in plan.stations[rank].tasks}


def times_of(plan: Plan) -> set[str]:
    """Its words of ``TIME_WORDS``."""
    tasks = [plan.tasks[rank] for rank in used_tasks(plan)]
    lots = any(product.lot > 1 for product in plan.products)
    found = {word for task in tasks for word in (*_law(task.model), *_done(task, lots))}
    found |= {"people: redrawn"} if plan.staffing == "redrawn" else set()
    emulated = {"time: emulated", "time: motions"} & found
    found |= {"people: same pace"} if plan.across_tasks == "same_pace" and emulated else set()
    found |= {"people: bodies"} if emulated and any(worker.body.height_m for worker in plan.workers) else set()
    return found | {*_stops(plan)}


def _law(model: Any) -> Iterator[str]:
    """The law of a time, and the switch that is on it."""
    inner = getattr(model, "_model", model)
    if type(model).__name__ in SWITCHES:
        yield f"time: {type(model).__name__}"
    name = type(inner).__name__
    if name == "Recorded":
        yield "time: recorded, trace" if inner.by_index else "time: recorded, resampled"
    elif name in LAWS:
        yield f"time: {name}"
    else:
        yield "time: motions" if getattr(inner, "knows_parts", False) else "time: emulated"
    if getattr(inner, "between_share", 0.0) > 0:
        yield "time: between workers"


def _done(task: TaskPlan, lots: bool) -> Iterator[str]:
    said = {
        "repeat": task.repeat > 1,
        "automatic": task.automatic,
        "attended": task.attended,
        "team": task.team > 1,
        "attended team": task.team > 1 and task.attended,
        "needs": bool(task.needs),
        "hold by share": task.hold is not None and task.hold.start.mark < 0,
        "hold by marks": task.hold is not None and task.hold.start.mark >= 0,
        "per lot": lots and task.per_lot,
        "once for each unit": lots and not task.per_lot,
    }
    yield from (f"task: {word}" for word, is_so in said.items() if is_so)
    yield from (f"task rule: {task.interruption}",) if task.interruption is not None else ()


def _stops(plan: Plan) -> Iterator[str]:
    for stop in plan.breakdowns:
        yield f"{'cycles' if stop.by == 'cycles' else 'between stops'}: {type(stop.every).__name__}"
