"""What becomes of what a worker is at when he has to go: by the rule of its task, or of his shift."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.interruption import forget_progress, interrupt, tell_broken_off
from opsim.engine.floor.machine import NOTHING, drop, inlined, step
from opsim.engine.floor.parts.performing import task_of
from opsim.engine.floor.parts.rows import job_now, progress
from opsim.engine.floor.parts.state import CREWS, Floor, Job, Worker
from opsim.engine.floor.relief import ask, turns_back
from opsim.engine.floor.station import go_on
from opsim.engine.floor.ties import put_down, tie
from opsim.engine.floor.worker import set_free
from opsim.engine.rules import duty
from opsim.engine.rules.duty import FINISH_JOB, HAND_OVER, RESUME, RESUME_ANY
from opsim.log import AWAY, HELD, NO_TOOL, NO_WORKER, SETUP, TRANSPORT, WAIT, WALK, WORK

_works_on, _is_kept_for_him = inlined(duty.works_on), inlined(duty.is_kept_for_him)
_is_lost = inlined(duty.is_lost)


@step
def leave_job(floor: Floor, worker: Worker, rule: int) -> bool:
    """His time has come. Who may go is free then; else he goes when he is. ``rule`` is that of his shift.

    True where he goes on with the job he is at, all tasks of it here, since the rule says so.
    """
    job = worker.job
    if worker.in_free or not job:
        return False
    if job.kind == TRANSPORT:
        return False
    if job.has_team and worker in job.team:
        return _leave_team(floor, worker, job, rule)
    if worker.kind == WALK:
        _turn_back(floor, worker, job)
    elif (job.worker == worker.rank and (job.kind == WORK or job.kind == SETUP)) or _waits_for_tool(worker, job):
        return _leave_work(floor, worker, job, rule)
    else:
        stand_by(floor, worker)
    return False


@step
def stand_by(floor: Floor, worker: Worker) -> None:
    """Who is to go and only stands by goes at once: by a blocked job, or by a team that is not done yet."""
    job = worker.job
    if not job:
        return
    if job.held_by is worker:
        put_down(floor, worker, job)
    elif _is_done_with(worker, job):
        drop(job.team, worker)
        set_free(floor, worker)


@step
def _turn_back(floor: Floor, worker: Worker, job: Job) -> None:
    """He walks on to where he was sent, and the job calls for anybody again, or waits on for him."""
    if turns_back(floor, worker):
        return
    if worker.called_by:
        floor.people.turns_back_line(floor, worker.called_by, worker, job)
        return
    if worker.tied is job:
        worker.job = NOTHING
        tell_broken_off(floor, job)
    elif job.kind == HELD and job.cause == NO_WORKER:
        worker.job = NOTHING
        tell_broken_off(floor, job)
        go_on(floor, job)


@step
def _leave_team(floor: Floor, worker: Worker, job: Job, rule: int) -> bool:
    """A team goes on together, or breaks off together: nobody is waited for.

    True where he goes on with the job, all tasks of it here that want a team.
    """
    which, alone = _rule_of(floor, job, rule), job.worker >= 0 and job.kind == WORK
    begun = job.kind == WORK and floor.now > job.since_s
    ahead = job.progress_from > 0 or job.task_position > 0 or job.repeats_done > 0
    if which == FINISH_JOB and job.kind == WORK and not alone and _works_on(which, begun, begun or ahead):
        return True
    if job.kind != WORK:
        floor.people.disband_line(floor, job)
        tell_broken_off(floor, job)
        go_on(floor, job)
    elif not worker.stint:
        stand_by(floor, worker)
    elif alone and not _works_on(which, begun, begun):  # he only helps: the other one goes on alone
        floor.people.help_over_line(floor, job)
    elif not _works_on(which, begun, begun):
        _stop(floor, worker, job, NO_WORKER)
        if _is_lost(which):
            forget_progress(floor, job)
        go_on(floor, job)
    return False


@step
def _leave_work(floor: Floor, worker: Worker, job: Job, rule: int) -> bool:
    """He stops, or goes on until he is done, or relieved; True where he does all tasks of the job here."""
    which = _rule_of(floor, job, rule)
    if which == RESUME and worker.limited[CREWS]:
        which = RESUME_ANY
    at_work = job.kind != HELD
    done = progress(job, floor.now) if at_work else job.progress_from
    begun = floor.now > job.since_s if at_work else done > 0
    all_begun = begun or done > 0 or job.task_position > 0 or job.repeats_done > 0
    if _works_on(which, begun, all_begun):
        if which == HAND_OVER:
            ask(floor, worker, job)
        return which == FINISH_JOB
    kept = _is_kept_for_him(which, done)
    _stop(floor, worker, job, AWAY if kept else NO_WORKER)
    if kept:
        tie(floor, worker, job)
        return False
    if _is_lost(which):
        forget_progress(floor, job)
    go_on(floor, job)
    return False


@inlined
def _waits_for_tool(worker: Worker, job: Job) -> bool:
    """Whether he is in the middle of a performance, or just before it, and stands by until a tool is there."""
    return worker.kind == WAIT and worker.cause == NO_TOOL and job.kind == HELD


@inlined
def _is_done_with(worker: Worker, job: Job) -> bool:
    """Whether he has done his part of what a team is at, and does not stay for its other tasks."""
    of_team = job.has_team == 1 and worker in job.team
    return of_team and job.kind == WORK and not worker.stint and worker.staying is not job


@inlined
def _rule_of(floor: Floor, job: Job, of_shift: int) -> int:
    """The rule of the task a job has come to, which goes before that of the shift."""
    of_task = floor.tasks[task_of(job)].rule
    return of_task if of_task >= 0 else of_shift


@step
def _stop(floor: Floor, worker: Worker, job: Job, cause: int) -> None:
    """The performance is broken off where it is, and its worker is free; also while he waits for a tool in it."""
    if job.kind != HELD:
        interrupt(floor, job, cause)
        return
    tell_broken_off(floor, job)
    set_free(floor, worker)
    job_now(floor, job, HELD, cause)


def set_lines(build: Any, people: Any) -> None:
    """What of other blocks those who leave may come to, where a plan has it."""
    plan = build.plan
    if any(task.team > 1 for task in plan.tasks):
        from opsim.engine.floor.members import disband

        people.disband_line = build.line(disband)
    if any(line.floaters for line in plan.lines):
        from opsim.engine.floor.andon import turns_back as called_back
        from opsim.engine.floor.helping import end

        people.turns_back_line, people.help_over_line = build.line(called_back), build.line(end)
