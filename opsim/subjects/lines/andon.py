"""Andon: somebody is called to a job of a paced line that is not done in time; he takes over, or helps, or it goes on.

Who helps takes his own share of what is left, and both are done at once. When a job leaves a station unfinished,
whoever is at it is free, and nothing more is done there.
"""

from __future__ import annotations

from typing import Any

from opsim.engine import rules
from opsim.engine.floor.event_list import on_grid, stretch
from opsim.engine.floor.floor_state import LINES, Floor
from opsim.engine.floor.keys import is_better, keep_best, pair_key
from opsim.engine.floor.log_rows import job_now, log_instant, log_job, progress
from opsim.engine.floor.machine import NOTHING, Handle, drop, fresh, inlined, step, struct
from opsim.engine.floor.state import Job, Station, Worker
from opsim.log import AWAY, CLOSED, HELD, IS_DOWN, NO_WORKER, QUEUE, SENT_ON, SETUP, UNFINISHED, WALK, WORK
from opsim.subjects.lines.paced_lines import Andon, is_open
from opsim.subjects.lines.plan import LinePlan
from opsim.subjects.people.allocation import send
from opsim.subjects.people.teams import Stint, disband
from opsim.subjects.people.worker import may_serve, set_free, stop, task_of, works
from opsim.subjects.routes.routing import claim_at, give_up_claims, put_claim, take_claim
from opsim.subjects.shifts.interruption import forget_progress, interrupt, release_team, take_over, tell_broken_off
from opsim.subjects.stations.station import call_off, drawn_s, go_on

OUTERMOST = -100
"""Among what follows when a stretch is over: who helps is free before anything else."""
_together_s = inlined(rules.together_s)
_new_stint = fresh(Stint)


@step
def begin_helping(floor: Floor, job: Job, worker: Worker) -> None:
    """From now on two are at the task, whose rest goes by the sum of their paces."""
    station, now = job.station, floor.now
    done = progress(job, now)
    alone_s = job.since_s + job.duration_s - now
    his_s = drawn_s(floor, station, worker, job.task)
    k = floor.asked_k
    rest_s = on_grid(_together_s(alone_s, his_s * (1.0 - done)))
    job.block.helped, job.block.slower = 1, alone_s / rest_s
    _go_on_at_another_pace(floor, job, done, rest_s)
    stint: Stint = _new_stint(floor)
    stint.station, stint.product, stint.operation, stint.task = station.rank, job.product, job.operation, job.task
    stint.performance_id, stint.k, stint.duration_s = _another(floor), k, rest_s
    stint.progress_from, stint.pace_shift = done, worker.pace_shift
    worker.stint = stint
    works(floor, worker, job.task, now + rest_s, done, k)
    worker.job, worker.station = job, station
    worker.kind, worker.since_s = WORK, now
    job.has_team = 1
    job.team.clear()
    job.team.append(worker)


@step
def end(floor: Floor, job: Job) -> None:
    """Who helps has to go, and the other one goes on alone."""
    rest_s = (job.since_s + job.duration_s - floor.now) * job.block.slower
    job.block.helped = 0
    _go_on_at_another_pace(floor, job, progress(job, floor.now), on_grid(rest_s))
    release_team(floor, job)


@step
def help_broken_off(floor: Floor, subject: Any, job: Job) -> None:
    """Who goes on alone needs longer for the rest."""
    if job.block.helped:
        job.block.helped = 0
        if job.rest_s:
            job.rest_s = on_grid(job.rest_s * job.block.slower)
            job.performance_id = _another(floor)


@step
def help_over(floor: Floor, subject: Any, job: Job, worker: Worker) -> bool:
    """Who helps is free when the task is done; what else follows is asked too."""
    if job.block.helped:
        job.block.helped = 0
        release_team(floor, job)
    return False


@inlined
def _go_on_at_another_pace(floor: Floor, job: Job, done: float, rest_s: float) -> None:
    """Who works at the job goes on, and needs another time for the rest: a piece of its own begins."""
    worker = floor.workers[job.worker]
    log_job(floor, job)
    job.since_s, job.progress_from, job.rest_s, job.duration_s = floor.now, done, rest_s, rest_s
    job.performance_id = _another(floor)
    stop(floor, worker)
    worker.since_s = floor.now
    works(floor, worker, job.task, floor.now + rest_s, done, job.k)
    stretch(floor, worker, floor.stretch_line, rest_s)


@inlined
def _another(floor: Floor) -> int:
    """The number of a performance, or of a part of one that goes at a pace of its own."""
    number = floor.n_performances
    floor.n_performances = number + 1
    return number


