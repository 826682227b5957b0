"""A subject of the floor: a station that has to cool down, or warm up, when it has stood idle for too long.

``cooling: {after: 10 min, for: 90 s}`` at a station. Idle is the time from the end of an operation there, and from the
start of the run, until the next job takes the server. Where it was longer than ``after``, that job's server is first
taken by a task of ``for``, which needs no worker.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import Field

from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.machine import step, struct
from opsim.engine.floor.state import Job, Station
from opsim.kpi.catalogue import LESS, STATIONS, Figure, Kpi, figure
from opsim.log import HELD, PICKUP, SETUP, WORK, EventLog
from opsim.plan import Plan, Ranks
from opsim.plugins import Subject
from opsim.scenario.fields import Seconds
from opsim.scenario.tree import Block
from opsim.subjects.stations.station import begin_setup


class Cooling(Block):
    """A station that has to be brought back to its temperature when it stood idle."""

    after_s: Seconds = Field(alias="after", description="idle for longer than this, it cools down", examples=["10 min"])
    for_s: Seconds = Field(alias="for", description="how long that takes", examples=["90 s"])


Said = dict[str, Cooling]


def mistakes(said: Said, scenario: Any) -> Iterator[tuple[tuple[str, ...], str, str]]:
    """(path, message, hint) of stations where nobody could say which server was idle."""
    on_lines = {name for line in scenario.lines.values() for name in line.stations}
    for name in said:
        station, path = scenario.stations[name], ("stations", name, "cooling")
        if station.servers > 1:
            yield path, f"cooling is of one server, found {station.servers}", "make a station of each server"
        if station.batch is not None or station.preempt is not None or name in on_lines:
            yield path, "cooling is of a station that serves one job after another: no batches, preemption, lines", ""
        if not station.tasks:
            yield path, "nothing is done at this station", "name what is done there in 'tasks'"


# ----------------------------------------------------------------------------------------------------------------- plan
@dataclass(frozen=True)
class CoolingPlan:
    """station, task : ranks; after_s, for_s : as it is said."""

    station: int
    task: int
    after_s: float
    for_s: float


def task_name(cooling: Cooling) -> str:
    return f"cool_down: {cooling.for_s:.10g} s"


def tasks(said: Said) -> dict[str, dict[str, Any]]:
    """What takes the server's time, as a scenario would say it."""
    return {task_name(one): {"fixed": f"{one.for_s!r} s", "automatic": True} for one in said.values()}


def plan_cooling(said: Said, _scenario: Any, ranks: Ranks) -> tuple[CoolingPlan, ...]:
    """By rank of the station, so that the order in the file decides nothing."""
    made = (
        CoolingPlan(ranks.stations[n], ranks.tasks[task_name(one)], one.after_s, one.for_s) for n, one in said.items()
    )
    return tuple(sorted(made, key=lambda one: one.station))


# ---------------------------------------------------------------------------------------------------------------- floor
@struct
class CoolingStation:
    """job : 1 + the number of the one whose operation is under way or prepared, else 0; idle_since_s : where it is 0"""

    task: int
    after_s: float
    job: int
    idle_since_s: float


@step
def cool_down(floor: Floor, cooling: CoolingStation, job: Job) -> bool:
    """Before all else of a job that has taken the server: asked again when the cool-down is over."""
    if cooling.job == job.number + 1:
        return True
    cooling.job = job.number + 1
    if floor.now - cooling.idle_since_s <= cooling.after_s:
        return True
    begin_setup(floor, job, cooling.task)
    return False


@step
def operation_ends(floor: Floor, cooling: CoolingStation, job: Job) -> bool:
    """From now on the station is idle."""
    if cooling.job == job.number + 1:
        cooling.job = 0
        cooling.idle_since_s = floor.now
    return True


@step
def left(floor: Floor, cooling: CoolingStation, job: Job, station: Station) -> None:
    """A job that is scrapped in the middle of its operation leaves, too."""
    operation_ends(floor, cooling, job)


FIRST = -20
"""Among the preparations of a job, and among what is asked when its operation is done."""


def install(build: Any, part: tuple[CoolingPlan, ...]) -> None:
    """Hangs in at the stations that cool down."""
    for one in part:
        station, cooling = build.stations[one.station], build.arena.new("CoolingStation")
        cooling.task, cooling.after_s = one.task, one.after_s
        build.hang(station.stages, cool_down, cooling, FIRST)
        build.hang(station.afters, operation_ends, cooling, FIRST)
        build.hang(build.floor.left_station, left, cooling)


