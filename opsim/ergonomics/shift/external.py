"""Rows of work as an EventLog that can be looked at: from pieces of performances, or from a log of workers.

Workers of somebody's own model as a Plan, so that all that looks at a scenario's rows can look at theirs.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.ergonomics.options import USUAL, Options
from opsim.external_draws import OwnLuck
from opsim.log import CAUSES, KINDS, NAMED, OFF, ORDER, WORK, WORKER_KINDS, EventLog, event_log, row
from opsim.performance import Performance
from opsim.plan import Plan
from opsim.problems import natural_key
from opsim.subjects.exposure.plan import NOT_SAID, Handling
from opsim.subjects.people.plan import Body, WorkerPlan
from opsim.subjects.tasks.model import TimeModel
from opsim.subjects.tasks.plan import TaskPlan
from opsim.task_model import BODY_KEYS


def natural(names: Iterable[str]) -> tuple[str, ...]:
    """Names, each once, in natural order."""
    return tuple(sorted(set(names), key=natural_key))


def rows_of(pieces: Sequence[Performance], replication: int) -> EventLog:
    """Work, a row a piece; pieces that took no time give none."""
    workers, tasks = natural(one.worker for one in pieces), natural(one.task for one in pieces)
    worked = [
        row(
            *(WORK, one.start_s, one.end_s, workers.index(one.worker)),
            task=tasks.index(one.task),
            performance_id=one.number,
            k=one.k,
            progress_from=one.progress_from,
            progress_to=one.progress_to,
            pace_shift=one.pace_shift,
        )
        for one in pieces
        if one.end_s > one.start_s
    ]
    named = {"kind": KINDS, "cause": CAUSES, "worker": workers, "task": tasks}
    names: dict[str, tuple[str, ...]] = {column: named.get(column, ()) for column in NAMED}
    return event_log(worked, max((one.end_s for one in pieces), default=0.0), names, replication)


def whole_days(log: EventLog, tasks: Iterable[str], low_s: float) -> EventLog:
    """The same rows and, for each worker, ``off`` between: whoever has no row is not there.

    tasks : names, by which tasks are numbered from now on in natural order; those of the log among them
    low_s : from when on somebody is looked at; until the log's horizon
    Raises ValueError where somebody does two things at once.
    """
    names = natural([*tasks, *log.names["task"]])
    rank = np.array([*(names.index(name) for name in log.names["task"]), -1], np.int32)
    off = event_log(_gaps(log, low_s), log.horizon_s, {})
    columns = {name: np.concatenate([log[name], off[name]]) for name in log.columns}
    columns["task"] = rank[columns["task"]]
    order = np.lexsort([columns[name] for name in reversed(ORDER)])
    found = {name: column[order] for name, column in columns.items()}
    return EventLog(log.replication, log.horizon_s, found, {**log.names, "task": names})


def only(log: EventLog, workers: Sequence[int]) -> EventLog:
    """The same rows by number; whoever is not among some workers is off in all of his."""
    others = (log["worker"] >= 0) & ~np.isin(log["worker"], list(workers))
    return EventLog(
        log.replication,
        log.horizon_s,
        {**log.columns, "kind": np.where(others, OFF, log["kind"]).astype(log["kind"].dtype)},
        log.names,
    )


def _gaps(log: EventLog, low_s: float) -> Iterator[tuple]:
    """Rows of the times in which a worker has none."""
    states = np.isin(log["kind"], WORKER_KINDS)
    for worker, name in enumerate(log.names["worker"]):
        rows = np.flatnonzero(states & (log["worker"] == worker) & (log["end_s"] > log["start_s"]))
        rows = rows[np.argsort(log["start_s"][rows], kind="stable")]
        until_s = np.r_[-np.inf, log["end_s"][rows]]
        begun_s = np.r_[log["start_s"][rows], np.inf]
        for at in np.flatnonzero(begun_s[:-1] < until_s[:-1]).tolist():
            raise ValueError(
                f"worker {name}: something else begins at {begun_s[at]:g} s, while the piece before lasts until "
                f"{until_s[at]:g} s; is a piece given twice?"
            )
        for from_s, to_s in zip(np.maximum(until_s, low_s), np.minimum(begun_s, log.horizon_s)):
            if to_s > from_s:
                yield row(OFF, float(from_s), float(to_s), worker)


@dataclass(frozen=True, slots=True)
class OwnPlan(Plan):
    """lucks : what decides the draws of each worker, by rank; they need not be of one seed."""

    lucks: tuple[OwnLuck, ...] = ()


def models_of(lucks: Iterable[OwnLuck]) -> dict[str, Any]:
    """The model of each task; the last one's where workers have different ones under one name."""
    return {task: model for luck in lucks for task, model in luck.models.items()}


def groups(lucks: Mapping[str, OwnLuck]) -> list[list[str]]:
    """Names of workers who can be in one plan: those who mean the same by a task's name."""
    found: list[list[str]] = []
    for name in natural(lucks):
        for group in found:
            if all(_agree(lucks[name], lucks[other]) for other in group):
                group.append(name)
                break
        else:
            found.append([name])
    return found


def plan_of(
    lucks: Mapping[str, OwnLuck],
    group: Iterable[str],
    handling: Mapping[str, Handling] | None = None,
    options: Options = USUAL,
    window_s: tuple[float, float] = (0.0, 0.0),
    start_s: float = 0.0,
) -> OwnPlan:
    """A plan of all workers that gives what those of one group do; ranks are the same whatever the group.

    handling : by name of task, before what the workers say themselves
    window_s : from and until when figures count; start_s : when on the clock 0 is
    """
    everybody = tuple(lucks[name] for name in natural(lucks))
    own = [*everybody, *(lucks[name] for name in group)]
    models = models_of(own)
    said = {task: one for luck in own for task, one in luck.handling.items()} | dict(handling or {})
    return OwnPlan(
        name="workers",
        seed=own[-1].seed,
        horizon_s=window_s[1],
        warm_up_s=window_s[0],
        places=(),
        distance_m=(),
        tasks=tuple(
            TaskPlan(name, models[name], repeat=1, automatic=False, handling=said.get(name, NOT_SAID))
            for name in natural(models)
        ),
        stations=(),
        products=(),
        sources=(),
        workers=tuple(_worker(luck) for luck in everybody),
        rule="",
        when_blocked="",
        idle="",
        staffing="fixed",
        across_tasks=own[-1].across_tasks,
        ergonomics=options,
        start_s=start_s,
        lucks=everybody,
    )


def _worker(luck: OwnLuck) -> WorkerPlan:
    read = luck.body.get if isinstance(luck.body, Mapping) else lambda key: getattr(luck.body, key, None)
    return WorkerPlan(luck.worker, 0, 1.0, (1.0,), Body(**{key: read(key) for key in BODY_KEYS}))


def _agree(one: OwnLuck, other: OwnLuck) -> bool:
    shared = one.models.keys() & other.models.keys()
    said = all(one.handling.get(task) == other.handling.get(task) for task in shared)
    return said and all(_alike(one.models[task], other.models[task]) for task in shared)


def _alike(one: Any, other: Any) -> bool:
    """The same bodies, or both none; NOTE: times are drawn by a worker's own model, whatever the plan's."""
    return one is other or (isinstance(one, TimeModel) and isinstance(other, TimeModel))
