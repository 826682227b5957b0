"""Tasks whose height changes: at which level one is performed, by the job's product or by the layer that is next."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.machine import step
from opsim.engine.floor.state import Job


@step
def at_level(floor: Floor, job: Job) -> None:
    """``floor.asked_task`` becomes the task at its level. What was begun before goes on, or begins anew, at its own."""
    task = floor.tasks[floor.asked_task]
    if not task.n_levels:
        return
    if not job.level or floor.tasks[job.level - 1].of != task.rank:
        at = job.product
        if task.pieces_each:
            at = task.n_begun // task.pieces_each % task.n_levels
            task.n_begun += 1
        job.level = task.levels[at] + 1
    floor.asked_task = job.level - 1


def install(build: Any) -> None:
    """Whoever begins a task asks for its level, where some task has levels."""
    for made, task in zip(build.tasks, build.plan.tasks):
        if task.levels is not None:
            build.floor.has_levels, build.floor.level_line = 1, build.line(at_level)
            made.n_levels, made.levels = len(task.levels.tasks), build.ints(task.levels.tasks)
            made.pieces_each = task.levels.pieces_each
