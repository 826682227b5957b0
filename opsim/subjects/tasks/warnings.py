"""Joins of motions whose postures are far apart: said as warnings, never refused.

What a scenario says of workers and no model of their tasks reads: said as warnings, never refused.

Tasks whose bodies do not follow where fatigue, the hour or the state of the line slows their workers.

Where hands go further than was recorded, and are not refused for it.

Joints that the bodies of tasks lack, and what that leaves open: for warnings and the assumption sheet.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

from opsim.kpi.catalogue import SCORED
from opsim.libraries import FINE
from opsim.plan.plan import Plan
from opsim.problems import listed
from opsim.subjects.people.plan import WorkerPlan
from opsim.subjects.tasks.plan import TaskPlan, performed_ranks
from opsim.task_model import keys_read, takes_shift


def wide_joins(plan: Plan) -> list[str]:
    """Every warning in a sentence."""
    return list(_wide(plan))


def _wide(plan: Plan) -> Iterator[str]:
    for task in plan.tasks:
        joins = getattr(task.model, "joins", None)
        for join in () if joins is None else joins():
            if join.gap_rad > join.most_rad:
                degrees, most = (math.degrees(angle) for angle in (join.gap_rad, join.most_rad))
                yield (
                    f"{task.name}: {join.before} ends far from where {join.after} begins: the bone to {join.joint} is "
                    f"{degrees:.0f} degrees away (more than {most:.0f}) and is led there as nobody was recorded; put a "
                    "motion between"
                )


def unread(plan: Plan) -> list[str]:
    """Every warning in a sentence."""
    return [*_paces(plan), *_people(plan)]


def tasks_of(plan: Plan, worker: WorkerPlan) -> list[TaskPlan]:
    """The tasks a worker may be sent to, in natural order."""
    ranks = {task for station, rating in zip(plan.stations, worker.rating) if rating for task in station.tasks}
    ranks |= {task for one in plan.setups if worker.rating[one.station] for task in one.tasks_by_hand}
    ranks |= {task for station, task in plan.more_setups if worker.rating[station]}
    ranks = {level for rank in ranks for level in performed_ranks(plan.tasks, rank)}
    return [plan.tasks[rank] for rank in sorted(ranks) if not plan.tasks[rank].automatic]


def unknown_there(plan: Plan, worker: WorkerPlan) -> list[str]:
    """The emulated tasks of a worker whose recordings do not have the person he is."""
    emulated = [task for task in tasks_of(plan, worker) if "person" in getattr(task.model, "body_keys", ())]
    return [task.name for task in emulated if worker.body.person not in getattr(task.model, "workers", ())]


def _paces(plan: Plan) -> Iterator[str]:
    paced = [worker for worker in plan.workers if worker.body.pace is not None]
    idle = [w.name for w in paced if not any("pace" in keys_read(task.model) for task in tasks_of(plan, w))]
    if idle:
        yield (
            f"the pace of {listed(idle)} changes nothing: none of their tasks is emulated; rate them by their skills, "
            "where 1.1 means a tenth faster"
        )


def _people(plan: Plan) -> Iterator[str]:
    lacking: dict[str, list[str]] = {}
    for worker in plan.workers:
        for task in unknown_there(plan, worker) if worker.body.person is not None else ():
            lacking.setdefault(task, []).append(f"{worker.body.person} ({worker.name})")
    for task, who in lacking.items():
        yield f"{task} was recorded without {listed(who)}: there they move as people drawn from the population"


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


def stretched(plan: Plan) -> Iterator[str]:
    """The warnings, by task and target: how far it lies from what was recorded, of people with heights of their own."""
    for task in (task for task in plan.tasks if task.levels is None):
        model: Any = task.model
        for target in getattr(model, "targets", ()):
            reach = model.reach(target.joint, target.mark)
            found = reach.verdict(target)
            if found.word != FINE:
                yield f"{task.name}: {found.sentence}"
                continue
            own = {w.name: reach.verdict(target, _effect(plan, task, w)) for w in _measured(plan, task)}
            far = [name for name, verdict in own.items() if verdict.word != FINE]
            if far:
                yield f"{task.name}: with the body of {listed(far)}: {own[far[0]].sentence}"


def _measured(plan: Plan, task: TaskPlan) -> list[WorkerPlan]:
    """Those who do a task and whose height is known."""
    return [one for one in plan.workers if one.body.height_m is not None and task in tasks_of(plan, one)]


def _effect(plan: Plan, task: TaskPlan, worker: WorkerPlan) -> Any:
    effect = plan.worker_effect(plan.workers.index(worker), task)
    return getattr(effect, "effect", effect)


def has_body(task: TaskPlan) -> bool:
    """Whether somebody does the task, and its model has postures."""
    return not task.automatic and getattr(task.model, "skeleton", None) is not None


def lacking(tasks: Iterable[TaskPlan]) -> dict[str, list[str]]:
    """Names of tasks by what their skeletons do not tell, each a sentence; nothing where they have every joint."""
    from opsim.ergonomics.measures import missing_scores

    found: dict[str, list[str]] = {}
    for task in tasks:
        model: Any = task.model
        for sentence in missing_scores(tuple(model.skeleton.names)):
            found.setdefault(sentence, []).append(task.name)
    return found


def unseen(plan: Plan, asked: Iterable[str]) -> Iterator[str]:
    """The warnings, where scores are among the figures asked for."""
    if not set(SCORED).isdisjoint(asked):
        for sentence, names in lacking(task for task in plan.tasks if has_body(task) and task.levels is None).items():
            yield f"{listed(names)}: {sentence}"
