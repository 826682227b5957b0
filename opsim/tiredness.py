"""How tired people were, read again from the rows of a log: by the same code, told the same."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from weakref import ref

import numpy as np

from opsim.human.burden import Burdens
from opsim.human.tired import Tired, tired
from opsim.log import SETUP, WORK, EventLog
from opsim.plan import Plan


@dataclass(frozen=True, slots=True)
class Tiredness:
    """Of each row (R,) of work and set-ups of workers, by worker and start: its number in the log, and the fatigue of
    the worker as it begins and as it ends.

    joints : names of the joints that the model follows; by_joint : (R, J) fatigue of each as the row ends
    """

    row: np.ndarray
    begin: np.ndarray
    end: np.ndarray
    joints: tuple[str, ...]
    by_joint: np.ndarray


_last: tuple[ref, ref | None, Tiredness] | None = None
"""What was read last: law and figures ask for the same."""


def tiredness(log: EventLog, plan: Plan) -> Tiredness:
    """The fatigue of all workers of a plan in which people tire."""
    global _last
    if _last is None or _last[0]() is not log or _last[1] is not plan.human.fatigue:
        _last = ref(log), plan.human.fatigue, _read(log, plan)
    return _last[2]


def levels_at(log: EventLog, plan: Plan, rank: int, times_s: np.ndarray) -> np.ndarray:
    """(T,) fatigue of a worker at times in their order, none of them within his work."""
    found, asked, at = np.empty(times_s.size), times_s.tolist(), 0
    one = _fresh(log, plan, rank)
    for piece in _pieces(log, _rows(log, rank)):
        while at < len(asked) and asked[at] <= piece[1]:
            found[at] = one.level_at(asked[at])
            at += 1
        _work(one, *piece[1:])
    found[at:] = [one.level_at(now) for now in asked[at:]]
    return found


def _fresh(log: EventLog, plan: Plan, rank: int) -> Tired:
    return tired(plan.human.fatigue, Burdens(plan, plan.workforce_of(log.replication)), rank)


def _pieces(log: EventLog, rows: np.ndarray) -> Iterator[tuple]:
    """Row, start, end, task, and from and to which share of it, of each piece of work."""
    columns = [log[name][rows].tolist() for name in ("start_s", "end_s", "task", "progress_from", "progress_to")]
    return zip(rows.tolist(), *columns)


def _work(one: Tired, start_s: float, end_s: float, task: int, first: float, last: float) -> None:
    share = (last - first) / (1.0 - first) if first < 1.0 else 1.0
    until_s = end_s if last == 1.0 or share <= 0 else start_s + (end_s - start_s) / share
    one.works(start_s, task, until_s, first)
    one.stops(end_s)


def _rows(log: EventLog, rank: int | None = None) -> np.ndarray:
    """Work and set-ups of all workers, or of one, by worker and start."""
    whose = log["worker"] >= 0 if rank is None else log["worker"] == rank
    rows = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & whose & (log["task"] >= 0))
    return rows[np.lexsort((log["end_s"][rows], log["start_s"][rows], log["worker"][rows]))]


def _read(log: EventLog, plan: Plan) -> Tiredness:
    model, rows = plan.human.fatigue, _rows(log)
    joints = tuple(model.by_joint(model.fresh()))
    begin, end, by_joint = np.empty(rows.size), np.empty(rows.size), np.empty((rows.size, len(joints)))
    at, one = -1, None
    for place, (row, *piece) in enumerate(_pieces(log, rows)):
        if one is None or log["worker"][row] != at:
            at = int(log["worker"][row])
            one = _fresh(log, plan, at)
        begin[place] = one.level_at(piece[0])
        _work(one, *piece)
        end[place] = model.level(one.state)
        if joints:
            by_joint[place] = list(model.by_joint(one.state).values())
    return Tiredness(rows, begin, end, joints, by_joint)
