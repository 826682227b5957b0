"""What becomes of what a worker is at when he has to go: by the rule of its task, or of his shift."""

from opsim.engine.rules.duty import (
    FINISH_JOB,
    HAND_OVER,
    INTERRUPTION_RULES,
    RESUME,
    RESUME_ANY,
    is_kept_for_him,
    is_lost,
    works_on,
)
from opsim.engine.simpy_engine.floor import Floor, progress
from opsim.engine.simpy_engine.interruption import call_again, forget_progress, interrupt
from opsim.engine.simpy_engine.members import disband
from opsim.engine.simpy_engine.relief import Reliefs
from opsim.engine.simpy_engine.state import CREWS, Job, Worker
from opsim.engine.simpy_engine.ties import Ties
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import AWAY, HELD, NO_TOOL, NO_WORKER, SETUP, TRANSPORT, WAIT, WALK, WORK


class Leaving:
    """ties : jobs that wait for who is away; reliefs : who is to be relieved"""

    def __init__(self, floor: Floor):
        self.ties, self.reliefs = Ties(floor), Reliefs(floor)

    def leave(self, floor: Floor, worker: Worker, rule: str) -> Job | None:
        """His time has come. Who may go is free then; else he goes when he is. ``rule`` is that of his shift.

        Returns the job that he goes on with, all tasks of it here, where the rule says so.
        """
        job = worker.job
        if worker.rank in floor.free or job is None or job.kind == TRANSPORT:
            return None
        if job.team is not None and worker in job.team:
            return self._leave_team(floor, worker, job, rule)
        elif worker.kind == WALK:
            self._turn_back(floor, worker, job)
        elif (job.worker == worker.rank and job.kind in (WORK, SETUP)) or _waits_for_tool(worker, job):
            return self._leave_work(floor, worker, job, rule)
        else:
            self.stand_by(floor, worker)
        return None

    def stand_by(self, floor: Floor, worker: Worker) -> None:
        """Who is to go and only stands by goes at once: by a blocked job, or by a team that is not done yet."""
        job = worker.job
        if job is None:
            return
        if job.held_by is worker:
            self.ties.put_down(floor, worker, job)
        elif _is_done_with(worker, job):
            job.team.remove(worker)  # type: ignore[union-attr]
            set_free(floor, worker)

    def _turn_back(self, floor: Floor, worker: Worker, job: Job) -> None:
        """He walks on to where he was sent, and the job calls for anybody again, or waits on for him."""
        if self.reliefs.turns_back(worker):
            return
        if worker.rank in floor.called:
            floor.called[worker.rank].turns_back(floor, worker, job)
            return
        if self.ties.job_of.get(worker.rank) is job:
            worker.job = None
            _put_tools_back(floor, job)
        elif job.kind == HELD and job.cause == NO_WORKER:
            worker.job = None
            _put_tools_back(floor, job)
            call_again(floor, job)

    def _leave_team(self, floor: Floor, worker: Worker, job: Job, rule: str) -> Job | None:
        """A team goes on together, or breaks off together: nobody is waited for.

        Returns the job where he goes on with it, all tasks of it here that want a team.
        """
        which, alone = _rule_of(floor, job, rule), job.worker >= 0 and job.kind == WORK
        begun = job.kind == WORK and floor.now > job.since_s
        ahead = job.progress_from > 0 or job.task_position > 0 or job.repeats_done > 0
        if which == FINISH_JOB and job.kind == WORK and not alone and works_on(which, begun, begun or ahead):
            return job
        if job.kind != WORK:
            disband(floor, job)
            _put_tools_back(floor, job)
            call_again(floor, job)
        elif worker.stint is None:
            self.stand_by(floor, worker)
        elif alone and not works_on(which, begun, begun):  # he only helps: the other one goes on alone
            floor.helping.end(floor, job)
        elif not works_on(which, begun, begun):
            _stop(floor, worker, job, NO_WORKER)
            if is_lost(which):
                forget_progress(job)
            call_again(floor, job)
        return None

    def _leave_work(self, floor: Floor, worker: Worker, job: Job, rule: str) -> Job | None:
        which = _rule_of(floor, job, rule)
        if which == RESUME and CREWS in worker.limits:
            which = RESUME_ANY
        at_work = job.kind != HELD
        done = progress(job, floor.now) if at_work else job.progress_from
        begun = floor.now > job.since_s if at_work else done > 0
        all_begun = begun or done > 0 or job.task_position > 0 or job.repeats_done > 0
        if works_on(which, begun, all_begun):
            if which == HAND_OVER:
                self.reliefs.ask(floor, worker, job)
            return job if which == FINISH_JOB else None
        _stop(floor, worker, job, AWAY if is_kept_for_him(which, done) else NO_WORKER)
        if is_kept_for_him(which, done):
            self.ties.tie(worker, job)
            return None
        if is_lost(which):
            forget_progress(job)
        call_again(floor, job)
        return None


def _waits_for_tool(worker: Worker, job: Job) -> bool:
    """Whether he is in the middle of a performance, or just before it, and stands by until a tool is there."""
    return worker.kind == WAIT and worker.cause == NO_TOOL and job.kind == HELD


def _is_done_with(worker: Worker, job: Job) -> bool:
    """Whether he has done his part of what a team is at, and does not stay for its other tasks."""
    of_team = job.team is not None and worker in job.team
    return of_team and job.kind == WORK and worker.stint is None and worker.staying is not job


def _rule_of(floor: Floor, job: Job, of_shift: str) -> int:
    """The rule of the task a job has come to, which goes before that of the shift."""
    task = job.station.tasks[job.task_position] if job.setup_task < 0 else job.setup_task
    return INTERRUPTION_RULES[floor.plan.tasks[task].interruption or of_shift]


def _stop(floor: Floor, worker: Worker, job: Job, cause: int) -> None:
    """The performance is broken off where it is, and its worker is free; also while he waits for a tool in it."""
    if job.kind != HELD:
        interrupt(floor, job, cause)
        return
    _put_tools_back(floor, job)
    set_free(floor, worker)
    floor.job_now(job, HELD, cause)


def _put_tools_back(floor: Floor, job: Job) -> None:
    for told in floor.broken_off:
        told(floor, job)
