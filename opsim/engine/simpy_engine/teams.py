"""Teams: nobody is sent to a task of several workers before as many are free; the slowest of them ends it."""

from bisect import insort
from dataclasses import dataclass

from opsim.clock import on_grid
from opsim.engine.simpy_engine.crib import Crib
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.grips import Want
from opsim.engine.simpy_engine.members import all_may_stay, chosen, comes_again, disband
from opsim.engine.simpy_engine.state import OUTSIDE, Claim, Job, Station, Worker, claim_of
from opsim.engine.simpy_engine.station import begin, drawn_run_s, drawn_s, ended, perform, stand_still, task_done
from opsim.engine.simpy_engine.stints import Stint
from opsim.engine.simpy_engine.worker import log_worker, set_free, wait_by, walk
from opsim.log import HELD, NO_WORKER, TEAM, WORK


@dataclass(slots=True, eq=False)
class Progress:
    """Of a team: how many are still on their way, and how many still at work."""

    coming: int
    working: int = 0


class Teams:
    """The jobs of a floor that are done by several workers at once."""

    def __init__(self, floor: Floor, crib: Crib | None):
        self.crib = crib
        self.gathering: list[Claim] = []
        self.of: dict[int, Progress] = {}
        floor.dispatchers.append(self.gather)
        floor.left_floor.append(self.forget)
        floor.call_off.append(self.call_off)

    def call(self, floor: Floor, job: Job) -> None:
        """The job waits until as many workers are free as its task takes."""
        floor.job_now(job, HELD, NO_WORKER)
        insort(self.gathering, claim_of(job, floor.now))

    def call_off(self, _floor: Floor, job: Job) -> bool:
        """The job, which may not begin yet, calls for a team no more; True where it did."""
        mine = [claim for claim in self.gathering if claim[3] is job]
        for claim in mine:
            self.gathering.remove(claim)
        return bool(mine) and _calls(job)

    def forget(self, _floor: Floor, job: Job) -> None:
        """The job is on the floor no more."""
        self.of.pop(job.number, None)

    def gather(self, floor: Floor) -> bool:
        """Send whole teams, to the jobs that have waited longest. True where one was sent."""
        sent = False
        for claim in self._in_turn(floor) if len(floor.free) > 1 and self.gathering else ():
            job, station = claim[3], claim[3].station
            if not _calls(job) or station is OUTSIDE or job.number not in floor.jobs:
                self.gathering.remove(claim)  # its server was taken, or it is gone
            elif not station.down:
                team = self._team(floor, job, station)
                if team:
                    self.gathering.remove(claim)
                    self._send(floor, job, station, team)
                    sent = True
        return sent

    def _in_turn(self, floor: Floor) -> list[Claim]:
        """Jobs that wait for a team; first those for which somebody stays who is to go."""
        kept = [worker.staying for worker in floor.free.values() if worker.staying is not None]
        return sorted(self.gathering, key=lambda claim: claim[3] not in kept) if kept else list(self.gathering)

    def _team(self, floor: Floor, job: Job, station: Station) -> list[Worker]:
        """Who goes; nobody where too few are free, or the tools are not there."""
        needs = floor.plan.tasks[station.tasks[job.task_position]].needs
        return chosen(floor, job, station) if self.crib is None or self.crib.is_free(needs) else []

    def _send(self, floor: Floor, job: Job, station: Station, team: list[Worker]) -> None:
        position, task = job.task_position, station.tasks[job.task_position]
        if self.crib is not None and floor.plan.tasks[task].needs and not self.crib.has(job, position):
            self.crib.grip(job, Want(position, floor.plan.tasks[task].needs, task, lambda: None))
        floor.job_now(job, HELD, TEAM)
        job.team, self.of[job.number] = team, Progress(len(team))
        for worker in team:
            log_worker(floor, worker)
            worker.since_s = floor.now
            del floor.free[worker.rank]
            worker.job, worker.station = job, station
        for worker in team:
            walk_s = worker.walk_s[worker.place][station.rank]
            if walk_s > 0:
                walk(floor, worker, station.place, walk_s)
            else:
                worker.place = station.place
                perform(floor, job, worker)

    def act(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """Somebody has come: the last one begins with the others, who waited for him."""
        station = job.station
        if job.team is None or worker not in job.team:  # NOTE: the team was given up while he was on his way
            set_free(floor, worker)
            return True
        worker.since_s = floor.now
        wait_by(floor, worker, TEAM)
        progress = self.of[job.number]
        progress.coming -= 1
        if station.down:
            disband(floor, job)
            if self.crib is not None:
                self.crib.break_off(floor, job)
            stand_still(floor, station, job)
        elif not progress.coming:
            self._begin(floor, job, job.team)
        return True

    def acted(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """Somebody is done with his part; False where he is the last, and the task goes no further with this team."""
        if job.team is None or worker.stint is None:
            return False
        log_worker(floor, worker)
        worker.stint = None
        progress, team = self.of[job.number], job.team
        progress.working -= 1
        if progress.working:
            wait_by(floor, worker, TEAM)
            return True
        if comes_again(job) and not job.station.down and all_may_stay(floor, job):
            ended(floor, job)
            task_done(job)
            self._begin(floor, job, team)
            return True
        job.team = None
        for other in team:
            if other is not worker:
                set_free(floor, other)
        return False

    def _begin(self, floor: Floor, job: Job, team: list[Worker]) -> None:
        """All begin now, each with his own next time, or all with the station's."""
        station = job.station
        task = station.tasks[job.task_position]
        share, start = (1.0 - job.progress_from, job.progress_from) if job.rest_s else (1.0, 0.0)
        run = drawn_run_s(floor, station, task) if floor.plan.tasks[task].attended else None
        times = [run or drawn_s(floor, station, worker, task) for worker in team]
        shifts = [0.0 if run else worker.pace_shift for worker in team]
        seconds = [on_grid(whole_s * share) if share < 1 else whole_s for whole_s, _ in times]
        begin(floor, job, -1, task, -1, max(seconds))
        self.of[job.number].working = len(team)
        for worker, part_s, (_, k), shift in zip(team, seconds, times, shifts):
            log_worker(floor, worker)
            worker.stint = Stint(
                station.rank, job.product, job.operation_rank, task, floor.n_performances, k, part_s, start, shift
            )
            if floor.humans:
                floor.humans[worker.rank].works(floor.now, task, floor.now + part_s, start, k)
            floor.n_performances += 1
            worker.kind, worker.since_s = WORK, floor.now
            floor.at_end_of(part_s, worker.stretch_over)


def _calls(job: Job) -> bool:
    """Whether a job waits for the workers of a task; who lost his server may wait to be set up for instead."""
    return job.kind == HELD and job.cause == NO_WORKER and job.setup_task < 0