@step
def can_help(floor: Floor, job: Job) -> bool:
    """Whether somebody works at a task that two can share: one without a tool in the hands or a time of the station."""
    if job.kind != WORK or job.worker < 0:
        return False
    task = floor.tasks[job.task]
    return task.hold_tool < 0 and not task.attended


def hang_helping(build: Any, ranks: tuple[int, ...]) -> None:
    """Help can be had at some stations."""
    if not build.floor.helping:
        build.floor.helping = build.arena.new("Helping")
        build.hang(build.floor.broken_off, help_broken_off)
    for rank in ranks:
        build.hang(build.stations[rank].acteds, help_over, None, OUTERMOST)


@step
def send_on(floor: Floor, job: Job) -> bool:
    """The job's operation is over as it is, and the job is bad; False where its station stands, and so does the line.

    What waits for parts, tools or a worker goes on without them.
    """
    station = job.station
    if job.kind == HELD and (job.cause == IS_DOWN or job.cause == CLOSED):
        return False
    if job.kind == WORK or job.kind == SETUP:
        interrupt(floor, job, UNFINISHED)
    elif job.kind == QUEUE:
        drop(station.queue, job)
    else:
        _wait_no_more(floor, job)
    tell_lost_server(floor, job)
    forget_progress(floor, job)
    job.setup_task, job.bad = -1, 1
    log_instant(floor, SENT_ON, job, UNFINISHED, station.rank, -1)
    floor.operation_line(floor, job)
    return True


@step
def tell_lost_server(floor: Floor, job: Job) -> None:
    """Whoever has to know that a job loses what it had at its server."""
    for told in floor.lost_server:
        told.line(floor, told.subject, job, job.station)


@step
def turn_away(floor: Floor, job: Job, but: int) -> None:
    """Whoever is on his way to the job comes all the same, and is free there; who waits at it is free now."""
    for rank in range(floor.n_workers):
        worker = floor.workers[rank]
        if worker.job is job and rank != but:
            if worker.kind == WALK:
                worker.job = NOTHING
                worker.station = NOTHING
            else:
                set_free(floor, worker)


@inlined
def _wait_no_more(floor: Floor, job: Job) -> None:
    call_off(floor, job.station, job)
    for hook in floor.call_off:
        _ = hook.line(floor, hook.subject, job)
    if job.has_team:
        disband(floor, job)
    turn_away(floor, job, -1)
    tell_broken_off(floor, job)
    job_now(floor, job, HELD, UNFINISHED)


ORDER = 5
"""Among the ways to begin a task: the first, since who comes to a job that somebody is at begins none."""


@step
def call_for(floor: Floor, andon: Andon, job: Job) -> None:
    """Somebody is wanted at a job."""
    put_claim(floor, andon.waiting, job, floor.now)


@step
def nobody_wanted(floor: Floor, andon: Andon, job: Job) -> None:
    """The job is done, or sent on: nobody is wanted, and who is on his way comes all the same."""
    give_up_claims(floor, andon.waiting, job)
    for number in range(andon.n_floaters):
        worker = andon.floaters[number]
        if andon.coming[number] is job:
            _comes_no_more(andon, number)
            if worker.job is job:
                worker.job = NOTHING
                worker.station = NOTHING


@inlined
def _comes_no_more(andon: Andon, number: int) -> None:
    andon.coming[number] = NOTHING
    andon.floaters[number].called_by = NOTHING


@step
def send_called(floor: Floor, andon: Andon) -> bool:
    """Send who is free to the jobs that have waited longest; True where somebody goes."""
    andon.asked.clear()
    for claim in andon.waiting:
        andon.asked.append(claim.job)
    sent = False
    for one in andon.asked:
        if _send_to(floor, andon, one):
            sent = True
    return sent


@step
def _send_to(floor: Floor, andon: Andon, job: Job) -> bool:
    if claim_at(andon.waiting, job) < 0:
        return False
    if not is_open(andon.line, job):
        take_claim(floor, andon.waiting, claim_at(andon.waiting, job))
        return False
    number = _best(floor, andon, job)
    if number < 0:
        return False
    if _others_first(floor, andon, job):
        return True
    if not _can_be_taken(floor, job):
        return False
    take_claim(floor, andon.waiting, claim_at(andon.waiting, job))
    worker = andon.floaters[number]
    andon.coming[number], worker.called_by = job, andon
    send(floor, worker, job.station, job)
    return True


@step
def _best(floor: Floor, andon: Andon, job: Job) -> int:
    """The number of the best of those who are free and may go, by the rule of allocation; -1: nobody is."""
    best = -1
    for number in range(andon.n_floaters):
        worker = andon.floaters[number]
        if worker.in_free and _may(floor, worker, job.station):
            pair_key(floor, worker, job.station, job, 1, job.since_s)
            if best < 0 or is_better(floor):
                best = number
                keep_best(floor)
    return best


