"""Tasks whose bodies do not follow where fatigue, the hour or the state of the line slows their workers."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.names import listed
from opsim.own_luck import takes_shift
from opsim.plan.plan import Plan
from opsim.plan.tasks import TaskPlan
from opsim.plan.unread import tasks_of

SHIFTS = ("fatigue", "circadian", "state_pace")
"""Effects that shift log time."""


def shifted_by(plan: Plan) -> list[str]:
    """The effects that shift the pace of people and shall take their postures along; none where time alone changes."""
    if plan.human.acts_on != "posture":
        return []
    return [effect.replace("_", " ") for effect in SHIFTS if getattr(plan.human, effect) is not None]


def unmoved(plan: Plan) -> list[TaskPlan]:
    """The tasks by hand whose models know no shift of pace, in natural order; none where nothing shifts it."""
    if not shifted_by(plan):
        return []
    by_hand = {task.name: task for worker in plan.workers for task in tasks_of(plan, worker)}
    return [task for task in plan.tasks if task.name in by_hand and not task.attended and not takes_shift(task.model)]


def unmoved_bodies(plan: Plan) -> Iterator[str]:
    """The warning, where the model of such a task does have bodies."""
    names = [task.name for task in unmoved(plan) if getattr(task.model, "skeleton", None) is not None]
    if names:
        yield (
            f"{listed(shifted_by(plan))}: {listed(names)}: the emulator knows no shift of pace, so that times change "
            "and postures stay; write 'human.acts_on: time' where that is meant"
        )
