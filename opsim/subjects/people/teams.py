"""Teams: nobody is sent to a task of several workers before as many are free; the slowest of them ends it."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.event_list import on_grid, stretch
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.keys import is_better, keep_best, pair_key
from opsim.engine.floor.log_rows import job_now, log_worker
from opsim.engine.floor.machine import NOTHING, Array, List, drop, fresh, give_back, index_of, inlined, step, struct
from opsim.engine.floor.state import Claim, Job, Station, Worker
from opsim.log import HELD, NO_WORKER, TEAM, WALK, WORK
from opsim.subjects.people.worker import (
    be_busy,
    begin,
    drawn_run_s,
    ended,
    may_serve,
    set_free,
    task_done,
    units,
    wait_by,
    works,
)
from opsim.subjects.routes.routing import give_up_claims, put_claim, take_claim
from opsim.subjects.stations.station import drawn_s, go_and_perform, stand_still
from opsim.subjects.tools.tool_grips import Want, grip_at, is_free
from opsim.subjects.tools.tool_store import break_off, grip


@struct
class Teams:
    """gathering : claims; turn, able, team : those that are gone through just now

    seconds, ks, shifts : of each in a team, how long his part takes, its number, and the shift of his log time
    """

    gathering: List[Claim]
    turn: List[Claim]
    able: List[Worker]
    team: List[Worker]
    seconds: Array[float]
    ks: Array[int]
    shifts: Array[float]


@struct
class Stint:
    """What of it goes into the row of the member."""

    station: int
    product: int
    operation: int
    task: int
    performance_id: int
    k: int
    duration_s: float
    progress_from: float
    pace_shift: float


@step
def choose(floor: Floor, job: Job, station: Station) -> bool:
    """The free workers who go, by the rule of allocation, in natural order: ``teams.team``. False: they are too few.

    Who stays until the job's tasks here are done comes first.
    """
    able, team = floor.teams.able, floor.teams.team
    able.clear()
    team.clear()
    for worker in floor.free:
        if _may_work(worker, job, station):
            able.append(worker)
    n = floor.tasks[station.tasks[job.task_position]].team
    if len(able) < n:
        return False
    while len(team) < n:
        best = _best_of(floor, job, station)
        drop(able, best)
        _insort(floor, team, best)
    return True


@step
def _best_of(floor: Floor, job: Job, station: Station) -> Worker:
    """Of those who can go, who comes first."""
    able, best = floor.teams.able, floor.no_worker
    for worker in able:
        stays = worker.staying is job
        if best and stays != (best.staying is job) and not stays:
            continue
        pair_key(floor, worker, station, job, 1 + len(station.queue), job.since_s)
        better = True
        if best:
            better = stays != (best.staying is job) or is_better(floor)
        if better:
            best = worker
            keep_best(floor)
    return best


@inlined
def _insort(floor: Floor, team: List[Worker], worker: Worker) -> None:
    """Put somebody into a team at his place in natural order."""
    at = len(team)
    while at > 0 and worker.rank < team[at - 1].rank:
        at -= 1
    team.insert(at, worker)


@step
def disband(floor: Floor, job: Job) -> None:
    """Who has come is free; who is on his way comes, and is free there."""
    if not job.has_team:
        return
    job.has_team = 0
    for worker in job.team:
        if worker.kind == WALK:
            worker.job = NOTHING
            worker.station = NOTHING
        else:
            set_free(floor, worker)
    job.team.clear()


@step
def comes_again(floor: Floor, job: Job) -> bool:
    """Whether the performance that ends now is followed by another one of the same task."""
    return job.repeats_done + 1 < job.station.repeats[job.task_position] * units(job)


@step
def all_may_stay(floor: Floor, job: Job) -> bool:
    """Whether the whole team is there, and each of them may still be sent to where it works, or stays for the job."""
    if len(job.team) != floor.tasks[job.station.tasks[job.task_position]].team:
        return False
    for worker in job.team:
        if not _may_work(worker, job, job.station):
            return False
    return True


@inlined
def _may_work(worker: Worker, job: Job, station: Station) -> bool:
    """Whether somebody may be sent to a station, or is about to go and does the job's tasks there first."""
    return may_serve(worker, station) or worker.staying is job