@step
def _others_first(floor: Floor, andon: Andon, job: Job) -> bool:
    """Whether whoever works here all the time is free for the job, and may be sent in this instant."""
    if andon.left_s == floor.now or claim_at(job.station.calling, job) < 0:
        return False
    for worker in floor.free:
        if may_serve(worker, job.station):
            andon.left_s = floor.now
            return True
    return False


@step
def act(floor: Floor, andon: Andon, job: Job, worker: Worker) -> bool:
    """Somebody who was called is there, or at the beginning of the stretch: he does what he was called for."""
    number = _number_of(andon, worker)
    if number < 0 or andon.coming[number] is not job:
        return False
    line = andon.line
    if line.act_line and line.act_line(floor, line, job, worker):
        return True
    _comes_no_more(andon, number)
    worker.since_s = floor.now
    if not (_may(floor, worker, job.station) and _can_be_taken(floor, job)):
        set_free(floor, worker)
        call_for(floor, andon, job)
    elif line.helps and can_help(floor, job):
        begin_helping(floor, job, worker)
        call_for(floor, andon, job)  # for the tasks that follow
    else:
        _take(floor, andon, job, worker)
    return True


@inlined
def _number_of(andon: Andon, worker: Worker) -> int:
    if worker.called_by:
        for number in range(andon.n_floaters):
            if andon.floaters[number] is worker:
                return number
    return -1


@step
def turns_back(floor: Floor, andon: Andon, worker: Worker, job: Job) -> None:
    """Somebody on his way, who was called, has to go: the job calls for others, where nobody is at it or comes."""
    _comes_no_more(andon, _number_of(andon, worker))
    worker.job = NOTHING
    call_for(floor, andon, job)
    if job.kind != HELD or job.cause != NO_WORKER or claim_at(job.station.calling, job) >= 0:
        return
    for rank in range(floor.n_workers):
        if floor.workers[rank].job is job:
            return
    go_on(floor, job)


@inlined
def _take(floor: Floor, andon: Andon, job: Job, worker: Worker) -> None:
    if job.kind == HELD:
        if andon.line.stop_walks_line:
            andon.line.stop_walks_line(floor, andon.line, job, worker.rank)
        turn_away(floor, job, worker.rank)
        if job.cause == AWAY:
            tell_lost_server(floor, job)
    take_over(floor, job, worker)


@inlined
def _may(floor: Floor, worker: Worker, station: Station) -> bool:
    """Whether somebody who is called may go to a station: he has the skill, and no other block keeps him."""
    if worker.rating[station.rank] <= 0:
        return False
    for limit in range(floor.n_limits):
        if limit != LINES and worker.limited[limit]:
            at = limit * floor.n_words + (station.rank >> 6)
            if not (worker.limits[at] >> (station.rank & 63)) & 1:
                return False
    return True


@inlined
def _can_be_taken(floor: Floor, job: Job) -> bool:
    """Whether one worker alone is at the job and is not being helped, or nobody is and somebody is wanted."""
    if job.has_team:
        return False
    if job.kind == WORK or job.kind == SETUP:  # else who is at it is done in this very instant
        return job.worker >= 0 and job.since_s + job.duration_s > floor.now
    if job.station.down or job.kind != HELD or (job.cause != NO_WORKER and job.cause != AWAY):
        return False
    return floor.tasks[task_of(job)].team == 1


def hang_andon(build: Any, plan: LinePlan, line: Handle) -> Handle:
    """Call somebody to the jobs of a line; he is sent nowhere else on it."""
    andon, floaters = build.arena.new("Andon"), [build.workers[rank] for rank in plan.floaters]
    andon.line, andon.left_s = line, -1.0
    andon.n_floaters, andon.floaters = len(floaters), build.arena.array("Worker", floaters)
    andon.coming = build.ints([0] * len(floaters))
    if plan.helps:
        hang_helping(build, plan.stations)
    for rank in plan.stations:
        build.hang(build.stations[rank].acts, act, andon, ORDER)
    for worker in floaters:
        build.restrict(worker, LINES, _left_to(build, worker) - set(plan.stations))
    build.hang(build.floor.dispatchers, send_called, andon)
    return andon


def _left_to(build: Any, worker: Handle) -> set[int]:
    """The stations that other lines leave him, by their ranks."""
    everywhere = set(range(len(build.stations)))
    if not worker.limited[LINES]:
        return everywhere
    words = worker.limits
    at = LINES * build.floor.n_words
    return {rank for rank in everywhere if words[at + (rank >> 6)] >> (rank & 63) & 1}


@struct
class Helping:
    """Of a floor where somebody may help; what is known of each job that is helped with stands in its block."""

    there: int
