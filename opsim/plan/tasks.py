"""What a scenario says of scoring -> Options, with angles in degrees, as the methods' tables have them.

Names become numbers: each at its natural rank.
Tools: how many of each there are, who needs them, and between which moments of a task one is held.

What a scenario says of a task beside its time, which no posture tells: load, grip, force, support.

Set-ups: what a server needs before a job of another class than the one it did last.

Tasks with their models of time.
What nobody said of a task's hands, and which scores it leaves open: for warnings and the assumption sheet.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

from opsim.ergonomics.options import Options, Thresholds
from opsim.plan.levels import Levels, found_levels, with_levels
from opsim.plan.subjects import subject_tasks
from opsim.problems import natural_key
from opsim.task_model import TaskModel
from opsim.tasks.variability import switched

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario, Setup


def plan_ergonomics(scenario: Scenario) -> Options:
    """The options of a run."""
    said = scenario.ergonomics
    return Options(
        rate_hz=said.rate_hz,
        arm_reference=said.arm_reference,
        rula_table_a=said.rula.table_a,
        rula_force=said.rula.force,
        owas_disputed=tuple(said.owas.disputed),
        waiting=said.waiting,
        thresholds=_thresholds(said.thresholds),
    )


def _thresholds(said) -> Thresholds:
    names = [field.name for field in fields(Thresholds)]
    return Thresholds(**{name: _value(said, name) for name in names})


def _value(said, name: str) -> Any:
    """Lengths in metres and switches as they are said, angles in degrees."""
    return getattr(said, name) if name in type(said).model_fields else _deg(getattr(said, f"{name}_rad"))


def _deg(angle_rad: float) -> float:
    """NOTE: to a billionth, so that what was written as 10 deg is 10 again."""
    return round(math.degrees(angle_rad), 9)


@dataclass(frozen=True, slots=True)
class Ranks:
    """The number of each name of a scenario.

    stations : of all points of the flow, which share one list: stations, stores and conveyors
    """

    places: dict[str, int]
    tasks: dict[str, int]
    stations: dict[str, int]
    products: dict[str, int]


def ranks_of(scenario: Scenario, tasks: Iterable[str]) -> Ranks:
    """The ranks of a scenario's names; ``tasks`` are those of the Plan, which has some that no scenario names."""
    points = (*scenario.stations, *getattr(scenario, "stores", ()), *getattr(scenario, "conveyors", ()))
    return Ranks(ranked(scenario.layout.places), ranked(tasks), ranked(points), ranked(scenario.products))


def ranked(names: Iterable[str]) -> dict[str, int]:
    """Names in natural order, each with its number."""
    return {name: rank for rank, name in enumerate(sorted(names, key=natural_key))}


Needs = tuple[tuple[int, int], ...]
"""(rank of a tool, how many of it), in natural order of the tools."""


@dataclass(frozen=True, slots=True)
class ToolPlan:
    """Tools of one kind, n of them."""

    name: str
    n: int


@dataclass(frozen=True, slots=True)
class Moment:
    """A moment of a performance: its ``mark``-th mark, or a share of its duration where mark is -1."""

    mark: int = -1
    share: float = 0.0


@dataclass(frozen=True, slots=True)
class HoldPlan:
    """The rank of a tool that is in the hands from one moment of each performance to another."""

    tool: int
    start: Moment
    end: Moment


def plan_tools(scenario: Scenario) -> tuple[ToolPlan, ...]:
    """Tools in natural order."""
    return tuple(ToolPlan(name, scenario.tools[name].n) for name in ranked(scenario.tools))


def needs_of(block, scenario: Scenario) -> Needs:
    """What a station or a task needs."""
    ranks = ranked(scenario.tools) if block.needs else {}
    return tuple(sorted((ranks[name], n) for name, n in block.needs.items()))


def hold_of(task, scenario: Scenario, model) -> HoldPlan | None:
    """What a task holds; its marks by the names that its model has for them. Raises ValueError for another name."""
    if task.hold is None:
        return None
    names = tuple(getattr(model, "mark_names", ()))
    moments = (moment_of(said, names) for said in (task.hold.start, task.hold.end))
    return HoldPlan(ranked(scenario.tools)[task.hold.tool], *moments)


def moment_of(said: float | str, names: tuple[str, ...]) -> Moment:
    """A moment by a share of a performance, or by the name of one of its marks. Raises ValueError for another name."""
    if isinstance(said, float):
        return Moment(share=said)
    if said not in names:
        raise ValueError(f"no mark {said!r}; the movement has: {', '.join(names) or 'none'}")
    return Moment(mark=names.index(said))


