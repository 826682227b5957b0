"""Which repetition each performance was, read again from the rows of a log: by what the worker had behind him then.

How tired people were, read again from the rows of a log: by the same code, told the same.

What became of each performance that was broken off: its pieces, in order, job by job.

Where everybody is all the time: what a replay shows, and the proof that nothing of it is missing.

The walks of a replication: whose, the how many-th, how far, and from when to when.

What was drawn for performances, all of a worker's in a task at once, by the names of the engine's draws.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any
from weakref import ref

import numpy as np

from opsim.clock import TICKS_PER_S, ticks
from opsim.log import ABSENT, OFF, REPAIR, SETUP, WALK, WORK, WORKER_KINDS, EventLog
from opsim.plan import Plan
from opsim.streams import BLOCK, stream
from opsim.subjects.human.fatigue import Tired, tired
from opsim.subjects.human.forgetting import Memory, experience_of, first_times
from opsim.subjects.human.muscle_fatigue import Burdens
from opsim.threads import one_blas_thread


@dataclass(frozen=True, slots=True)
class Practice:
    """Of each row of work of a worker at his own pace: ``row`` (R,) its number in the log, ``repetition`` (R,) which
    repetition its performance was, forgotten ones not counted, ``multiplier`` (R,) of time that this gives."""

    row: np.ndarray
    repetition: np.ndarray
    multiplier: np.ndarray


def own_rows(log: EventLog, plan: Plan) -> np.ndarray:
    """Numbers of the rows of work and set-ups whose time is the worker's own draw, by worker and start."""
    by_worker = np.array([not task.attended for task in plan.tasks])
    named = (log["worker"] >= 0) & (log["task"] >= 0) & (log["k"] >= 0)
    rows = np.flatnonzero(named & np.isin(log["kind"], (WORK, SETUP)))
    rows = rows[by_worker[log["task"][rows]]]
    return rows[np.lexsort((log["end_s"][rows], log["start_s"][rows], log["worker"][rows]))]


def practice(log: EventLog, plan: Plan) -> Practice:
    """The repetition and the multiplier behind each row; without learning, both by count alone and 1.

    Without forgetting, draws are counted: also of what was broken off in the instant in which it began.
    """
    rows, learning = own_rows(log, plan), plan.human.learning
    counted = _counted(log, plan, rows)
    n = counted if plan.human.forgetting is None or learning is None else _remembered(log, plan, rows)
    if learning is None:
        return Practice(rows, n, np.ones(rows.size))
    different, which = np.unique(n, return_inverse=True)
    return Practice(rows, n, np.array([learning.multiplier(one) for one in different.tolist()])[which])


def _counted(log: EventLog, plan: Plan, rows: np.ndarray) -> np.ndarray:
    """(R,) his experience at the start, and one for each performance until this one."""
    worker, task, k = (log[name][rows] for name in ("worker", "task", "k"))
    behind = np.array([experience_of(plan, at) or (0.0,) * len(plan.tasks) for at in range(len(plan.workers))])
    return (behind[worker, task] if rows.size else np.empty(0)) + k + 1.0


def _remembered(log: EventLog, plan: Plan, rows: np.ndarray) -> np.ndarray:
    """(R,) as the engine counted it, by the same memory, told the same in the same order."""
    first_s = first_times(plan, plan.human.learning)
    columns = [log[name][rows].tolist() for name in ("worker", "task", "k", "start_s", "end_s")]
    begun: dict[tuple[int, int], float] = {}
    found, memory, at = np.empty(rows.size), None, -1
    for place, (worker, task, k, start_s, end_s) in enumerate(zip(*columns)):
        if memory is None or worker != at:
            at, begun = worker, {}
            memory = Memory(plan.human.learning, plan.human.forgetting, experience_of(plan, worker), first_s)
        if (task, k) not in begun:  # else it is gone on with, maybe after others of the task
            begun[task, k] = memory.begins(task, k, start_s)
        memory.works(start_s, task, k, end_s)
        found[place] = begun[task, k]
    return found


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


FATES = ("finished", "resumed", "by_another", "handed_over", "restarted", "open")
"""What becomes of the rest of a piece: nothing is left; who did it goes on; another one does, later or at once; all of
it is begun anew; or nobody goes on with it until the run ends or the job is gone."""
FINISHED, RESUMED, BY_ANOTHER, HANDED_OVER, RESTARTED, OPEN = range(len(FATES))


@dataclass(frozen=True)
class JobPieces:
    """Pieces of work and of set-ups by job, work before set-ups, and time; every array is (P,).

    row    : which row of the log it is
    before : the piece before it of the same job and kind, -1 where there is none; left : whether a rest of it was left
    fate   : the number of what becomes of its own rest, in ``FATES``
    """

    row: np.ndarray
    before: np.ndarray
    left: np.ndarray
    fate: np.ndarray