# ------------------------------------------------------------------------------------------------------- laws, figures
def cooled(log: EventLog, plan: Plan, part: tuple[CoolingPlan, ...]) -> Iterator[str]:
    """Who takes the server of a station that was idle for too long has its cool-down first, and nobody else has one."""
    for one in part:
        worked_s = left_s = 0.0  # the end of the last work, and of the last operation, which may wait for somebody
        for job, rows in _operations(log, one.station):
            kind, begin_s, end_s = log["kind"][rows], log["start_s"][rows], log["end_s"][rows]
            cooling = (kind == SETUP) & (log["task"][rows] == one.task)
            cooled_s = float((end_s - begin_s)[cooling].sum())
            lacks = begin_s[0] - left_s > one.after_s and WORK in kind and cooled_s < one.for_s - 1e-5
            if lacks or (begin_s[0] - worked_s <= one.after_s and cooled_s > 0):
                yield (
                    f"job {job} at {plan.stations[one.station].name}: a cool-down of {cooled_s:g} s at "
                    f"{begin_s[0]:g} s, expected {one.for_s if lacks else 0:g} s as the station was idle "
                    f"since {left_s if lacks else worked_s:g} s"
                )
            left_s = float(end_s[-1])
            worked_s = float(end_s[kind == WORK][-1]) if WORK in kind else left_s


def _operations(log: EventLog, station: int) -> Iterator[tuple[int, np.ndarray]]:
    """(job, numbers of its rows) from each taking of the one server to the end of the operation there, in time."""
    kind, waits_to_leave = log["kind"], log["cause"] == PICKUP
    mine = (log["station"] == station) & (log["job"] >= 0) & np.isin(kind, (WORK, SETUP, HELD)) & ~waits_to_leave
    rows = np.flatnonzero(mine)
    rows = rows[np.argsort(log["start_s"][rows], kind="stable")]
    job, begin_s, end_s = log["job"][rows], log["start_s"][rows], log["end_s"][rows]
    cuts = np.flatnonzero((job[1:] != job[:-1]) | (begin_s[1:] != end_s[:-1])) + 1
    return ((int(log["job"][some[0]]), some) for some in np.split(rows, cuts) if some.size)


def cool_downs(log: EventLog, plan: Plan, part: tuple[CoolingPlan, ...]) -> Iterator[Figure]:
    """Cool-downs that begin in the window, an hour of it."""
    low_s, high_s = plan.window_s
    inside = (log["start_s"] >= low_s) & (log["start_s"] < high_s) & (log["progress_from"] == 0)
    for one in part:
        begun = inside & (log["kind"] == SETUP) & (log["station"] == one.station) & (log["task"] == one.task)
        yield figure("cool_downs_per_h", plan.stations[one.station].name, "", begun.sum() / (high_s - low_s) * 3600)


def assumptions(plan: Plan, part: tuple[CoolingPlan, ...]) -> Iterator[tuple[str, str]]:
    for one in part:
        yield (
            "cooling",
            f"{plan.stations[one.station].name}: {one.for_s:g} s before a job that finds it idle for longer than "
            f"{one.after_s:g} s, without a worker; at the start it was just used; mean loads are without it",
        )


def cooling_section(material: Any, part: tuple[CoolingPlan, ...]) -> Any:
    """A table of the report: when each station cooled down in the first replication, of which rows are kept."""
    from opsim.report.page import Grid, Section

    log, plan = material.log, material.plan
    if log is None:
        return None
    rows = [(one, np.flatnonzero((log["station"] == one.station) & (log["task"] == one.task))) for one in part]
    times = [(plan.stations[one.station].name, log["start_s"][some]) for one, some in rows]
    cells = [(name, str(at_s.size), f"{at_s[0]:.0f} s" if at_s.size else "never") for name, at_s in times]
    table = Grid(("Station", "Cool-downs", "First at"), cells, "Cool-downs of the first replication")
    return Section("cooling", "Cool-downs", [table], nav="Cool-downs")


COOLING = Subject(
    words=Cooling,
    help="what idling costs: a time that passes on the server before the next job is begun; absent: nothing",
    example="{after: 10 min, for: 90 s}",
    mistakes=mistakes,
    tasks=tasks,
    plan=plan_cooling,
    install=install,
    laws={"a station that was idle for too long cools down before its next operation": cooled},
    kpis=(Kpi("cool_downs_per_h", "Cool-downs of the station", "1/h", LESS, STATIONS, of="station"),),
    figures=cool_downs,
    assumptions=assumptions,
    sections=(cooling_section,),
)