_new_want, _forget_want = fresh(Want), give_back(Want)
_new_stint, _forget_stint = fresh(Stint), give_back(Stint)


def install(build: Any) -> None:
    """The jobs of a floor that are done by several workers at once."""
    build.keep_jobs()
    floor, n_workers = build.floor, len(build.plan.workers)
    made = floor.teams = build.arena.new("Teams")
    made.seconds, made.shifts = build.floats([0.0] * n_workers), build.floats([0.0] * n_workers)
    made.ks = build.ints([0] * n_workers)
    build.hang(floor.dispatchers, gather)
    build.hang(floor.call_off, call_off_team)


@step
def call_team(floor: Floor, job: Job) -> None:
    """The job waits until as many workers are free as its task takes."""
    job_now(floor, job, HELD, NO_WORKER)
    put_claim(floor, floor.teams.gathering, job, floor.now)


@step
def call_off_team(floor: Floor, subject: Any, job: Job) -> bool:
    """The job, which may not begin yet, calls for a team no more; True where it did."""
    return give_up_claims(floor, floor.teams.gathering, job) and _calls(job)


@inlined
def _calls(job: Job) -> bool:
    """Whether a job waits for the workers of a task; who lost his server may wait to be set up for instead."""
    return job.kind == HELD and job.cause == NO_WORKER and job.setup_task < 0


@step
def gather(floor: Floor, subject: Any) -> bool:
    """Send whole teams, to the jobs that have waited longest. True where one was sent."""
    teams, sent = floor.teams, False
    if len(floor.free) < 2 or not teams.gathering:
        return False
    _put_in_turn(floor)
    for claim in teams.turn:
        job, station = claim.job, claim.job.station
        if not _calls(job) or station.rank < 0 or not job.on_floor:
            _take(floor, claim)  # its server was taken, or it is gone
        elif not station.down and _find_team(floor, job, station):
            _take(floor, claim)
            _send(floor, job, station)
            sent = True
    return sent


@inlined
def _take(floor: Floor, claim: Claim) -> None:
    """The claim is met, or means nothing any more."""
    take_claim(floor, floor.teams.gathering, index_of(floor.teams.gathering, claim))


@step
def _put_in_turn(floor: Floor) -> None:
    """Jobs that wait for a team; first those for which somebody stays who is to go."""
    gathering, turn = floor.teams.gathering, floor.teams.turn
    turn.clear()
    for one in gathering:
        if _is_stayed_for(floor, one.job):
            turn.append(one)
    for other in gathering:
        if not _is_stayed_for(floor, other.job):
            turn.append(other)


@inlined
def _is_stayed_for(floor: Floor, job: Job) -> bool:
    """Whether somebody who is free stays until the job's tasks here are done."""
    for worker in floor.free:
        if worker.staying is job:
            return True
    return False


@inlined
def _find_team(floor: Floor, job: Job, station: Station) -> bool:
    """Who goes; False where too few are free, or the tools are not there."""
    task = floor.tasks[station.tasks[job.task_position]]
    if floor.crib and not is_free(floor.crib, task.n_needs, task.needs):
        return False
    return choose(floor, job, station)


@step
def _send(floor: Floor, job: Job, station: Station) -> None:
    """The team that was chosen goes to the job."""
    team = floor.teams.team
    _take_tools(floor, job, station)
    job_now(floor, job, HELD, TEAM)
    job.has_team, job.block.coming, job.block.working = 1, len(team), 0
    job.team.clear()
    for worker in team:
        job.team.append(worker)
        log_worker(floor, worker)
        worker.since_s = floor.now
        be_busy(floor, worker)
        worker.job, worker.station = job, station
    for worker in team:
        go_and_perform(floor, worker, job)


