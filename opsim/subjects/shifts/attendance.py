"""Who has to go, who is back, who stays on, and what becomes of the work of who goes: seen to in every instant."""

from __future__ import annotations

from typing import Any

from opsim.engine import rules
from opsim.engine.floor.floor_state import CREWS, DUTY, Floor
from opsim.engine.floor.log_rows import job_now, progress
from opsim.engine.floor.machine import NOTHING, cast, drop, inlined, step
from opsim.engine.floor.state import Event, Job, Station, Worker
from opsim.engine.rules import FINISH_JOB, HAND_OVER, RESUME, RESUME_ANY, stays_on
from opsim.log import ABSENT, AWAY, BREAK, HELD, NO_TOOL, NO_WORKER, OFF, REST, SETUP, TRANSPORT, WAIT, WALK, WORK
from opsim.subjects.people.worker import leave_all, leave_none, set_free, take_off, task_of
from opsim.subjects.shifts.hand_over import (
    ask,
    be_wanted_no_more,
    go_back,
    goes_off,
    meets_tied_job,
    put_down,
    release,
    send_carriers,
    send_takers,
    tie,
    turns_back,
)
from opsim.subjects.shifts.interruption import forget_progress, interrupt, tell_broken_off
from opsim.subjects.shifts.overtime import need
from opsim.subjects.shifts.shifts import (
    GONE,
    HERE,
    LEAVING,
    PAUSED,
    Pause,
    People,
    Presence,
    begin_pause,
    end_pause,
    rest,
)
from opsim.subjects.stations.station import go_on

_works_on, _is_kept_for_him = inlined(rules.works_on), inlined(rules.is_kept_for_him)
_is_lost = inlined(rules.is_lost)


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
        from opsim.subjects.people.teams import disband

        people.disband_line = build.line(disband)
    if any(line.floaters for line in plan.lines):
        from opsim.subjects.lines.andon import end
        from opsim.subjects.lines.andon import turns_back as called_back

        people.turns_back_line, people.help_over_line = build.line(called_back), build.line(end)


ORDER = 10
"""Among the ways to begin a task: before all others, since who has to go begins none."""
_stays_on = inlined(stays_on)
_as_presence, _as_pause = cast(Presence), cast(Pause)


@step
def act(floor: Floor, subject: Any, job: Job, worker: Worker) -> bool:
    """Somebody is about to begin a task: he waits to carry, or has to go and does not begin it."""
    if meets_tied_job(floor, job, worker):
        return True
    one = worker.presence
    if not one:
        return False
    if one.state != LEAVING or worker.staying is job:
        return False
    worker.since_s = floor.now  # what he did until now is written, or will be with the job
    set_free(floor, worker)
    go_on(floor, job)
    return True


@step
def look(floor: Floor, people: People) -> bool:
    """Whoever may go goes, who is back goes on, and who is to be relieved is; True where something changed."""
    changed = False
    if people.n_watched:
        changed = _look_at_all(floor, people)
    if people.n_asked and send_takers(floor):
        _look_at_all(floor, people)  # who was relieved at once goes, before the idle walk on or home
        changed = True
    if people.left and send_carriers(floor):
        changed = True
    return changed


@step
def be_here(floor: Floor, one: Presence) -> None:
    """He need not go any more, and can be sent; but where a job waits for him, nowhere else."""
    worker = one.worker
    one.state, one.goes, worker.going = HERE, 0, 0
    worker.staying = NOTHING
    be_wanted_no_more(floor, worker)
    if worker.tied:
        leave_none(floor, worker, DUTY)
    else:
        leave_all(floor, worker, DUTY)
    _watch(floor, one)


@inlined
def _watch(floor: Floor, one: Presence) -> None:
    """He is looked at as soon as he is free."""
    if not one.watched:
        one.watched = 1
        floor.people.n_watched += 1


@inlined
def _watch_no_more(floor: Floor, one: Presence) -> None:
    if one.watched:
        one.watched = 0
        floor.people.n_watched -= 1


