"""Joints that the bodies of tasks lack, and what that leaves open: for warnings and the assumption sheet."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from opsim.ergonomics.missing import missing_scores
from opsim.kpi.names import SCORED
from opsim.names import listed
from opsim.plan.plan import Plan
from opsim.plan.tasks import TaskPlan


def has_body(task: TaskPlan) -> bool:
    """Whether somebody does the task, and its model has postures."""
    return not task.automatic and getattr(task.model, "skeleton", None) is not None


def lacking(tasks: Iterable[TaskPlan]) -> dict[str, list[str]]:
    """Names of tasks by what their skeletons do not tell, each a sentence; nothing where they have every joint."""
    found: dict[str, list[str]] = {}
    for task in tasks:
        model: Any = task.model
        for sentence in missing_scores(tuple(model.skeleton.names)):
            found.setdefault(sentence, []).append(task.name)
    return found


def unseen(plan: Plan, asked: Iterable[str]) -> Iterator[str]:
    """The warnings, where scores are among the figures asked for."""
    if not set(SCORED).isdisjoint(asked):
        for sentence, names in lacking(task for task in plan.tasks if has_body(task)).items():
            yield f"{listed(names)}: {sentence}"
