"""Whether people differ in a scenario, and changes of who they are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from opsim.plan import Plan
from opsim.scenario.read import Loaded


def whole_workers(loaded: Loaded, edits: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Changes that say all workers anew, by name, each with some keys replaced; names that are new are added.

    All of them are said: who is ``like`` another, or one of a workforce, would otherwise change with him.
    """
    workers: dict[str, Any] = {name: {**said} for name, said in loaded.resolved["workers"].items()}
    for name, keys in edits.items():
        workers[name] = {**workers.get(name, {}), **keys}
    changes: dict[str, Any] = {"workers": workers}
    if loaded.scenario.workforce is not None:
        changes["workforce"] = None
    return changes


def people_differ(plan: Plan) -> bool:
    """Whether another workforce takes other times: whether a task that people do draws an effect for its worker.

    Who is a recorded person is the same in every workforce.
    """
    from opsim.effects import worker_effect

    drawn = [worker for worker in plan.workers if not _recorded(worker.body)]
    by_hand = [task for task in plan.tasks if not task.automatic]
    return any(
        worker_effect(task.model, task.name, drawn[0].name, plan.seed, 1, drawn[0].body, plan.across_tasks) is not None
        for task in by_hand
        if drawn
    )


def _recorded(body: Any) -> bool:
    person = body.get("person") if isinstance(body, Mapping) else getattr(body, "person", None)
    return person is not None
