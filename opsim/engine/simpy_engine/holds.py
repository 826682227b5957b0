"""A tool in the hands between two moments of a performance: who finds none free at the first of them waits there."""

from collections.abc import Iterator
from dataclasses import dataclass

from opsim.clock import TICKS_PER_S, on_grid
from opsim.engine.simpy_engine.crib import IN_HAND, Crib
from opsim.engine.simpy_engine.draws import Held
from opsim.engine.simpy_engine.floor import Floor, progress
from opsim.engine.simpy_engine.grips import Want
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.engine.simpy_engine.station import begin, stand_still
from opsim.engine.simpy_engine.worker import set_free, wait_by
from opsim.log import NO_TOOL, WAIT, WORK
from opsim.plan.tools import HoldPlan


@dataclass(slots=True, eq=False)
class Doing:
    """A performance with a hold, from where it has come to. worker, task, k : whose, of what, and which

    left_s, start_s, end_s : seconds of work to its end, and to the moments of taking the tool and of giving it back
    stretch_s : seconds of work to where the stretch under way ends
    at_work : whether it is under way now; begun : whether it was ever
    before  : how much of the task was done when it was drawn; drawn : before human effects, with the moments as shares
    """

    worker: Worker
    task: int
    k: int
    left_s: float
    start_s: float
    end_s: float
    before: float
    drawn: Held
    stretch_s: float = 0.0
    at_work: bool = False
    begun: bool = False

    def pass_by(self, spent_s: float) -> None:
        """So much of the work is done."""
        self.left_s -= spent_s
        self.start_s -= spent_s
        self.end_s -= spent_s