def job_pieces(log: EventLog) -> JobPieces:
    """All pieces that name a job; the parts that members of a team have beside them do not."""
    rows = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & (log["job"] >= 0))
    rows = rows[np.lexsort([log["start_s"][rows], log["kind"][rows], log["job"][rows]])]
    follows = np.zeros(rows.size, dtype=bool)
    follows[1:] = _same(log, rows, "job", "kind")
    left = follows.copy()
    left[1:] &= log["progress_to"][rows][:-1] < 1.0
    return JobPieces(rows, np.where(follows, np.arange(rows.size) - 1, -1), left, _fates(log, rows, left))


def _fates(log: EventLog, rows: np.ndarray, left: np.ndarray) -> np.ndarray:
    """(P,) what becomes of each piece's rest."""
    fate = np.where(log["progress_to"][rows] < 1.0, OPEN, FINISHED)
    if not rows.size:
        return fate
    at_once = log["start_s"][rows][1:] == log["end_s"][rows][:-1]
    met = np.where(at_once & ~_same(log, rows, "worker"), HANDED_OVER, BY_ANOTHER)
    met = np.where(_same(log, rows, "performance_id"), RESUMED, met)
    met = np.where(log["progress_from"][rows][1:] == 0.0, RESTARTED, met)
    met = np.where(_same(log, rows, "task", "station"), met, OPEN)
    fate[:-1] = np.where(left[1:], met, fate[:-1])
    return fate


def _same(log: EventLog, rows: np.ndarray, *columns: str) -> np.ndarray:
    """(P - 1,) whether a row agrees with the one before it in all of some columns."""
    return np.all([log[name][rows][1:] == log[name][rows][:-1] for name in columns], axis=0)


NOWHERE = -1
"""The place of who is off or absent: he is not on the floor."""


@dataclass(frozen=True)
class Whereabouts:
    """What workers do and where, by worker and time; every array is (R,).

    row : which row of the log; place_from, place_to : ranks of places, the same but where somebody walks; ``NOWHERE``
    """

    row: np.ndarray
    worker: np.ndarray
    kind: np.ndarray
    start_s: np.ndarray
    end_s: np.ndarray
    place_from: np.ndarray
    place_to: np.ndarray


def whereabouts(log: EventLog, plan: Plan) -> Whereabouts:
    """All rows of workers; who works is where the station is."""
    rows = np.flatnonzero(np.isin(log["kind"], WORKER_KINDS) & (log["worker"] >= 0))
    rows = rows[np.lexsort([log["end_s"][rows], log["start_s"][rows], log["worker"][rows]])]
    kind, station = log["kind"][rows], log["station"][rows]
    of_station = np.array([*(place.place for place in plan.stations), NOWHERE])
    at_work = np.isin(kind, (WORK, SETUP, REPAIR))
    gone = np.isin(kind, (OFF, ABSENT))
    places = (
        np.where(gone, NOWHERE, np.where(at_work, of_station[station], log[name][rows]))
        for name in ("place_from", "place_to")
    )
    return Whereabouts(rows, log["worker"][rows], kind, log["start_s"][rows], log["end_s"][rows], *places)


def unaccounted(log: EventLog, plan: Plan) -> Iterator[str]:
    """Every second of a worker that the rows do not account for with one thing he does and one place, in words.

    Each second of the run belongs to exactly one row; nobody who is there is nowhere; nobody moves but by a walk, whose
    ends are apart; who comes back from outside stands at his home. Nothing is yielded where a replay can be whole.
    """
    seen = whereabouts(log, plan)
    first = np.searchsorted(seen.worker, np.arange(len(plan.workers) + 1))
    for rank, (begin, end) in enumerate(pairwise(first.tolist())):
        for found in (*_times(seen, begin, end, log.horizon_s), *_places(seen, begin, end, plan, rank)):
            yield f"worker {plan.workers[rank].name}: {found}"


def _times(seen: Whereabouts, begin: int, end: int, horizon_s: float) -> Iterator[str]:
    ends, starts = (
        ticks(edge) for edge in (np.r_[0.0, seen.end_s[begin:end]], np.r_[seen.start_s[begin:end], horizon_s])
    )
    for at in np.flatnonzero(ends != starts)[:1]:
        what = "two things at once" if ends[at] > starts[at] else "nothing is known of him"
        yield f"{what} from {min(ends[at], starts[at]) / 2**20:g} s to {max(ends[at], starts[at]) / 2**20:g} s"


