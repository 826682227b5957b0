"""When each job was on the floor, in whole ticks of 2^-20 s, so that equal means equal; and what laws do with rows.

Laws of jobs: none comes from nowhere or vanishes, and each is in one state at a time.

The law of places: every second of every worker has one.

The law of workers: each is somewhere, and in one place.

The law of progress: the pieces of a performance follow one another, and add up to one.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.clock import STEP_S, ticks
from opsim.history import JobPieces, job_pieces, unaccounted
from opsim.log import CREATE, FINISH, JOB_KINDS, JOIN, LEAVING_KINDS, SPLIT, WORK, WORKER_KINDS, EventLog
from opsim.plan import Plan


class Stays:
    """Arrivals and leavings of all jobs, by job number.

    number, enter, leave : (J,) sorted by number; who did not leave stays until the horizon
    left_number, left    : (L,) of those who left, in time
    rows                 : the rows that are states of a job
    """

    def __init__(self, log: EventLog):
        created, gone = log.of(CREATE), log.of(*LEAVING_KINDS)
        order = np.argsort(created["job"], kind="stable")
        self.number = created["job"][order]
        self.enter = ticks(created["end_s"][order])
        self.horizon = int(ticks(log.horizon_s))
        self.left_number, self.left = gone["job"], ticks(gone["end_s"])
        self.leave = np.full(self.number.size, self.horizon)
        known = np.isin(self.left_number, self.number)
        self.leave[np.searchsorted(self.number, self.left_number[known])] = self.left[known]
        self.rows = log.where(np.isin(log["kind"], JOB_KINDS) & (log["job"] >= 0))


def untiled(rows: EventLog, subject, subjects, begin, end, what: str) -> Iterator[str]:
    """Rows of each subject must cover [begin, end) of it, one after the other. ``subjects`` is sorted."""
    order = np.lexsort([rows["end_s"], rows["start_s"], subject])
    who, start, stop = subject[order], ticks(rows["start_s"])[order], ticks(rows["end_s"])[order]
    same = who[1:] == who[:-1]
    apart = same & (start[1:] != stop[:-1])
    if np.any(apart):
        i = int(np.flatnonzero(apart)[0])
        found = "overlap" if start[i + 1] < stop[i] else "gap"
        yield f"{what} {who[i]}: {found} between rows ending {words(stop[i])} and starting {words(start[i + 1])}"
    first = np.flatnonzero(np.r_[True, ~same]) if who.size else np.array([], dtype=int)
    last = np.r_[first[1:], who.size] - 1 if who.size else first
    from_tick, to_tick = begin.copy(), begin.copy()
    at = np.searchsorted(subjects, who[first])
    from_tick[at], to_tick[at] = start[first], stop[last]
    wrong = np.flatnonzero((from_tick != begin) | (to_tick != end))
    if wrong.size:
        i = int(wrong[0])
        yield (
            f"{what} {subjects[i]}: rows cover {words(from_tick[i])} to {words(to_tick[i])}, "
            f"its stay is {words(begin[i])} to {words(end[i])}"
        )


def peak(rows: EventLog, units: np.ndarray | int = 1) -> int:
    """Most units of rows open at once; a row that ends makes room before one that starts then.

    units : (rows,) how much each row counts
    """
    times = np.concatenate([ticks(rows["end_s"]), ticks(rows["start_s"])])
    counted = np.broadcast_to(units, len(rows))
    steps = np.concatenate([-counted, counted])
    order = np.lexsort([steps, times])
    return int(max(np.cumsum(steps[order]), default=0))


def words(tick: int) -> str:
    """A time in ticks as people read it."""
    return f"{tick / 2**20:g} s"


def conserved(_log: EventLog, _plan: Plan, stays: Stays) -> Iterator[str]:
    """Every job is created once and leaves at most once, and who has not left is inside at the horizon."""
    for numbers, what in ((stays.number, "created"), (stays.left_number, "gone")):
        values, counts = np.unique(numbers, return_counts=True)
        if np.any(counts > 1):
            yield f"job {values[counts > 1][0]} is {what} more than once"
    unknown = np.setdiff1d(stays.left_number, stays.number)
    if unknown.size:
        yield f"job {unknown[0]} leaves but was never created"
    rows = stays.rows
    strangers = np.setdiff1d(rows["job"], stays.number)
    if strangers.size:
        yield f"job {strangers[0]} is worked on but was never created"
    inside_until_horizon = rows["job"][ticks(rows["end_s"]) == stays.horizon]
    staying = stays.number[(stays.leave == stays.horizon) & (stays.enter < stays.horizon)]
    missing = np.setdiff1d(np.setdiff1d(staying, stays.left_number), inside_until_horizon)
    if missing.size:
        yield f"job {missing[0]} has not left and is not inside at the horizon"


def tiled(_log: EventLog, _plan: Plan, stays: Stays) -> Iterator[str]:
    """A job's rows follow each other from its creation until it leaves."""
    yield from untiled(stays.rows, stays.rows["job"], stays.number, stays.enter, stays.leave, "job")


def integral(_log: EventLog, plan: Plan, stays: Stays) -> Iterator[str]:
    """Jobs' rows, clipped to the window, sum to what stands between creations and leavings."""
    low, high = (int(ticks(edge)) for edge in plan.window_s)

    def clipped(times: np.ndarray) -> int:
        return np.clip(times, low, high).sum()

    spent = clipped(ticks(stays.rows["end_s"])) - clipped(ticks(stays.rows["start_s"]))
    inside = clipped(stays.leave) - clipped(stays.enter)
    if spent != inside:
        yield f"jobs' rows sum to {words(spent)} in the window, jobs inside integrate to {words(inside)}"


