"""What stops stations: breakdowns, planned maintenance, and the teams that put it right."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from opsim.plan.ranks import Ranks, ranked
from opsim.problems import natural_key
from opsim.subjects.tasks.plan import TaskPlan
from opsim.task_model import TaskModel

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario

NO_TEAM = -1
"""The repair begins at once: nobody has to come."""
CLOCK, BUSY, CYCLES = "clock", "busy", "cycles"


@dataclass(frozen=True, slots=True)
class BreakdownPlan:
    """name : "press: jam"; task : the rank of its repair in the Plan's tasks, whose model says how long it takes

    by, every : what counts towards the next one, and how much of it: seconds up or at work, or a number of cycles
    job       : what becomes of the jobs that were in work: ``resume``, ``restart`` or ``scrap``
    """

    name: str
    station: int
    task: int
    team: int
    by: str
    every: TaskModel
    job: str


@dataclass(frozen=True, slots=True)
class MaintenancePlan:
    """Due at ``first_s`` and then every ``every_s``; after_job : jobs that were begun are finished first."""

    name: str
    station: int
    task: int
    team: int
    first_s: float
    every_s: float
    after_job: bool


@dataclass(frozen=True, slots=True)
class RepairTeamPlan:
    """n : stops that it can put right at once."""

    name: str
    n: int


def repair_tasks(scenario: Scenario, model_of: Callable) -> tuple[TaskPlan, ...]:
    """Tasks that no station lists and nobody performs: what is done about each stop. ``variability`` leaves them."""
    return tuple(
        TaskPlan(name, _fixed(said) if isinstance(said, float) else model_of(said), 1, True)
        for name, said in repairs_said(scenario).items()
    )


def repairs_said(scenario: Scenario) -> dict:
    """What a scenario says of how long each stop lasts, by the stop's name: seconds, or a block of a time."""
    return {
        **{name: stop.repair for name, stop in _stops(scenario, "breakdowns")},
        **{name: stop.lasts for name, stop in _stops(scenario, "maintenance")},
    }


def plan_breakdowns(scenario: Scenario, ranks: Ranks, model_of: Callable) -> tuple[BreakdownPlan, ...]:
    """Breakdowns of all stations, in natural order of "station: breakdown"."""
    return tuple(
        BreakdownPlan(name, *_at(name, stop, scenario, ranks), stop.by, _every(stop, model_of), stop.job)
        for name, stop in _stops(scenario, "breakdowns")
    )


def plan_maintenance(scenario: Scenario, ranks: Ranks) -> tuple[MaintenancePlan, ...]:
    """Planned stops of all stations, in natural order of "station: stop"."""
    return tuple(
        MaintenancePlan(
            name,
            *_at(name, stop, scenario, ranks),
            stop.every_s if stop.first_s is None else stop.first_s,
            stop.every_s,
            stop.when == "after_job",
        )
        for name, stop in _stops(scenario, "maintenance")
    )


def plan_repair_teams(scenario: Scenario) -> tuple[RepairTeamPlan, ...]:
    """Repair teams in natural order."""
    teams = scenario.repair_teams
    return tuple(RepairTeamPlan(name, teams[name].n) for name in ranked(teams))


def stop_name(station: str, stop: str) -> str:
    """What a stop is called among all; a colon is in no name of a scenario."""
    return f"{station}: {stop}"


def _stops(scenario: Scenario, kind: str) -> Iterator[tuple[str, Any]]:
    found = {
        stop_name(name, stop): said
        for name, station in scenario.stations.items()
        for stop, said in getattr(station, kind).items()
    }
    yield from sorted(found.items(), key=lambda item: natural_key(item[0]))


def _at(name: str, stop, scenario: Scenario, ranks: Ranks) -> tuple[int, int, int]:
    """(station, task, team) of a stop."""
    station = ranks.stations[name.partition(":")[0]]
    return station, ranks.tasks[name], NO_TEAM if stop.team is None else ranked(scenario.repair_teams)[stop.team]


def _every(stop, model_of: Callable) -> TaskModel:
    from opsim.subjects.tasks.distributions import count_model

    return count_model(stop.every) if stop.by == CYCLES else model_of(stop.every)


def _fixed(seconds: float) -> TaskModel:
    from opsim.tasks import Fixed

    return Fixed(seconds)
