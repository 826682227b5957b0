"""Tasks with their models of time."""

from dataclasses import dataclass

from opsim.names import natural_key
from opsim.task import TaskModel
from opsim.tasks.switched import switched


@dataclass(frozen=True, slots=True)
class TaskPlan:
    """repeat : performances in a row, each a draw of its own; automatic : needs a server but no worker."""

    name: str
    model: TaskModel
    repeat: int
    automatic: bool

    def mean_s(self, worker=None) -> float:
        """Mean time of all repeats together, in seconds, of a worker with skill rating 1."""
        return self.repeat * self.model.mean_duration_s(worker)


def plan_tasks(scenario, model_of) -> tuple[TaskPlan, ...]:
    """Tasks in natural order; ``model_of(task)`` finds a task's model, which the run's variability may switch."""
    return tuple(
        TaskPlan(name, switched(model_of(task), scenario.run.variability), task.repeat, task.automatic)
        for name, task in sorted(scenario.tasks.items(), key=lambda item: natural_key(item[0]))
    )
