"""Workers of somebody's own model as a Plan, so that all that looks at a scenario's rows can look at theirs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from opsim.bodies import BODY_KEYS
from opsim.ergonomics.options import USUAL, Options
from opsim.ergonomics.shift.worker_rows import natural
from opsim.own_luck import OwnLuck
from opsim.plan import Plan
from opsim.plan.handling import NOT_SAID, Handling
from opsim.plan.tasks import TaskPlan
from opsim.plan.worker import Body, WorkerPlan
from opsim.tasks.model import TimeModel


@dataclass(frozen=True, slots=True)
class OwnPlan(Plan):
    """lucks : what decides the draws of each worker, by rank; they need not be of one seed."""

    lucks: tuple[OwnLuck, ...] = ()


def models_of(lucks: Iterable[OwnLuck]) -> dict[str, Any]:
    """The model of each task; the last one's where workers have different ones under one name."""
    return {task: model for luck in lucks for task, model in luck.models.items()}


def groups(lucks: Mapping[str, OwnLuck]) -> list[list[str]]:
    """Names of workers who can be in one plan: those who mean the same by a task's name."""
    found: list[list[str]] = []
    for name in natural(lucks):
        for group in found:
            if all(_agree(lucks[name], lucks[other]) for other in group):
                group.append(name)
                break
        else:
            found.append([name])
    return found


def plan_of(
    lucks: Mapping[str, OwnLuck],
    group: Iterable[str],
    handling: Mapping[str, Handling] | None = None,
    options: Options = USUAL,
    window_s: tuple[float, float] = (0.0, 0.0),
    start_s: float = 0.0,
) -> OwnPlan:
    """A plan of all workers that gives what those of one group do; ranks are the same whatever the group.

    handling : by name of task, before what the workers say themselves
    window_s : from and until when figures count; start_s : when on the clock 0 is
    """
    everybody = tuple(lucks[name] for name in natural(lucks))
    own = [*everybody, *(lucks[name] for name in group)]
    models = models_of(own)
    said = {task: one for luck in own for task, one in luck.handling.items()} | dict(handling or {})
    return OwnPlan(
        name="workers",
        seed=own[-1].seed,
        horizon_s=window_s[1],
        warm_up_s=window_s[0],
        places=(),
        distance_m=(),
        tasks=tuple(
            TaskPlan(name, models[name], repeat=1, automatic=False, handling=said.get(name, NOT_SAID))
            for name in natural(models)
        ),
        stations=(),
        products=(),
        sources=(),
        workers=tuple(_worker(luck) for luck in everybody),
        rule="",
        when_blocked="",
        idle="",
        staffing="fixed",
        across_tasks=own[-1].across_tasks,
        ergonomics=options,
        start_s=start_s,
        lucks=everybody,
    )


def _worker(luck: OwnLuck) -> WorkerPlan:
    read = luck.body.get if isinstance(luck.body, Mapping) else lambda key: getattr(luck.body, key, None)
    return WorkerPlan(luck.worker, 0, 1.0, (1.0,), Body(**{key: read(key) for key in BODY_KEYS}))


def _agree(one: OwnLuck, other: OwnLuck) -> bool:
    shared = one.models.keys() & other.models.keys()
    said = all(one.handling.get(task) == other.handling.get(task) for task in shared)
    return said and all(_alike(one.models[task], other.models[task]) for task in shared)


def _alike(one: Any, other: Any) -> bool:
    """The same bodies, or both none; NOTE: times are drawn by a worker's own model, whatever the plan's."""
    return one is other or (isinstance(one, TimeModel) and isinstance(other, TimeModel))