@step
def leave(floor: Floor, one: Presence, goes: bool) -> None:
    """He has to go: now where he may, else as soon as he may."""
    worker, duty = one.worker, one.duty
    one.state, one.goes, worker.going = LEAVING, goes, goes
    one.overtime = one.undecided = 0
    leave_none(floor, worker, DUTY)
    _watch(floor, one)
    job = worker.job
    stays = leave_job(floor, worker, duty.at_end if goes else duty.at_break)
    worker.staying = NOTHING
    if stays:
        worker.staying = job
    if worker.in_free:
        _go(floor, one)


@step
def pause_over(floor: Floor, event: Event) -> None:
    """He comes back, or has the next pause that he is owed."""
    one: Presence = _as_presence(event.subject)
    if one.pause is not _as_pause(event.other):
        return
    end_pause(floor, one)
    if one.owed:
        one.state = LEAVING
        _watch(floor, one)
    else:
        be_here(floor, one)


@step
def _look_at_all(floor: Floor, people: People) -> bool:
    changed = False
    for i in range(people.n):
        if people.those[i].watched and _look_at(floor, people.those[i]):
            changed = True
    return changed


@step
def _look_at(floor: Floor, one: Presence) -> bool:
    """True where something became of him."""
    worker = one.worker
    if one.undecided:
        return _decide(floor, one)
    if one.state == LEAVING:
        stand_by(floor, worker)
    if not worker.in_free:
        return one.overtime == 1 and _rests_for_nobody(floor, one) == 1
    if one.state == LEAVING:
        _go(floor, one)
    elif one.state == PAUSED:
        _watch_no_more(floor, one)
        rest(floor, one)
    else:
        return _set_to_work(floor, one)
    return True


@step
def _set_to_work(floor: Floor, one: Presence) -> bool:
    """He is free, and there: back to the job that waits for him, or to whatever comes; False where he stays on."""
    worker = one.worker
    if not one.overtime:
        _watch_no_more(floor, one)
    leave_all(floor, worker, DUTY)
    if go_back(floor, worker) or not one.overtime:
        return True
    if floor.stirred or need(floor, one):
        return False
    leave(floor, one, True)
    return True


@step
def _rests_for_nobody(floor: Floor, one: Presence) -> bool:
    """Who rests by need in overtime goes home instead, where nobody needs him; True where he does."""
    worker = one.worker
    if worker.kind != BREAK or worker.cause != REST or floor.stirred or need(floor, one):
        return False
    leave(floor, one, True)
    return True


@step
def _decide(floor: Floor, one: Presence) -> bool:
    """At the end of his shift: he stays, or has to go; which is seen when all jobs are in that come in now."""
    if floor.stirred:
        return False
    one.undecided = 0
    if _stays_on(need(floor, one) == 1, one.duty.overtime_s):
        be_here(floor, one)
    else:
        leave(floor, one, True)
    return True


@step
def left(floor: Floor, people: People, job: Job, station: Station) -> None:
    """Who stayed for a job's tasks at a station is done there as the job leaves it."""
    if not people.n_watched:
        return
    for i in range(people.n):
        worker = people.those[i].worker
        if people.those[i].watched and worker.staying is job:
            worker.staying = NOTHING


@step
def _go(floor: Floor, one: Presence) -> None:
    """He is free, and goes: off, or to the pause that he is owed."""
    worker = one.worker
    be_wanted_no_more(floor, worker)
    worker.staying = NOTHING
    if one.goes:
        one.state, one.goes, worker.going = GONE, 0, 0
        one.duty = NOTHING
        take_off(floor, worker, ABSENT if one.misses else OFF, 0)
        goes_off(floor, worker)
        if one.misses:
            release(floor, worker)
    else:
        one.state = PAUSED
        begin_pause(floor, one)
    if worker.kind != WALK:
        _watch_no_more(floor, one)


def hang_attendance(build: Any, people: Any) -> None:
    """Whoever has shifts is looked at in every round of an instant."""
    people.pause_over_line = build.line(pause_over)
    build.hang(build.floor.dispatchers, look, people)
    build.hang(build.floor.left_station, left, people)
    for station in build.stations:
        build.hang(station.acts, act, people, ORDER)