@step
def _take_tools(floor: Floor, job: Job, station: Station) -> None:
    """The tools of the task are the job's, where it needs some and has not got them."""
    position = job.task_position
    task = floor.tasks[station.tasks[position]]
    if not floor.crib or not task.n_needs or grip_at(job, position) >= 0:
        return
    want: Want = _new_want(floor)
    want.purpose, want.n_needs, want.needs, want.task = position, task.n_needs, task.needs, task.rank
    grip(floor, job, want)
    _forget_want(floor, want)


@step
def come_to_team(floor: Floor, job: Job, worker: Worker) -> bool:
    """Somebody has come: the last one begins with the others, who waited for him."""
    station = job.station
    if not job.has_team or worker not in job.team:  # the team was given up while he was on his way
        set_free(floor, worker)
        return True
    worker.since_s = floor.now
    wait_by(floor, worker, TEAM)
    job.block.coming -= 1
    if station.down:
        disband(floor, job)
        if floor.crib:
            break_off(floor, floor.subject, job)
        stand_still(floor, station, job)
    elif not job.block.coming:
        _begin(floor, job)
    return True


@step
def done_in_team(floor: Floor, job: Job, worker: Worker) -> bool:
    """Somebody is done with his part; False where he is the last, and the task goes no further with this team."""
    if not worker.stint:
        return False
    log_worker(floor, worker)
    _forget_stint(floor, worker.stint)
    worker.stint = NOTHING
    job.block.working -= 1
    if job.block.working:
        wait_by(floor, worker, TEAM)
        return True
    if comes_again(floor, job) and not job.station.down and all_may_stay(floor, job):
        ended(floor, job)
        task_done(job)
        _begin(floor, job)
        return True
    job.has_team = 0
    for member in job.team:
        if member is not worker:
            set_free(floor, member)
    job.team.clear()
    return False


@step
def _begin(floor: Floor, job: Job) -> None:
    """All begin now, each with his own next time, or all with the station's."""
    task = job.station.tasks[job.task_position]
    start = job.progress_from if job.rest_s else 0.0
    begin(floor, job, -1, task, -1, _draw(floor, job, task))
    job.block.working = len(job.team)
    for i in range(len(job.team)):
        worker, part_s = job.team[i], floor.teams.seconds[i]
        log_worker(floor, worker)
        worker.stint = _stint(floor, job, task, i, start)
        works(floor, worker, task, floor.now + part_s, start, floor.teams.ks[i])
        floor.n_performances += 1
        worker.kind, worker.since_s = WORK, floor.now
        stretch(floor, worker, floor.stretch_line, part_s)


@step
def _draw(floor: Floor, job: Job, task: int) -> float:
    """The part of each is drawn; the seconds of the longest."""
    station, teams, longest_s = job.station, floor.teams, 0.0
    share = 1.0 - job.progress_from if job.rest_s else 1.0
    attended, whole_s, k = floor.tasks[task].attended == 1, 0.0, 0
    if attended:
        whole_s = drawn_run_s(floor, station, task)
        k = floor.asked_k
    for i in range(len(job.team)):
        worker = job.team[i]
        if not attended:
            whole_s = drawn_s(floor, station, worker, task)
            k = floor.asked_k
        part_s = on_grid(whole_s * share) if share < 1 else whole_s
        teams.seconds[i], teams.ks[i] = part_s, k
        teams.shifts[i] = 0.0 if attended else worker.pace_shift
        longest_s = max(longest_s, part_s)
    return longest_s


@inlined
def _stint(floor: Floor, job: Job, task: int, i: int, start: float) -> Stint:
    """The part of the team's i-th."""
    stint: Stint = _new_stint(floor)
    stint.station, stint.product, stint.operation, stint.task = job.station.rank, job.product, job.operation, task
    stint.performance_id, stint.k, stint.duration_s = floor.n_performances, floor.teams.ks[i], floor.teams.seconds[i]
    stint.progress_from, stint.pace_shift = start, floor.teams.shifts[i]
    return stint