def _places(seen: Whereabouts, begin: int, end: int, plan: Plan, rank: int) -> Iterator[str]:
    place_from, place_to = seen.place_from[begin:end], seen.place_to[begin:end]
    kind, start_s = seen.kind[begin:end], seen.start_s[begin:end]
    nowhere = ~np.isin(kind, (OFF, ABSENT)) & ((place_from < 0) | (place_to < 0))
    for at in np.flatnonzero(nowhere)[:1]:
        yield f"there, but at no place at {start_s[at]:g} s"
    at_home = plan.workers[rank].place
    came_from = np.r_[at_home, np.where(place_to < 0, at_home, place_to)[:-1]]
    apart_m = np.array(plan.distance_m)[came_from, place_from]
    jumps = (place_from >= 0) & (came_from != place_from) & (apart_m > 0)
    for at in np.flatnonzero(jumps)[:1]:
        here, there = plan.places[place_from[at]], plan.places[came_from[at]]
        yield f"at {here} at {start_s[at]:g} s, and no walk led there from {there}"
    moves = (kind != WALK) & (place_from != place_to)
    for at in np.flatnonzero(moves)[:1]:
        yield f"moves without a walk at {start_s[at]:g} s"


@dataclass(frozen=True)
class Walks:
    """All walks of a replication by worker and time, each (R,): item ``k`` is a worker's k-th walk, from 0.

    whole_s : what the walk takes to its end; one that the horizon cuts off ends before
    """

    worker: np.ndarray
    k: np.ndarray
    place_from: np.ndarray
    place_to: np.ndarray
    distance_m: np.ndarray
    start_s: np.ndarray
    end_s: np.ndarray
    whole_s: np.ndarray


def walks_of(log: EventLog, plan: Plan) -> Walks:
    """The walks behind the rows of one replication."""
    rows = walk_rows(log)
    worker, place_from, place_to = (log[name][rows] for name in ("worker", "place_from", "place_to"))
    first = np.searchsorted(worker, worker)
    speed_m_per_s = np.array([person.walk_m_per_s for person in plan.workers])[worker]
    distance_m = ways_m(log, plan, rows, speed_m_per_s)
    return Walks(
        worker,
        np.arange(rows.size) - first,
        place_from,
        place_to,
        distance_m,
        log["start_s"][rows],
        log["end_s"][rows],
        on_grid_each(distance_m / speed_m_per_s),
    )


def walk_rows(log: EventLog) -> np.ndarray:
    """(R,) rows of the log in which somebody walks, by worker and time."""
    rows = np.flatnonzero((log["kind"] == WALK) & (log["worker"] >= 0))
    return rows[np.lexsort([log["start_s"][rows], log["worker"][rows]])]


def ways_m(log: EventLog, plan: Plan, rows: np.ndarray, speed_m_per_s: np.ndarray) -> np.ndarray:
    """(n,) metres of each of some walks; along a moving line, where the place stays the same, as far as the time goes.

    speed_m_per_s : (n,) of who walks
    """
    place_from, place_to = log["place_from"][rows], log["place_to"][rows]
    way_m = np.array(plan.distance_m)[place_from, place_to]
    if not any(line.moves for line in plan.lines):
        return way_m
    return np.where(place_from == place_to, log.duration_s[rows] * speed_m_per_s, way_m)


def on_grid_each(seconds: np.ndarray) -> np.ndarray:
    """(n,) as ``opsim.clock.on_grid`` rounds each: a walk as the engine takes it."""
    return np.maximum(1.0, np.rint(seconds * TICKS_PER_S)) / TICKS_PER_S


def drawn_s(plan: Plan, replication: int, worker: int, task: int, k: np.ndarray) -> np.ndarray:
    """(n,) seconds of a worker's performances ``k`` (n,) of a task, at rating 1 and without human effects."""
    person, named = plan.workers[worker], plan.tasks[task]
    model: Any = named.model
    if getattr(model, "by_index", False):
        return np.asarray(model.at(k), dtype=np.float64)
    numbers, which = np.unique(k // BLOCK, return_inverse=True)
    with one_blas_thread():
        effect = plan.worker_effect(worker, named, replication)
        blocks = [_block(plan, replication, person.name, named, effect, number) for number in numbers.tolist()]
    return np.array(blocks).reshape(-1, BLOCK)[which, k % BLOCK]


def _block(plan: Plan, replication: int, worker: str, task: Any, effect: Any, number: int) -> np.ndarray:
    rng = stream(plan.seed, replication, "duration", task.stream_name, worker, number)
    return np.asarray(task.model.sample(BLOCK, rng, worker=effect).duration_s)