GRIPS = ("good", "fair", "poor", "unacceptable")
FORCES = ("intermittent", "repeated", "static", "shock")
FOREARMS = ("mid", "end")
START = Moment(share=0.0)
END = Moment(share=1.0)
LEGS = ("balanced", "unbalanced")
SAID = ("grip", "force", "forearm", "arms_supported", "sitting", "legs", "rapid")
"""What ``handling:`` of a task may say beside its load."""


@dataclass(frozen=True, slots=True)
class Handling:
    """None: nobody said so, and scores that ask for it are intervals.

    load_kg : in both hands together, of each member of a team, from ``start`` to ``end`` of each performance
    grip    : one of GRIPS (REBA's coupling, NIOSH's coupling multiplier)
    force   : one of FORCES, how the load or force comes (RULA's force, REBA's shock)
    forearm : one of FOREARMS, how far the forearm is twisted (RULA's wrist twist)
    arms_supported, sitting : whether something carries the arms, and the body
    legs    : one of LEGS, whether both feet carry (RULA's legs, REBA's legs)
    rapid   : whether posture changes quickly and far, or the base is unstable (REBA's activity)
    """

    load_kg: float | None = None
    grip: str | None = None
    force: str | None = None
    forearm: str | None = None
    arms_supported: bool | None = None
    sitting: bool | None = None
    legs: str | None = None
    rapid: bool | None = None
    start: Moment = START
    end: Moment = END

    @property
    def by_share(self) -> bool:
        """Whether it is known without a performance when hands are full."""
        return self.start.mark < 0 and self.end.mark < 0


NOT_SAID = Handling()


def handling_of(task, scenario: Scenario, model) -> Handling:
    """What a scenario says of a task; its marks by the names that the model has for them.

    Raises ValueError for another name. Tasks that no scenario names, such as repairs, have NOT_SAID.
    """
    said, loaded = getattr(task, "handling", None), getattr(task, "loaded", None)
    more: dict[str, Any] = {} if said is None else {key: getattr(said, key) for key in SAID}
    names = tuple(getattr(model, "mark_names", ()))
    if loaded is not None:
        more |= {"start": moment_of(loaded.start, names), "end": moment_of(loaded.end, names)}
    made = Handling(load_kg=getattr(task, "load_kg", None), **more)
    return NOT_SAID if made == NOT_SAID else made


NO_SETUP = -1
ANYTHING = -1
"""What a server was last set up for, before its first job: no set-up is needed for whatever comes."""


@dataclass(frozen=True, slots=True)
class SetupPlan:
    """Set-ups at a station. Products are told apart by classes, themselves or their families.

    station  : its rank; attended : whether a worker does it
    class_of : (P,) number of each product's class, -1 where it never comes here
    task     : (C, C) rank of the task from one class to another, ``NO_SETUP`` where there is none
    mean_s   : (C, C) mean time of that task at rating 1
    first    : the class at the start, or ``ANYTHING``
    """

    station: int
    attended: bool
    class_of: tuple[int, ...]
    task: tuple[tuple[int, ...], ...]
    mean_s: tuple[tuple[float, ...], ...]
    first: int

    @property
    def tasks_by_hand(self) -> set[int]:
        """Ranks of the tasks by which workers set up here; some may run alone all the same."""
        return {rank for row in self.task for rank in row if rank != NO_SETUP} if self.attended else set()

    def needed(self, last: int, product: int) -> tuple[int, float]:
        """(task, mean time) of the set-up for a product on a server that last did a class."""
        if last == ANYTHING:
            return NO_SETUP, 0.0
        here = self.class_of[product]
        return self.task[last][here], self.mean_s[last][here]


def setup_tasks(scenario: Scenario) -> dict:
    """Tasks that a scenario does not name: of set-ups that are said as a time, and of subjects of somebody else."""
    from opsim.scenario.schema import Fixed

    said = [time for station in scenario.stations.values() for time in _said(station) if isinstance(time, float)]
    made = {setup_name(time_s): Fixed.model_validate({"fixed": f"{time_s!r} s"}) for time_s in said if time_s > 0}
    return {**made, **subject_tasks(scenario)}


def setup_name(time_s: float) -> str:
    """What the task of a set-up is called; a colon is in no name of a scenario."""
    return f"setup: {time_s:.10g} s"


