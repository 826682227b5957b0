"""What a modeller has of his workers' work, whatever it is, as rows and as who did it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from opsim.ergonomics.shift.worker_rows import rows_of
from opsim.log import EventLog
from opsim.own_luck import OwnLuck
from opsim.performance import Performance
from opsim.problems import did_you_mean, shown
from opsim.worker import Worker
from opsim.worker_log import WorkerLog

Lucks = dict[str, OwnLuck]
EXPECTED = "a WorkerLog, a list of Performance, or an EventLog with workers=[...]"


def work_done(did: Any, workers: Iterable[Any] | None) -> tuple[EventLog, Lucks]:
    """Rows of work, and by name what decides each worker's draws.

    Raises TypeError for something else, ValueError where it is not known who did it, or where it is of several runs.
    """
    if isinstance(did, WorkerLog):
        found = did.close(), did.lucks
    elif isinstance(did, EventLog):
        found = did, _lucks(workers, did)
    elif isinstance(did, Worker):
        raise TypeError(f"expected {EXPECTED}, found a Worker; give its worker.log")
    else:
        found = _of_pieces(did)
    _must_know_all(*found)
    return found


def _lucks(workers: Iterable[Any] | None, log: EventLog) -> Lucks:
    if workers is None:
        raise ValueError("an EventLog does not say how its workers' work is drawn: give workers=[...] as well")
    named = list(workers)
    for one in named:
        if not isinstance(one, Worker):
            raise TypeError(f"workers: expected Workers, found {shown(one)}")
        if one.luck.replication != log.replication:
            of = f"{one.luck.replication}, the log of {log.replication}"
            raise ValueError(f"workers: {one.name} is of replication {of}")
    return {one.name: one.luck for one in named}


def _of_pieces(did: Any) -> tuple[EventLog, Lucks]:
    pieces: Sequence[Any] = [did] if isinstance(did, Performance) else list(did) if isinstance(did, Iterable) else [did]
    lucks: Lucks = {}
    for one in pieces:
        if not isinstance(one, Performance):
            raise TypeError(f"expected {EXPECTED}, found {shown(one)}")
        luck = one.drawn.luck
        if luck is None:
            raise ValueError(f"{one.worker}, {one.task}: no Worker performed this, so that it cannot be drawn again")
        if lucks.setdefault(one.worker, luck) is not luck and not _same(lucks[one.worker], luck):
            raise ValueError(
                f"worker {one.worker}: these are of two workers, or runs, of one name; score each by itself"
            )
    replications = sorted({luck.replication for luck in lucks.values()})
    if len(replications) > 1:
        raise ValueError(
            f"these are of several replications: {', '.join(map(str, replications))}; score each by itself"
        )
    return rows_of(pieces, *(replications or [0])), lucks


def _same(one: OwnLuck, other: OwnLuck) -> bool:
    names = ("seed", "replication", "workforce", "across_tasks", "body")
    return (
        all(getattr(one, name) == getattr(other, name) for name in names) and one.models.keys() == other.models.keys()
    )


def _must_know_all(log: EventLog, lucks: Lucks) -> None:
    """Raises ValueError with all workers and tasks of a log that nobody knows."""
    named = {(int(worker), int(task)) for worker, task in zip(log["worker"], log["task"]) if worker >= 0 and task >= 0}
    wrong = [
        f"no worker {shown(name)}; {did_you_mean(name, lucks)}" for name in log.names["worker"] if name not in lucks
    ]
    for worker, task in sorted(named):
        whose, what = log.names["worker"][worker], log.names["task"][task]
        if whose in lucks and what not in lucks[whose].models:
            wrong.append(f"worker {whose}: no task {shown(what)}; {did_you_mean(what, lucks[whose].models)}")
    if wrong:
        raise ValueError("\n".join(wrong))
    if not lucks:
        raise ValueError("there are no workers in it")