class Holds:
    """The performances of a floor in which a tool is held."""

    def __init__(self, floor: Floor, crib: Crib):
        self.crib = crib
        self.doing: dict[int, Doing] = {}
        self.luck: dict[tuple[str, int, int], Iterator[Held]] = {}
        floor.left_station.append(self.leave)

    def act(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """The worker begins, or goes on with what was broken off; False where the station stands still."""
        station = job.station
        if station.down:
            return False
        doing = self.doing.get(job.number)
        attended = floor.plan.tasks[station.tasks[job.task_position]].attended
        if doing is not None and (doing.worker is worker or attended) and _is_as_it_was(job, doing):
            doing.worker = worker
            if attended:
                worker.pace_shift = 0.0
            if self._is_to_begin(floor, job, doing):
                doing = self._asked_again(floor, job, doing)
            elif doing.begun:
                doing.pass_by(doing.left_s - job.rest_s)
        else:
            if not job.rest_s:
                self.crib.put_back(job, IN_HAND)
            doing = self.doing[job.number] = self._drawn(floor, job, worker)
        worker.since_s, doing.at_work = floor.now, False
        self._go(floor, job, doing)
        return True

    def acted(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """A stretch is over: the tool is taken or given back; False where the performance is done."""
        doing = self.doing.get(job.number)
        if doing is None or doing.worker is not worker:
            return False
        doing.pass_by(doing.stretch_s)
        if doing.left_s > 0:
            self._go(floor, job, doing)
            return True
        del self.doing[job.number]
        self.crib.put_back(job, IN_HAND)
        return False

    def leave(self, floor: Floor, job: Job, _station: Station) -> None:
        """The job is gone: who stood by and waited for its tool is free."""
        doing = self.doing.pop(job.number, None)
        if doing is not None and doing.worker.job is job and doing.worker.kind == WAIT:
            set_free(floor, doing.worker)

    def _go(self, floor: Floor, job: Job, doing: Doing) -> None:
        """On to the next moment; or the worker waits by the job where the tool is wanted now and none is free."""
        if doing.start_s <= 0 < doing.end_s:
            hold: HoldPlan = floor.plan.tasks[doing.task].hold  # type: ignore[assignment]
            done = progress(job, floor.now) if doing.at_work else 0.0
            want = Want(IN_HAND, ((hold.tool, 1),), doing.task, lambda: self._given(floor, job, doing))
            if not self.crib.take(job, want):
                self._pause(floor, job, doing, done)
                return
        elif doing.end_s <= 0 or not doing.at_work:  # who takes over may have it for nothing yet
            self.crib.put_back(job, IN_HAND)
        self._stretch(floor, job, doing)

    def _stretch(self, floor: Floor, job: Job, doing: Doing) -> None:
        worker = doing.worker
        if not doing.at_work:
            begin(floor, job, worker.rank, doing.task, doing.k, doing.left_s)
            worker.kind, worker.since_s = WORK, floor.now
            doing.at_work = doing.begun = True
        ahead = [moment for moment in (doing.start_s, doing.end_s) if 0 < moment < doing.left_s]
        doing.stretch_s = min(ahead, default=doing.left_s)
        floor.at_end_of(doing.stretch_s, worker.stretch_over)

    def _pause(self, floor: Floor, job: Job, doing: Doing, done: float) -> None:
        if doing.at_work:
            doing.at_work = False
            job.rest_s, job.progress_from = doing.left_s, done
            if job.station.meter is not None:
                job.station.meter.end(floor)
            if floor.humans:
                floor.humans[doing.worker.rank].stops(floor.now)
        wait_by(floor, doing.worker, NO_TOOL)

    def _given(self, floor: Floor, job: Job, doing: Doing) -> None:
        """The tool that was waited for is there."""
        station = job.station
        at_once = doing.begun and doing.worker.since_s == floor.now  # he has not waited for it at all
        if station.down and not (at_once and station.finishes):
            self.crib.put_back(job, IN_HAND)
            set_free(floor, doing.worker)
            stand_still(floor, station, job)
            return
        wait_by(floor, doing.worker, NO_TOOL)  # writes the wait until now
        if self._is_to_begin(floor, job, doing):
            doing = self._asked_again(floor, job, doing)
        self._stretch(floor, job, doing)

    def _drawn(self, floor: Floor, job: Job, worker: Worker) -> Doing:
        """The worker's next performance, or what is left of the job's task at his own pace; all on the grid."""
        station = job.station
        task = station.tasks[job.task_position]
        if floor.plan.tasks[task].attended:
            luck, k = self._of("station", floor, task, station.rank), station.next_k.get(task, 0)
            station.next_k[task], worker.pace_shift = k + 1, 0.0
        else:
            luck, k = self._of("worker", floor, task, worker.rank), worker.next_k[task]
            worker.next_k[task] = k + 1
        return _timed(floor, job, worker, task, k, next(luck))

    def _is_to_begin(self, floor: Floor, job: Job, doing: Doing) -> bool:
        """Whether somebody with human effects has done nothing yet of a time of his own."""
        own = doing.worker.human is not None and not floor.plan.tasks[doing.task].attended
        return own and doing.before == job.progress_from

    def _asked_again(self, floor: Floor, job: Job, doing: Doing) -> Doing:
        """Human effects are those of when it truly begins."""
        again = _timed(floor, job, doing.worker, doing.task, doing.k, doing.drawn)
        again.begun, job.pace_shift = doing.begun, doing.worker.pace_shift
        self.doing[job.number] = again
        return again

    def _of(self, whose: str, floor: Floor, task: int, rank: int) -> Iterator[Held]:
        luck = self.luck.get((whose, task, rank))
        if luck is None:
            hold: HoldPlan = floor.plan.tasks[task].hold  # type: ignore[assignment]
            draw = floor.draws.runs_with if whose == "station" else floor.draws.durations_with
            luck = self.luck[whose, task, rank] = draw(hold, task, rank)
        return luck


def _is_as_it_was(job: Job, doing: Doing) -> bool:
    """Whether nothing of what was done of a performance, or before it was drawn, was lost since."""
    return job.rest_s > 0 if doing.begun else doing.before == job.progress_from


def _timed(floor: Floor, job: Job, worker: Worker, task: int, k: int, drawn: Held) -> Doing:
    """What is left of the job's task at the pace of a draw; all on the grid."""
    (time_s, start, end), station, rating = drawn, job.station, 1.0
    if not floor.plan.tasks[task].attended:
        rating = worker.rating[station.rank]
        if worker.human is not None:
            time_s = worker.human.drawn(floor, station, task, k, time_s)
    whole_s = on_grid(time_s / rating)
    left_s = on_grid(whole_s * (1.0 - job.progress_from)) if job.rest_s else whole_s
    start_s, end_s = (round(share * whole_s * TICKS_PER_S) / TICKS_PER_S - (whole_s - left_s) for share in (start, end))
    return Doing(worker, task, k, left_s, start_s, end_s, job.progress_from, drawn)
