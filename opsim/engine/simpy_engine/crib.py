"""The crib: where tools are taken from and given back to, and who waits for which."""

from bisect import insort
from collections.abc import Container
from dataclasses import replace

from opsim.engine.rules.tools import enough
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.grips import Grip, Want, log_grip, log_wait
from opsim.engine.simpy_engine.state import Claim, Job, Station, claim_of
from opsim.engine.simpy_engine.station import quiet
from opsim.log import HELD, NO_TOOL
from opsim.plan.tools import Needs

AT_STATION, IN_HAND = -1, -2
"""What a job has tools for, besides the tasks at its station by their position: the station itself, a hold."""


class Crib:
    """The tools of a floor: how many of each are free, what each job has, and who waits.

    since_s : by job and purpose, since when they are wanted; calling : jobs that call for a worker with tools
    known   : jobs that had, wanted or called for some at the station where they are
    """

    def __init__(self, floor: Floor):
        self.floor = floor
        self.free = [tool.n for tool in floor.plan.tools]
        self.grips: dict[int, dict[int, Grip]] = {}
        self.since_s: dict[tuple[int, int], float] = {}
        self.waiting: list[tuple[Claim, Want]] = []
        self.calling: dict[int, tuple[Job, Want]] = {}
        self.known: set[int] = set()
        self.changed = False

    def has(self, job: Job, purpose: int) -> bool:
        """Whether a job has its tools for something."""
        return purpose in self.grips.get(job.number, ())

    def is_free(self, needs: Needs) -> bool:
        """Whether all that is needed is there."""
        free = self.free
        for tool, n in needs:  # noqa: SIM110  NOTE: asked often, of one or two tools; ``all`` takes three times as long
            if not enough(free[tool], n):
                return False
        return True

    def take(self, job: Job, want: Want) -> bool:
        """The job takes all the tools it wants; False where it has to wait for them, all together."""
        if self.has(job, want.purpose):
            return True
        free = self.is_free(want.needs)
        if free and not self._first_is_another(job, want):
            if want.at_once:
                self.grip(job, want)
            return True
        self._wait(job, want)
        if free:
            self._stir()
        return False

    def call(self, job: Job, want: Want) -> None:
        """The job calls for a worker, with tools that are free now; somebody else may have them before he sets out."""
        job.with_tools = True
        self.known.add(job.number)
        self.since_s.setdefault((job.number, want.purpose), self.floor.now)
        self.calling[job.number] = job, want

    def before(self, _floor: Floor, job: Job) -> list[Station]:
        """Stations whose first call has waited longer for tools that a job calls for too, the longest wait first."""
        _, mine = self.calling[job.number]
        claim = self._claim(job, mine)
        wanted = dict(mine.needs)
        found = []
        for other, want in self.calling.values():
            station: Station = other.station
            short = any(tool in wanted and self.free[tool] < wanted[tool] + n for tool, n in want.needs)
            if (
                short
                and station.calling
                and station.calling[0][3] is other
                and self._claim(other, want)[:2] < claim[:2]
            ):
                found.append((self._claim(other, want), station))
        return [station for _, station in sorted(found, key=lambda pair: pair[0])]

    def sent(self, _floor: Floor, job: Job) -> None:
        """A worker sets out, and the tools with him."""
        _, want = self.calling.pop(job.number)
        job.with_tools = False
        self.grip(job, want)

    def grip(self, job: Job, want: Want) -> None:
        """The tools are the job's; whoever calls for a worker with them calls no more, and waits."""
        for tool, n in want.needs:
            self.free[tool] -= n
        station = job.station
        grip = Grip(want.needs, want.task, self.floor.now, station.rank, job.operation_rank)
        self.known.add(job.number)
        self.grips.setdefault(job.number, {})[want.purpose] = grip
        self.since_s.pop((job.number, want.purpose), None)
        for other, unmet in [pair for pair in self.calling.values() if not self.is_free(pair[1].needs)]:
            self._call_off(other, unmet)

    def put_back(self, job: Job, purpose: int) -> None:
        """The job gives back what it had for something, if it had."""
        grips = self.grips.get(job.number)
        grip = None if grips is None else grips.pop(purpose, None)
        if grip is None:
            return
        log_grip(self.floor, job, grip)
        for tool, n in grip.needs:
            self.free[tool] += n
        if self.waiting:
            self._stir()

    def put_back_tasks(self, job: Job, keep: int = IN_HAND) -> None:
        """The job gives back the tools of its tasks, but those of the one it has come to."""
        for purpose in [p for p in self.grips.get(job.number, ()) if p >= 0 and p != keep]:
            self.put_back(job, purpose)

    def break_off(self, _floor: Floor, job: Job) -> None:
        """The job's work is broken off: what was in hand for it is put back, what the station needs stays."""
        if job is self.floor.handed_over:
            return
        self._call_back(job, (IN_HAND,))
        self.put_back_tasks(job)
        self.put_back(job, IN_HAND)

    def call_off(self, _floor: Floor, job: Job) -> bool:
        """The job, which may not begin yet, waits for the tools of its task no more; True where it did."""
        return self._call_back(job, range(len(job.station.tasks)))

    def _call_back(self, job: Job, purposes: Container[int]) -> bool:
        """The job waits no more for tools for some purposes; True where it did."""
        if not self.waiting:
            return False
        mine = [pair for pair in self.waiting if pair[0][3] is job and pair[1].purpose in purposes]
        for pair in mine:
            self.waiting.remove(pair)
            del self.since_s[job.number, pair[1].purpose]
            log_wait(self.floor, job, pair[1].task)
        return bool(mine)

    def leave(self, _floor: Floor, job: Job, _station: Station) -> None:
        """The job leaves its station, or loses its server: it has nothing any more, and waits for nothing."""
        if job.number not in self.known:
            return
        self.known.remove(job.number)
        self.waiting = [pair for pair in self.waiting if pair[0][3] is not job]
        self.calling.pop(job.number, None)
        job.with_tools = False
        for purpose in list(self.grips.get(job.number, ())):
            self.put_back(job, purpose)
        self.grips.pop(job.number, None)
        self.since_s = {key: since_s for key, since_s in self.since_s.items() if key[0] != job.number}

    def pass_on(self, floor: Floor, job: Job, other: Job) -> None:
        """What the station needs is another job's from now on."""
        grip = self.grips[job.number].pop(AT_STATION)
        log_grip(floor, job, grip)
        self.known.add(other.number)
        passed = replace(grip, since_s=floor.now, operation=other.operation_rank)
        self.grips.setdefault(other.number, {})[AT_STATION] = passed

    def give_out(self, _floor: Floor) -> bool:
        """What was given back goes to who waits: the first that can have all he wants. True where somebody got it."""
        if not self.changed:
            return False
        self.changed = given = False
        for pair in list(self.waiting):
            claim, want = pair
            if pair in self.waiting and self.is_free(want.needs):
                self.waiting.remove(pair)
                log_wait(self.floor, claim[3], want.task)
                if want.at_once:
                    self.grip(claim[3], want)
                want.go_on()
                given = True
        return given

    def close(self, floor: Floor) -> None:
        """Write what is open at the horizon."""
        for claim, want in self.waiting:
            log_wait(floor, claim[3], want.task)
        for number, grips in self.grips.items():
            for grip in grips.values():
                log_grip(floor, floor.jobs[number], grip)

    def _stir(self) -> None:
        """Somebody who waits may have what he wants: to be seen in this instant."""
        self.changed = True
        self.floor.wake()

    def _claim(self, job: Job, want: Want) -> Claim:
        return claim_of(job, self.since_s.get((job.number, want.purpose), self.floor.now))

    def _first_is_another(self, job: Job, want: Want) -> bool:
        """Whether one of these tools goes to somebody who waits, and is to have it in this instant."""
        mine = self._claim(job, want)
        tools = {tool for tool, _ in want.needs}
        return any(
            claim < mine and self.is_free(other.needs) and any(tool in tools for tool, _ in other.needs)
            for claim, other in self.waiting
        )

    def _wait(self, job: Job, want: Want) -> None:
        self.floor.job_now(job, HELD, NO_TOOL)
        self.known.add(job.number)
        since_s = self.since_s.setdefault((job.number, want.purpose), self.floor.now)
        insort(self.waiting, (claim_of(job, since_s), want), key=lambda pair: pair[0])

    def _call_off(self, job: Job, want: Want) -> None:
        del self.calling[job.number]
        job.with_tools = False
        station = job.station
        if any(claim[3] is job for claim in station.calling):
            station.calling = [claim for claim in station.calling if claim[3] is not job]
            quiet(self.floor, station)
            self._wait(job, want)
