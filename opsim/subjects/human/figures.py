"""Learning, fatigue and rest as figures.

The law of pace: where human effects act on times, each took what was drawn, times what the effects made of it.

The laws of fatigue: how far each time was shifted is what the worker's day made of him; and he rests when tired.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.clock import STEP_S, ticks
from opsim.history import Practice, Tiredness, drawn_s, levels_at, practice, tiredness
from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import in_window, inside_s
from opsim.laws.jobs import Stays
from opsim.log import BREAK, OFF, REST, EventLog
from opsim.plan import Plan
from opsim.subjects.shifts.figures import present_s


def learned(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Where people learn, of the performances that begin in the window:

    learned_share : time as a share of that of the first repetition; the mean of all and of each worker, and, with the
                    task as part, that of his last one
    experience    : repetitions behind a worker, by task, after his last one; forgotten ones do not count
    """
    if plan.human.learning is None:
        return
    found = _in_window(log, plan, practice(log, plan))
    share = found.multiplier / plan.human.learning.multiplier(1.0)
    worker, task = log["worker"][found.row], log["task"][found.row]
    yield figure("learned_share", "", "", _mean(share))
    for rank, person in enumerate(plan.workers):
        rows = np.flatnonzero(worker == rank)
        yield figure("learned_share", person.name, "", _mean(share[rows]))
        for at in np.unique(task[rows]).tolist():
            last = rows[task[rows] == at][-1]
            yield figure("learned_share", person.name, plan.tasks[at].name, share[last])
            yield figure("experience", person.name, plan.tasks[at].name, found.repetition[last])


def _in_window(log: EventLog, plan: Plan, found: Practice) -> Practice:
    """The first rows of the performances that begin in the window."""
    _, first = np.unique(log["performance_id"][found.row], return_index=True)
    first = np.sort(first[in_window(log["start_s"][found.row[first]], plan)])
    return Practice(found.row[first], found.repetition[first], found.multiplier[first])


def _mean(values: np.ndarray) -> float:
    return float(values.mean()) if values.size else float("nan")


