"""The law of progress: the pieces of a performance follow one another, and add up to one."""

from collections.abc import Iterator

import numpy as np

from opsim.clock import STEP_S
from opsim.laws.stays import Stays
from opsim.log import FINISH, JOIN, SPLIT, WORK, EventLog
from opsim.pieces import JobPieces, job_pieces
from opsim.plan import Plan

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