def plan_setups(scenario: Scenario, ranks: Ranks, tasks) -> tuple[SetupPlan, ...]:
    """Set-ups of all stations that have some, in natural order; ``tasks`` are those of the Plan."""
    found = ((name, scenario.stations[name].setup) for name in sorted(scenario.stations, key=natural_key))
    return tuple(_setup(name, setup, scenario, ranks, tasks) for name, setup in found if setup is not None)


def _setup(name: str, setup: Setup, scenario: Scenario, ranks: Ranks, tasks) -> SetupPlan:
    class_of = {product: class_name(scenario, setup, product) for product in ranks.products}
    here = [product for product in ranks.products if comes_to(scenario.products[product], name)]
    first = () if setup.first is None else (setup.first,)
    classes = sorted({*first, *(class_of[product] for product in here)}, key=natural_key)
    said = [[_rank(setup, last, new, ranks) for new in classes] for last in classes]
    return SetupPlan(
        ranks.stations[name],
        setup.attended,
        tuple(classes.index(class_of[product]) if product in here else -1 for product in ranks.products),
        tuple(tuple(row) for row in said),
        tuple(tuple(0.0 if rank == NO_SETUP else tasks[rank].mean_s() for rank in row) for row in said),
        ANYTHING if setup.first is None else classes.index(setup.first),
    )


def class_name(scenario: Scenario, setup, product: str) -> str:
    """What a product counts as: itself, or its family where set-ups go by families."""
    family = scenario.products[product].family
    return family if setup.by == "family" and family is not None else product


def comes_to(product, station: str) -> bool:
    """Whether a product comes to a station: by its route, or by its routing."""
    if product.route is not None:
        return any(station == step or (isinstance(step, list) and station in step) for step in product.route)
    return any(station == name or station in ways for name, ways in product.routing.items())


def _rank(setup, last: str, new: str, ranks: Ranks) -> int:
    said = setup.times.get(last, {}).get(new)
    if said is None:
        said = 0.0 if last == new else setup.otherwise
    if isinstance(said, str):
        return ranks.tasks[said]
    if not said:
        return NO_SETUP
    return ranks.tasks[setup_name(said)]


def _said(station) -> list[float | str]:
    if station.setup is None:
        return []
    otherwise = [] if station.setup.otherwise is None else [station.setup.otherwise]
    return [*(time for row in station.setup.times.values() for time in row.values()), *otherwise]


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


def plan_tasks(scenario: Scenario, model_of, beside: Iterable[TaskPlan] = ()) -> tuple[TaskPlan, ...]:
    """Tasks in natural order; ``model_of(task)`` finds a task's model, which the run's variability may switch.

    beside : tasks that are planned elsewhere, and are not switched
    """
    said = {**scenario.tasks, **setup_tasks(scenario)}
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


ALWAYS = {
    "forearm": "RULA is an interval over the twist of the forearm",
    "arms_supported": "RULA and REBA are intervals over whether something carries the arms",
    "sitting": "REBA and OWAS are intervals over whether he sits",
    "legs": "RULA, REBA and OWAS are intervals over whether both feet carry",
    "rapid": "REBA is an interval over whether posture changes quickly or the stand is unstable",
}
"""By key of ``handling``: what it leaves open."""
LOADED = {
    "grip": "REBA is an interval over the grip",
    "force": "RULA is an interval over how the load comes, REBA over whether it comes as a blow",
}
"""The same, where something is, or may be, in the hands."""
LOAD = "load"
NO_LOAD = "RULA, REBA and OWAS are intervals over what is in the hands, and neither a lifting index nor energy has one"


def unsaid(tasks: Iterable[tuple[str, float | None, Any]]) -> dict[str, list[str]]:
    """Tasks by what nobody said of them: ``load``, or a key of ``handling``; in the order of this page.

    tasks : (name, load in kg or None, an object with the keys of ``handling``, or None where it says nothing)
    """
    found: dict[str, list[str]] = {key: [] for key in (LOAD, *LOADED, *ALWAYS)}
    for name, load_kg, handling in tasks:
        if load_kg is None:
            found[LOAD].append(name)
        for key in (*(LOADED if load_kg != 0 else ()), *ALWAYS):
            if getattr(handling, key, None) is None:
                found[key].append(name)
    return {key: names for key, names in found.items() if names}


def leaves_open(key: str) -> str:
    """What follows for the scores where nobody says it."""
    return NO_LOAD if key == LOAD else {**LOADED, **ALWAYS}[key]
