"""What a Yamazumi stacks: the work of a visit task by task, set-up and walking with it, and what of it takt allows.

What a Yamazumi says: who has most work, who is over takt, and what the whiskers do to it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.kpi.cycle_times import cycle_times
from opsim.kpi.window import SECONDS_PER_HOUR, duty_hours, in_window, inside_s, is_in, open_hours
from opsim.log import FINISH, SETUP, WALK, WORK, EventLog
from opsim.plan import Plan
from opsim.plan.loads.flows import flows_of
from opsim.report.material import Material
from opsim.report.numbers import is_number, listing, three_digits
from opsim.report.sections.common import worked_on
from opsim.report.sections.summary import find, with_interval
from opsim.subjects.tasks.plan import performed_ranks

TAKT, LINE, PACE = "takt", "takt of the line", "pace"
"""What a station is held against: what demand asks, what its line moves by, or what the floor reached."""
SETTING_UP, WALKING = "set-up", "walking"


@dataclass(frozen=True)
class Stack:
    """One bar, in seconds of a server (or of a worker).

    tasks  : seconds of each in their order, which sum to the mean work; beside : set-up and walking, where there is any
    p10, p90 : of the work of a visit, None where it is not known; share_of : servers, or jobs of a batch, that share it
    allowed_s : what there is for it, None where nothing says; by : whose that is, one of TAKT, LINE, PACE
    """

    name: str
    tasks: Mapping[str, float]
    beside: Mapping[str, float]
    p10: float | None = None
    p90: float | None = None
    share_of: int = 1
    allowed_s: float | None = None
    by: str = ""

    @property
    def work_s(self) -> float:
        """Of all tasks."""
        return sum(self.tasks.values())

    @property
    def total_s(self) -> float:
        """With set-up and walking."""
        return self.work_s + sum(self.beside.values())


def station_stacks(material: Material) -> list[Stack]:
    """A bar a station along the flow: the mean work of a visit over all replications, divided among its tasks as in
    the first one, over the station's servers; stations where nothing was finished are left out."""
    plan, rows = material.plan, {row["subject"]: row["mean"] for row in material.rows("cycle_time_s")}
    spread = {row["subject"]: row["quantiles"] for row in _distributions(material) if row["kpi"] == "cycle_time_s"}
    allowed, by = _allowed_s(material)
    of_tasks, beside = _by_task(material), _beside(material)
    found = []
    for rank in worked_on(plan):
        station, work_s = plan.stations[rank], rows.get(plan.stations[rank].name)
        if not is_number(work_s) or not work_s or work_s <= 0:
            continue
        share = station.servers * next((batch.size for batch in plan.batches if batch.station == rank), 1)
        whole_s = sum(of_tasks[rank].values())
        tasks = {task: work_s * part_s / whole_s / share for task, part_s in of_tasks[rank].items() if part_s > 0}
        ends = spread.get(station.name, {})
        p10, p90 = (None if ends.get(q) is None else ends[q] / share for q in ("0.1", "0.9"))
        more = {what: s / share for what, s in beside[rank].items() if s > 0.005 * work_s}
        found.append(Stack(station.name, tasks, more, p10, p90, share, allowed.get(rank), by.get(rank, "")))
    return found


def _distributions(material: Material) -> list[dict[str, Any]]:
    return list(material.result.summary.get("distributions", []))


def _by_task(material: Material) -> dict[int, dict[str, float]]:
    """By station, seconds of each of its tasks, of jobs that came and went in the window: those that its edges cut
    would bring in one task without the others. By plan where there are none, or no rows are kept."""
    plan, log = material.plan, material.log
    found: dict[int, dict[str, float]] = {}
    if log is None:
        return {rank: _planned_s(plan, rank) for rank in range(len(plan.stations))}
    rows = np.flatnonzero((log["kind"] == WORK) & (log["job"] >= 0) & (log["station"] >= 0) & (log["task"] >= 0))
    rows = rows[_whole(log, rows, plan)]
    cell = log["station"][rows] * len(plan.tasks) + log["task"][rows]
    spent_s = np.bincount(cell, log["end_s"][rows] - log["start_s"][rows], len(plan.stations) * len(plan.tasks))
    for rank, (station, own_s) in enumerate(zip(plan.stations, spent_s.reshape(len(plan.stations), -1))):
        own = {plan.tasks[task].name: float(own_s[task]) for task in _performed(plan, station.tasks)}
        found[rank] = own if own_s.sum() > 0 else _planned_s(plan, rank)
    return found


def _performed(plan: Plan, tasks: Sequence[int]) -> list[int]:
    return list(dict.fromkeys(level for task in tasks for level in performed_ranks(plan.tasks, task)))


def _whole(log: EventLog, rows: np.ndarray, plan: Plan) -> np.ndarray:
    """(n,) whether all work that the job of a row gets at its station lies in the window."""
    low_s, high_s = plan.window_s
    inside = (log["start_s"][rows] >= low_s) & (log["end_s"][rows] < high_s)
    _, stay = np.unique(log["job"][rows] * len(plan.stations) + log["station"][rows], return_inverse=True)
    return np.bincount(stay, ~inside, stay.max(initial=-1) + 1)[stay] == 0


