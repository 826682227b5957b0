"""What a log shows that blocks really did, where neither a kind of row nor a cause tells it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from contests import CONTESTED, contested, met_at_work, stays_on
from shown_blocks import _posts_seen

from opsim import log as kinds
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.streams import BLOCK

ACT_WORDS = (
    *(f"act: {rule} at work" for rule in CONTESTED),
    *("act: overtime worked", "act: posts changed", "act: called to a line", "act: shared task at the next station"),
    *("act: goes home or on a round", "act: both of parallel stations", "act: another worker goes on"),
    *("act: walks more than once", "act: moves a shift of pace", "act: vehicle with several jobs"),
    "act: beyond a block of draws",
)


def acts_of(plan: Plan, log: EventLog) -> set[str]:
    """Its words of ``ACT_WORDS``: rules of interruption that were contested as ``contests`` has it, and other acts."""
    work = log.where(log["kind"] == kinds.WORK)
    said = {
        "overtime worked": any(shift.overtime_s > 0 for shift in plan.shifts) and stays_on(log, plan),
        "posts changed": any(_posts_seen(log, turns) for turns in plan.rotations),
        "called to a line": any(_at(work, line.floaters, line.stations) for line in plan.lines),
        "shared task at the next station": any(_does(work, share.partner, share.tasks) for share in plan.shares),
        "goes home or on a round": bool(np.any((log["kind"] == kinds.WALK) & (log["job"] < 0))),
        "both of parallel stations": _both(plan, work),
        "another worker goes on": _goes_on(work),
        "walks more than once": _walks_again(log),
        "moves a shift of pace": bool(np.any(np.nan_to_num(work["pace_shift"]) != 0)),
        "beyond a block of draws": _beyond_a_block(plan, work),
        "vehicle with several jobs": _shares_a_ride(plan, log),
    }
    rules = {f"act: {rule} at work" for rule in contested(met_at_work(log, plan))}
    return rules | {f"act: {word}" for word, is_so in said.items() if is_so}


def _at(work: EventLog, workers: tuple[int, ...], stations: tuple[int, ...]) -> bool:
    return bool(np.any(np.isin(work["worker"], workers) & np.isin(work["station"], stations)))


def _does(work: EventLog, station: int, tasks: tuple[int, ...]) -> bool:
    return bool(np.any((work["station"] == station) & np.isin(work["task"], tasks)))


def _both(plan: Plan, work: EventLog) -> bool:
    choices = {step.stations for product in plan.products for step in product.route if len(step.stations) > 1}
    return any(np.isin(step, work["station"]).all() for step in choices)


def _goes_on(work: EventLog) -> bool:
    """Whether somebody did the rest of what another one had begun."""
    rows = zip(*(work[name].tolist() for name in ("job", "task", "worker", "progress_from", "progress_to")))
    left: dict[tuple[int, int], int] = {}
    for job, task, worker, begins, ends in rows:
        if begins > 0 and left.get((job, task), worker) != worker:
            return True
        if ends < 1:
            left[job, task] = worker
    return False


def _walks_again(log: EventLog) -> bool:
    """Whether somebody carried a job in several walks, there and back."""
    rows = log.where((log["kind"] == kinds.WALK) & (log["job"] >= 0))
    rows = rows.where(np.lexsort([rows["start_s"], rows["worker"]]))
    of_walk = [rows[name].tolist() for name in ("worker", "job", "place_from", "place_to", "start_s", "end_s")]
    walks = [((worker, job), (a, b), start_s, end_s) for worker, job, a, b, start_s, end_s in zip(*of_walk)]
    return any(one[0] == then[0] and one[1] == then[1][::-1] and one[3] == then[2] for one, then in pairwise(walks))


def _beyond_a_block(plan: Plan, work: EventLog) -> bool:
    """Whether somebody, or a station alone, took more times by chance than are drawn at once."""
    drawn = [rank for rank, task in enumerate(plan.tasks) if type(task.model).__name__ != "Fixed"]
    return bool(np.any((work["k"] >= BLOCK) & np.isin(work["task"], drawn)))


def _shares_a_ride(plan: Plan, log: EventLog) -> bool:
    """Whether a vehicle brought several jobs at once: two rides of one leg, by few vehicles, that overlap."""
    few = {(leg.before, leg.after): truck.n for truck in plan.transporters for leg in truck.legs}
    rides = log.where((log["kind"] == kinds.TRANSPORT) & (log["worker"] < 0) & (log["job"] >= 0))
    spans = sorted(zip(rides["start_s"].tolist(), rides["end_s"].tolist()))
    overlap = sum(b[0] < a[1] for a, b in pairwise(spans))
    return bool(few) and not plan.conveyors and max(few.values()) == 1 and overlap > 0