def fatigue(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Where people tire, of all of them (no subject) and of each, in the window:

    fatigue_mean : their fatigue, 0 to 1, over the time they work: half of it as a piece of work begins, half as it ends
    fatigue_most : the most that any piece of work has left; part: a joint, where the model follows joints
    rest_taken_min_per_h : minutes of rest by need in an hour in which they are there; only where people rest so
    """
    if plan.human.fatigue is None:
        return
    found = tiredness(log, plan)
    spent_s, worker = inside_s(log, found.row, plan), log["worker"][found.row]
    for name, rows in _of_whom(worker, plan):
        own = np.flatnonzero(rows & (spent_s > 0))
        yield figure("fatigue_mean", name, "", _mean_fatigue(found, spent_s, own))
        yield figure("fatigue_most", name, "", found.end[own].max() if own.size else np.nan)
        for at, joint in enumerate(found.joints):
            yield figure("fatigue_most", name, joint, found.by_joint[own, at].max() if own.size else np.nan)
    if plan.human.rest is not None:
        yield from _rested(log, plan)


def _of_whom(worker: np.ndarray, plan: Plan) -> Iterator[tuple[str, np.ndarray]]:
    yield "", np.ones(worker.size, bool)
    yield from ((person.name, worker == rank) for rank, person in enumerate(plan.workers))


def _mean_fatigue(found: Tiredness, spent_s: np.ndarray, own: np.ndarray) -> float:
    if not own.size:
        return float("nan")
    return float(np.average(0.5 * (found.begin[own] + found.end[own]), weights=spent_s[own]))


def _rested(log: EventLog, plan: Plan) -> Iterator[Figure]:
    rows = np.flatnonzero((log["kind"] == BREAK) & (log["cause"] == REST))
    there_s = present_s(log, plan)
    taken_s = np.bincount(log["worker"][rows], weights=inside_s(log, rows, plan), minlength=there_s.size)
    for name, rested, there in (
        ("", taken_s.sum(), there_s.sum()),
        *((person.name, taken_s[rank], there_s[rank]) for rank, person in enumerate(plan.workers)),
    ):
        yield figure("rest_taken_min_per_h", name, "", 60.0 * rested / there if there > 0 else np.nan)


SLACK_S = 4 * STEP_S
"""A time is rounded to the grid once, and once more where it is the rest of another."""


def pace(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """Seconds of a piece = drawn time x learning x exp(shift) / rating x share of the performance.

    Shifts are those of the rows; where effects are plain factors and no row tells of them, nothing can be asked.
    Who is helped goes at the pace of two, and is passed over.
    """
    human = plan.human
    shifts = (human.fatigue, human.state_pace, human.circadian)
    if not human.changes_times or (human.acts_on == "time" and any(effect is not None for effect in shifts)):
        return
    found = practice(log, plan)
    alone = ~np.isin(log["station"][found.row], _helped(plan))
    found = Practice(found.row[alone], found.repetition[alone], found.multiplier[alone])
    share = log["progress_to"][found.row] - log["progress_from"][found.row]
    expected_s = _whole_s(log, plan, found) * share
    took_s = log.duration_s[found.row]
    for at in np.flatnonzero(np.abs(took_s - expected_s) > SLACK_S + 1e-9 * expected_s)[:1]:
        row = int(found.row[at])
        worker, task, k = (int(log[name][row]) for name in ("worker", "task", "k"))
        yield (
            f"{plan.workers[worker].name}, {plan.tasks[task].name} {k}, at {log['start_s'][row]:.9g} s: took "
            f"{took_s[at]:.9g} s, and its draw, learning and shift give {expected_s[at]:.9g} s"
        )


def _helped(plan: Plan) -> list[int]:
    """Stations where one may help another."""
    return [station for line in plan.lines if line.helps for station in line.stations]


def _whole_s(log: EventLog, plan: Plan, found: Practice) -> np.ndarray:
    """(R,) seconds that the whole of each performance takes the worker at the station."""
    worker, task, k, station = (log[name][found.row] for name in ("worker", "task", "k", "station"))
    seconds = np.empty(found.row.size)
    for who, what in np.unique(np.stack((worker, task)), axis=1).T.tolist():
        rows = np.flatnonzero((worker == who) & (task == what))
        seconds[rows] = drawn_s(plan, log.replication, who, what, k[rows])
    rating = np.array([person.rating for person in plan.workers])[worker, station] if worker.size else np.empty(0)
    return seconds * found.multiplier * np.exp(log["pace_shift"][found.row]) / rating


SLACK = 1e-9


def shifts(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """``pace_shift`` of a performance = what the fatigue as it begins, and the time of the day, shift.

    Nothing can be asked where the state of the line acts too, where effects are plain factors, of a time that is the
    station's, and of who is helped and goes on at the pace of two.
    """
    human = plan.human
    if human.fatigue is None or human.state_pace is not None or human.acts_on == "time":
        return
    found = tiredness(log, plan)
    rows = found.row
    asked = np.array([not task.attended for task in plan.tasks])[log["task"][rows]]
    asked &= ~np.isin(log["station"][rows], [s for line in plan.lines if line.helps for s in line.stations])
    first = np.zeros(rows.size, bool)
    first[np.unique(log["performance_id"][rows], return_index=True)[1]] = True
    at = np.flatnonzero(asked & first)
    expected = np.array([human.fatigue.shift(level) for level in found.begin[at].tolist()])
    if human.circadian is not None:
        expected += [human.circadian.shift(human.start_s + now) for now in log["start_s"][rows[at]].tolist()]
    wrong = np.flatnonzero(np.abs(log["pace_shift"][rows[at]] - expected) > SLACK)
    for one in wrong[:1]:
        row = rows[at[one]]
        yield (
            f"{plan.workers[log['worker'][row]].name}, at {log['start_s'][row]:.9g} s: log time is shifted by "
            f"{log['pace_shift'][row]:.9g}, and his fatigue makes {expected[one]:.9g}"
        )


def rests(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """A rest by need begins where somebody is too tired, and lasts until he is down to what was said, and no longer; or
    less, where his calendar calls him away, or the run ends.
    """
    rows = np.flatnonzero((log["kind"] == BREAK) & (log["cause"] == REST))
    human = plan.human
    if rows.size and (human.rest is None or human.fatigue is None):
        who = plan.workers[log["worker"][rows[0]]].name
        yield f"{who} rests by need at {log['start_s'][rows[0]]:.9g} s, and nobody does"
        return
    for rank in np.unique(log["worker"][rows]).tolist():
        own = rows[log["worker"][rows] == rank]
        times_s = np.stack([log["start_s"][own], log["end_s"][own]], axis=1)
        levels = levels_at(log, plan, rank, times_s.ravel()).reshape(-1, 2)
        called = ticks([log.horizon_s, *_calls(log, plan, rank)])
        for (start_s, end_s), (before, after) in zip(times_s.tolist(), levels.tolist()):
            said = f"{plan.workers[rank].name} rests from {start_s:.9g} s to {end_s:.9g} s"
            if before <= human.rest.above - SLACK:
                yield f"{said}, and his fatigue was {before:.6g}"
                return
            if after < human.rest.until - 1e-4 or (after > human.rest.until + SLACK and ticks(end_s) not in called):
                yield f"{said}, and comes back with a fatigue of {after:.6g}"
                return


def _calls(log: EventLog, plan: Plan, rank: int) -> Iterator[float]:
    """When a worker's calendar may call him away from a rest; in overtime, whenever he goes home."""
    goes_s = log["start_s"][(log["kind"] == OFF) & (log["worker"] == rank)]
    for duty in plan.workers[rank].duties or ():
        until_s = duty.end_s + plan.shifts[duty.shift].overtime_s
        yield from (duty.end_s, until_s, *goes_s[(goes_s >= duty.end_s) & (goes_s <= until_s)].tolist())
        yield from (pause.start_s for pause in duty.pauses)