def _planned_s(plan: Plan, station: int) -> dict[str, float]:
    return {plan.tasks[task].name: plan.tasks[task].mean_s() for task in plan.stations[station].tasks}


def _beside(material: Material) -> list[dict[str, float]]:
    """By station, seconds of set-up, and of walking to a job there, for each visit of the first replication."""
    plan, log = material.plan, material.log
    if log is None:
        return [{} for _ in plan.stations]
    visits = cycle_times(log, plan)
    n = np.array([max(1, visits.get(station.name, np.empty(0)).size) for station in plan.stations])
    of_jobs = (log["job"] >= 0) & (log["station"] >= 0)
    masks = {SETTING_UP: log["kind"] == SETUP, WALKING: (log["kind"] == WALK) & (log["worker"] >= 0)}
    each = {}
    for what, mask in masks.items():
        rows = np.flatnonzero(mask & of_jobs)
        each[what] = np.bincount(log["station"][rows], inside_s(log, rows, plan), len(plan.stations)) / n
    return [{what: float(per_visit[rank]) for what, per_visit in each.items()} for rank in range(n.size)]


def _allowed_s(material: Material) -> tuple[dict[int, float], dict[int, str]]:
    """By station: seconds from one visit to the next that demand, a line or the reached pace leaves; and which."""
    plan = material.plan
    visits = visits_of(plan)
    per_job, by = job_every_s(material, visits)
    allowed = {rank: per_job / often for rank, often in visits.items() if per_job is not None and often > 0}
    if per_job is None:
        allowed, by = visit_every_s(material), PACE
    words = dict.fromkeys(allowed, by)
    for line in plan.lines:
        allowed |= dict.fromkeys(line.stations, line.takt_s)
        words |= dict.fromkeys(line.stations, LINE)
    return allowed, words


def visits_of(plan: Plan) -> dict[int, float]:
    """By station on a route: visits for each job that sources release, parts and rework among them.

    NOTE: as ``station_loads`` has it, whose mean durations of emulated tasks would take longer than all else here.
    """
    flows = flows_of(plan)
    found: defaultdict[int, float] = defaultdict(float)
    for flow in flows.steps:
        found[flow.station] += flow.per_job if flows.saturated else flow.per_h / flows.per_h if flows.per_h else 0.0
    return dict(found)


def job_every_s(material: Material, visits: Mapping[int, float]) -> tuple[float | None, str]:
    """Seconds from one job to the next: what demand asks, else what the one paced line moves by, else nothing does.

    Where the floor decides some of what comes in, what comes in by time says little of all the work at a station.
    visits : of a job to each station, so that what feeds a line is held against what the line takes
    """
    plan, rows = material.plan, material.result.summary["kpis"]
    takt = find(rows, "takt_s")
    if takt is not None and not flows_of(plan).saturated:
        return takt["mean"], TAKT
    if len(plan.lines) == 1:
        return plan.lines[0].takt_s * visits.get(plan.lines[0].stations[0], 1.0), LINE
    return None, ""


def visit_every_s(material: Material) -> dict[int, float]:
    """By station: open seconds from one visit to the next over all replications, scrap and rework as they came."""
    open_s = open_hours(material.plan) * SECONDS_PER_HOUR * material.summary["replications"]
    n = {row["subject"]: row["n"] for row in _distributions(material) if row["kpi"] == "cycle_time_s"}
    return {rank: open_s / n[one.name] for rank, one in enumerate(material.plan.stations) if open_s and n.get(one.name)}


def worker_stacks(log: EventLog, plan: Plan) -> list[Stack]:
    """A bar a worker: seconds he works at each station, sets up and walks, for each job that is finished while he is
    on duty, in the first replication; those with none are left out."""
    finish_s = log["end_s"][(log["kind"] == FINISH)]
    finish_s = finish_s[in_window(finish_s, plan)]
    rows = np.flatnonzero((log["worker"] >= 0) & np.isin(log["kind"], (WORK, SETUP, WALK)))
    seconds, worker = inside_s(log, rows, plan), log["worker"][rows]
    n_stations = len(plan.stations)
    at_work = (log["kind"][rows] == WORK) & (log["station"][rows] >= 0)
    cell = worker[at_work].astype(np.int64) * n_stations + log["station"][rows][at_work]
    worked_s = np.bincount(cell, seconds[at_work], len(plan.workers) * n_stations).reshape(-1, n_stations)
    beside = {
        what: np.bincount(worker, seconds * (log["kind"][rows] == kind), len(plan.workers))
        for what, kind in ((SETTING_UP, SETUP), (WALKING, WALK))
    }
    found = []
    for rank, person in enumerate(plan.workers):
        jobs = int(np.count_nonzero(is_in(duty_hours(plan, rank), finish_s)))
        tasks = {plan.stations[s].name: worked_s[rank, s] / max(1, jobs) for s in worked_on(plan) if worked_s[rank, s]}
        more = {what: float(s[rank]) / max(1, jobs) for what, s in beside.items() if s[rank] > 0}
        if jobs and tasks:
            found.append(Stack(person.name, tasks, more))
    return found