def places(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """Nobody is nowhere, and nobody moves but by walking."""
    yield from unaccounted(log, plan)


def one_state(log: EventLog, plan: Plan, stays: Stays) -> Iterator[str]:
    """A worker's rows follow each other from the start to the horizon."""
    rows = log.where(np.isin(log["kind"], WORKER_KINDS) & (log["worker"] >= 0))
    everyone = np.arange(len(plan.workers))
    until = np.full_like(everyone, stays.horizon)
    yield from untiled(rows, rows["worker"], everyone, np.zeros_like(everyone), until, "worker")


RESTART = "restart"


def progress(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """A piece begins where the one before it ended, of the same task; anew only where a rule lets it begin anew.

    Who leaves the floor has nothing left to do, and the pieces of one performance all go at one pace.
    """
    out_of_bounds = list(_in_bounds(log))
    yield from out_of_bounds
    pieces = job_pieces(log)
    if pieces.row.size and not out_of_bounds:
        yield from _one_after_another(log, plan, pieces)
        yield from _nothing_left(log, plan, pieces)
        yield from _one_pace(log, pieces)


def _in_bounds(log: EventLog) -> Iterator[str]:
    """Progress goes forward, from nothing to at most the whole; in the parts of a team's members too."""
    rows = np.flatnonzero((log["kind"] == WORK) & (log["task"] >= 0))
    begun, done = log["progress_from"][rows], log["progress_to"][rows]
    for at in np.flatnonzero(~((begun >= 0) & (begun < done) & (done <= 1)))[:1]:
        yield f"{_named(log, rows[at])}: a piece goes from {begun[at]:.9g} to {done[at]:.9g} of it"


def _one_after_another(log: EventLog, plan: Plan, pieces: JobPieces) -> Iterator[str]:
    """Set-ups may begin anew whenever a server was set up for something else meanwhile."""
    begun, done, task, station, kind = (
        log[name][pieces.row] for name in ("progress_from", "progress_to", "task", "station", "kind")
    )
    expected = np.where(pieces.left, done[pieces.before], 0.0)
    same = (task == task[pieces.before]) & (station == station[pieces.before])
    anew = pieces.left & (begun == 0.0)
    wrong = np.where(pieces.left & ~same, begun != 0.0, begun != expected) & ~(anew & (kind != WORK))
    for at in np.flatnonzero(wrong | (anew & (kind == WORK))):
        row, ahead = pieces.row[at], pieces.row[pieces.before[at]]
        may_begin = _may_restart if same[at] or _is_shared(log, plan, ahead) else _may_be_dropped
        if not (anew[at] and may_begin(log, plan, ahead)):
            yield f"{_named(log, row)}: a piece begins at {begun[at]:.9g} of it, where {expected[at]:.9g} was done"


def _may_restart(log: EventLog, plan: Plan, row: int) -> bool:
    """Whether the work of a row may have been lost."""
    station, worker, task = (int(log[name][row]) for name in ("station", "worker", "task"))
    of_station = [queue.preempt for queue in plan.queues if queue.station == station]
    of_station += [stop.job for stop in plan.breakdowns if stop.station == station]
    people = plan.workers if worker < 0 else plan.workers[worker : worker + 1]
    shifts = [plan.shifts[duty.shift] for person in people for duty in person.duties or ()]
    of_people = [rule for shift in shifts for rule in (shift.at_break, shift.at_end)]
    return RESTART in (*of_station, *of_people, plan.tasks[task].interruption)


def _may_be_dropped(log: EventLog, plan: Plan, row: int) -> bool:
    """Whether the job may have gone on before the work of a row was done: on a paced line."""
    return any(int(log["station"][row]) in line.stations for line in plan.lines)


def _is_shared(log: EventLog, plan: Plan, row: int) -> bool:
    """Whether what was lost of a row's task may be begun anew at the next station."""
    return any(share.station == log["station"][row] and log["task"][row] in share.tasks for share in plan.shares)


def _nothing_left(log: EventLog, plan: Plan, pieces: JobPieces) -> Iterator[str]:
    """The last work of a job that leaves the floor as done is done."""
    job = log["job"][pieces.row]
    work = log["kind"][pieces.row] == WORK
    last = np.flatnonzero(work & np.r_[(job[1:] != job[:-1]) | ~work[1:], True])
    last = last[log["progress_to"][pieces.row[last]] < 1.0]
    halfway = [job[at] for at in last if not _may_be_dropped(log, plan, pieces.row[at])]
    done = np.flatnonzero(np.isin(log["kind"], (FINISH, JOIN, SPLIT)))
    for row in done[np.isin(log["job"][done], halfway)][:1]:
        yield f"job {log['job'][row]}: leaves at {log['end_s'][row]:g} s with a task that is not done"


def _one_pace(log: EventLog, pieces: JobPieces) -> Iterator[str]:
    """The seconds of each piece are its share of the whole performance's, to the tick at either end."""
    rows = pieces.row[log["k"][pieces.row] >= 0]
    _, which = np.unique(log["performance_id"][rows], return_inverse=True)
    share = log["progress_to"][rows] - log["progress_from"][rows]
    seconds = log.duration_s[rows]
    whole_s = np.bincount(which, seconds) / np.bincount(which, share)
    off_s = np.abs(seconds - share * whole_s[which])
    for at in np.flatnonzero(off_s > 2 * STEP_S + 1e-9 * whole_s[which])[:1]:
        yield f"{_named(log, rows[at])}: {share[at]:.9g} of it took {seconds[at]:g} s of {whole_s[which[at]]:g} s"


def _named(log: EventLog, row: int) -> str:
    task, job, start_s = (log[name][row] for name in ("task", "job", "start_s"))
    of = f"job {job}, " if job >= 0 else ""
    return f"{of}{log.names['task'][task]} at {start_s:g} s"
