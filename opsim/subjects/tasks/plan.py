"""Tasks with their models of time.

A task whose height changes with the product or with the layer: it is performed as a task of its own at each level.

All levels draw the same noise: item k of a worker at the task is one luck, which each level turns into its own time
and body.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from opsim.plan.ranks import ranked
from opsim.problems import natural_key
from opsim.subjects.exposure.plan import NOT_SAID, Handling, handling_of
from opsim.subjects.tasks.variability import switched
from opsim.subjects.tools.plan import HoldPlan, Needs, hold_of, needs_of
from opsim.task_model import TaskModel

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario


@dataclass(frozen=True, slots=True)
class Levels:
    """tasks : ranks of the tasks that stand for it, of each product (P,), or of each layer in turn (L,)

    pieces_each : how often it is begun at a layer before the next one comes; 0: products decide
    """

    tasks: tuple[int, ...]
    pieces_each: int = 0


def level_name(task: str, height: float | tuple[str, str]) -> str:
    """What a task is called at a height; a bracket is in no name of a scenario."""
    return f"{task} [{f'{height:g} m' if isinstance(height, float) else '.'.join(height)}]"


def task_said(name: str) -> str:
    """The task of the scenario behind the name of one, at a level or not."""
    return name.partition(" [")[0]


def at_levels(name: str, task: Any) -> dict[str, Any]:
    """The tasks that stand for one, by name, each with one height; empty where its height does not change."""
    mark = getattr(task, "varies", None)
    if mark is None:
        return {}
    return {
        level_name(name, height): task.model_copy(update={"hands": {**task.hands, mark: height}})
        for height in task.heights
    }


def performed_tasks(scenario: Scenario) -> dict[str, Any]:
    """The tasks of a scenario as they are performed: by name, those that stand for one in its place."""
    found: dict[str, Any] = {}
    for name, task in scenario.tasks.items():
        found |= at_levels(name, task) or {name: task}
    return found


def with_levels(name: str, task: Any, make: Callable[[str, Any], TaskPlan]) -> list[TaskPlan]:
    """A task; where its height changes, those that stand for it too, and it has their mean time."""
    own = [replace(make(key, one), of=name) for key, one in at_levels(name, task).items()]
    if not own:
        return [make(name, task)]
    return [*own, replace(own[0], name=name, of=None, model=LevelsMean([one.model for one in own]))]


def found_levels(tasks: Sequence[TaskPlan], said: Mapping[str, Any], products: Sequence[str]) -> tuple[TaskPlan, ...]:
    """The tasks of a Plan, in their order, each with its ``levels`` where it has some."""
    ranks = {task.name: rank for rank, task in enumerate(tasks)}
    found = [_levels(task.name, said.get(task.name), products, ranks) for task in tasks]
    return tuple(task if levels is None else replace(task, levels=levels) for task, levels in zip(tasks, found))


def _levels(name: str, task: Any, products: Sequence[str], ranks: Mapping[str, int]) -> Levels | None:
    """None where the height does not change. A product that never comes has the first of those that are said."""
    mark = getattr(task, "varies", None)
    if mark is None:
        return None
    said = task.hands[mark]
    if task.in_turn:
        return Levels(tuple(ranks[level_name(name, height)] for height in said.layers), said.pieces_each)
    first = next(iter(said.values()))
    return Levels(tuple(ranks[level_name(name, said.get(product, first))] for product in products))


def for_product(tasks: Sequence[TaskPlan], task: int, product: int) -> TaskPlan:
    """The task as it is done for a product: at its level, where products decide."""
    levels = tasks[task].levels
    return tasks[task if levels is None or levels.pieces_each else levels.tasks[product]]


def performed_ranks(tasks: Sequence[TaskPlan], task: int) -> tuple[int, ...]:
    """The ranks of the tasks that are performed where a station names one: itself, or those at its levels."""
    levels = tasks[task].levels
    return (task,) if levels is None else tuple(sorted(set(levels.tasks)))


class LevelsMean:
    """A TaskModel with the mean time of several; all else, draws too, is that of the first: nobody performs it."""

    def __init__(self, models: Sequence[Any]):
        self.models = tuple(models)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name == "models":
            raise AttributeError(name)
        return getattr(self.models[0], name)

    def mean_duration_s(self, worker: Any = None) -> float:
        """Seconds, at rating 1, the levels in equal parts."""
        return sum(model.mean_duration_s(worker) for model in self.models) / len(self.models)

    def draw_worker(self, *arguments: Any, **more: Any) -> Any:
        return self.models[0].draw_worker(*arguments, **more)

    def sample(self, *arguments: Any, **more: Any) -> Any:
        return self.models[0].sample(*arguments, **more)


ATTENDED = "attended"


@dataclass(frozen=True, slots=True)
class TaskPlan:
    """repeat : performances in a row, each a draw of its own; automatic : needs a server but no worker

    attended : it takes the station's time, and a worker stays; team : workers at once
    needs, hold : tools for the whole of the task, and between two moments of each performance
    per_lot : done once for a lot; else for each of its units; handling : what is in the hands, what carries the body
    interruption : the rule by which it is left, whatever the shift says; None: the shift's
    levels : which tasks stand for it, where its height changes; of : the task that this one stands for"""

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
    levels: Levels | None = None
    of: str | None = None

    @property
    def stream_name(self) -> str:
        """The name in which it is drawn: one for all levels of a task."""
        return self.of or self.name

    def mean_s(self, worker=None) -> float:
        """Mean time of all repeats together for one unit, in seconds, of a worker with skill rating 1."""
        return self.repeat * self.model.mean_duration_s(worker)


def plan_tasks(scenario: Scenario, model_of, unnamed: dict, beside: Iterable[TaskPlan] = ()) -> tuple[TaskPlan, ...]:
    """Tasks in natural order; ``model_of(task)`` finds a task's model, which the run's variability may switch.

    unnamed : tasks that others need and the scenario does not name
    beside : tasks that are planned elsewhere, and are not switched
    """
    said = {**scenario.tasks, **unnamed}
    made = [one for item in said.items() for one in with_levels(*item, lambda n, t: _task(n, t, scenario, model_of(t)))]
    tasks = sorted([*made, *beside], key=lambda task: natural_key(task.name))
    return found_levels(tasks, said, list(ranked(scenario.products)))


def _task(name: str, task, scenario: Scenario, model: TaskModel) -> TaskPlan:
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