MOST_NAMED, ALIKE = 4, 0.97
SELDOM = 4.0
"""Times the time between visits where they are most frequent: a station beyond is off the beat, as rework is."""
OVER = 1.005
"""Times takt: what is nearer to it keeps it."""


def in_s(seconds: float) -> str:
    """``145 s``, in seconds whatever it is: the chart's unit."""
    return f"{three_digits(seconds)} s"


def station_sentences(material: Material, stacks: Sequence[Stack]) -> list[str]:
    """The most and the least work, and what is over takt."""
    return [_spread(material, stacks), *_against(material, stacks)]


def _spread(material: Material, stacks: Sequence[Stack]) -> str:
    often = [stack for stack in stacks if _allowed(stack) <= SELDOM * min(map(_allowed, stacks))]
    most, least = max(often, key=lambda stack: stack.work_s), min(often, key=lambda stack: stack.work_s)
    which = "all stations" if len(often) == len(stacks) else "the stations that jobs visit regularly"
    text = f"Of {which} {most.name} has the most work a visit ({in_s(most.work_s)} of each server)"
    text += f" and {least.name} the least ({in_s(least.work_s)})"
    balance = find(material.result.summary["kpis"], "line_balance_efficiency")
    return text + (f"; line balance efficiency is {with_interval(balance)}." if balance is not None else ".")


def _against(material: Material, stacks: Sequence[Stack]) -> Iterator[str]:
    """Who is over what is allowed on average, and who with one visit in ten; or what the pace is."""
    held = [stack for stack in stacks if stack.allowed_s is not None and stack.by != PACE]
    if not held:
        yield from _pace(stacks, find(material.result.summary["kpis"], "takt_s") is not None)
        return
    takt = "the takt of the line" if all(stack.by == LINE for stack in held) else "takt"
    over = [stack for stack in held if stack.work_s > OVER * _allowed(stack)]
    beside = [stack for stack in held if stack not in over and stack.total_s > OVER * _allowed(stack)]
    late = [stack for stack in held if stack not in [*over, *beside] and (stack.p90 or 0.0) > OVER * _allowed(stack)]
    if over:
        yield f"Over {takt} on average: {_named(over, lambda stack: stack.work_s)}."
    if beside:
        yield f"Over {takt} only with set-up and walking: {_named(beside, lambda stack: stack.total_s)}."
    if not over and not beside:
        full = max(held, key=lambda stack: stack.total_s / _allowed(stack))
        of = f"{in_s(full.total_s)} of {in_s(_allowed(full))}"
        yield f"On average every station keeps {takt}; the fullest is {full.name} with {of}."
    if late:
        verb = "needs" if len(late) == 1 else "need"
        names = _named(late, lambda stack: stack.p90 or 0.0)
        yield f"Within {takt} on average, yet one visit in ten {verb} more: {names} at P90."


def _pace(stacks: Sequence[Stack], timed: bool) -> Iterator[str]:
    """timed : whether some jobs come in by time, others as the floor has room"""
    paced = [stack for stack in stacks if stack.allowed_s is not None]
    if paced:
        near = max(paced, key=lambda stack: stack.work_s / _allowed(stack))
        asks = "Takt is asked for some jobs alone: others" if timed else "Nothing asks for a takt: jobs"
        yield (
            f"{asks} come in as the floor has room. The dashed line is the pace it reached; "
            f"nearest to it is {near.name}, at work {100 * near.work_s / _allowed(near):.0f} % of the time between two "
            "visits, and what is missing to 100 % was lost to waiting, blocking and stops."
        )


def person_sentences(stacks: Sequence[Stack]) -> Iterator[str]:
    """Who has most to do for a job, and who least."""
    if not stacks:
        return
    most, least = (pick(stacks, key=lambda stack: stack.total_s) for pick in (max, min))
    kinds = {what for stack in stacks for what in stack.beside}
    spent = listing(["work", *(what for what in (SETTING_UP, WALKING) if what in kinds)])
    if least.total_s > ALIKE * most.total_s:
        yield f"For a finished job everybody spends about as long on {spent}, {in_s(most.total_s)} at most."
        return
    between = "; the others lie between" if len(stacks) > 2 else ""
    yield (
        f"For a finished job {most.name} spends {in_s(most.total_s)} on {spent}, "
        f"{least.name} {in_s(least.total_s)}{between}."
    )


def _allowed(stack: Stack) -> float:
    return stack.allowed_s or float("inf")


def _named(stacks: Sequence[Stack], seconds) -> str:
    """``milling (250 s of 240 s)``, those farthest over first."""
    ranked = sorted(stacks, key=lambda stack: -seconds(stack) / _allowed(stack))
    named = [f"{stack.name} ({in_s(seconds(stack))} of {in_s(_allowed(stack))})" for stack in ranked]
    more = len(named) - MOST_NAMED
    return listing([*named[:MOST_NAMED], f"{more} more"] if more > 0 else named)
