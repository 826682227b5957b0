"""The law of pace: where human effects act on times, each took what was drawn, times what the effects made of it.

The laws of fatigue: how far each time was shifted is what the worker's day made of him; and he rests when tired.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.clock import STEP_S, ticks
from opsim.history import Practice, drawn_s, levels_at, practice, tiredness
from opsim.laws.jobs import Stays
from opsim.log import BREAK, OFF, REST, EventLog
from opsim.plan import Plan

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
