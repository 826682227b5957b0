"""What the plan keeps of the subjects of somebody else, and the tasks that they need."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from opsim.plugins.subjects import GROUP, STATION

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario


@dataclass(frozen=True, slots=True)
class SubjectPlan:
    """key : of the subject; part : what it keeps of the scenario

    setups : (rank of a station, rank of a task) of all tasks by which it may take a server there, as a set-up does
    """

    key: str
    part: Any
    setups: tuple[tuple[int, int], ...] = ()


def plan_subjects(scenario: Scenario, ranks: Any) -> tuple[SubjectPlan, ...]:
    """Of each subject that a scenario has a word of, in natural order of keys; ranks : ``plan.Ranks``."""
    from opsim.scenario.schema.subjects import subjects_said

    made = []
    for key, subject, said in subjects_said(scenario):
        by_station = (
            {name: {name: block} for name, block in said.items()}
            if subject.where == STATION
            else dict.fromkeys(scenario.stations, said)
        )
        setups = {
            (ranks.stations[n], ranks.tasks[task]) for n, one in by_station.items() for task in subject.tasks(one)
        }
        made.append(SubjectPlan(key, subject.plan(said, scenario, ranks), tuple(sorted(setups))))
    return tuple(made)


def subject_tasks(scenario: Scenario) -> dict[str, Any]:
    """By name, the tasks that subjects need and no scenario names. Raises PluginError for one that is none."""
    from opsim.scenario.schema.subjects import subjects_said

    wanted = [(key, item) for key, subject, said in subjects_said(scenario) for item in subject.tasks(said).items()]
    return {name: _task(key, name, task) for key, (name, task) in wanted}


def _task(key: str, name: str, task: Any) -> Any:
    from pydantic import TypeAdapter

    from opsim.plugins.guard import blamed, fault
    from opsim.plugins.registry import plugins
    from opsim.subjects.tasks.kinds import Task

    found = plugins(GROUP).found(key)
    if ":" not in name:
        raise fault(found, f"the name of the task {name!r} has no colon, and may be one of a scenario's own")
    with blamed(found, f"the task {name!r}"):
        return TypeAdapter(Task).validate_python(task)
