"""The law of pace: where human effects act on times, each took what was drawn, times what the effects made of it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.clock import STEP_S
from opsim.drawn_times import drawn_s
from opsim.laws.stays import Stays
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.practice import Practice, practice

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
