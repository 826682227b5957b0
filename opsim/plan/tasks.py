"""Tasks with their models of time."""

from collections.abc import Iterable
from dataclasses import dataclass

from opsim.names import natural_key
from opsim.plan.handling import NOT_SAID, Handling, handling_of
from opsim.plan.setup import setup_tasks
from opsim.plan.tools import HoldPlan, Needs, hold_of, needs_of
from opsim.task import TaskModel
from opsim.tasks.switched import switched

ATTENDED = "attended"


@dataclass(frozen=True, slots=True)
class TaskPlan:
    """repeat : performances in a row, each a draw of its own; automatic : needs a server but no worker

    attended : it takes the station's time, and a worker stays; team : workers at once
    needs, hold : tools for the whole of the task, and between two moments of each performance
    per_lot : done once for a lot; else for each of its units
    interruption : the rule by which it is left, whatever the shift says; None: the shift's
    handling : what is in the hands, and what carries the body
    """

    name: str
    model: TaskModel
    repeat: int
    automatic: bool
    attended: bool = False
    team: int = 1
    needs: Needs = ()
    hold: HoldPlan | None = None
    per_lot: bool = False
    interruption: str | None = None
    handling: Handling = NOT_SAID

    def mean_s(self, worker=None) -> float:
        """Mean time of all repeats together for one unit, in seconds, of a worker with skill rating 1."""
        return self.repeat * self.model.mean_duration_s(worker)


def plan_tasks(scenario, model_of, beside: Iterable[TaskPlan] = ()) -> tuple[TaskPlan, ...]:
    """Tasks in natural order; ``model_of(task)`` finds a task's model, which the run's variability may switch.

    beside : tasks that are planned elsewhere, and are not switched
    """
    more_tasks = setup_tasks(scenario)
    tasks = [_task(name, task, scenario, model_of(task)) for name, task in {**scenario.tasks, **more_tasks}.items()]
    return tuple(sorted([*tasks, *beside], key=lambda task: natural_key(task.name)))


def _task(name: str, task, scenario, model: TaskModel) -> TaskPlan:
    return TaskPlan(
        name,
        switched(model, scenario.run.variability),
        task.repeat,
        task.automatic is True,
        attended=task.automatic == ATTENDED,
        team=task.team,
        needs=needs_of(task, scenario),
        hold=hold_of(task, scenario, model),
        per_lot=task.per == "lot",
        interruption=getattr(task, "interruption", None),
        handling=handling_of(task, scenario, model),
    )
