"""A paced line: jobs come onto it in its rhythm, and it stands where something keeps it."""

from __future__ import annotations

from collections.abc import Callable
from math import nan

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.line_clock import LineClock
from opsim.engine.simpy_engine.state import Claim, Gate, Job, Station, Worker
from opsim.log import ABSENT, AWAY, BREAK, NO_CAUSE, OFF, STANDS, pack_row
from opsim.plan import LinePlan

AT_THE_END = 90
"""Among what is asked when an operation is done: the last, when nothing else has become of the job."""
TICK = -1
"""In place of a job's number, for what concerns the line as a whole."""


class PacedLine:
    """stations : in the order of the line; people : who works on it without being called

    due    : whether the line is to move on, or to take the next job, as soon as nothing keeps it
    open_s : the instant at which it last did; taken : whether a job has come onto it then
    why, since_s : the cause for which it stands, and since when; NO_CAUSE while it runs
    """

    def __init__(self, floor: Floor, plan: LinePlan):
        self.plan, self.clock = plan, LineClock()
        self.stations = [floor.stations[rank] for rank in plan.stations]
        self.people = [
            worker
            for worker in floor.workers
            if worker.rank not in plan.floaters and any(worker.rating[rank] > 0 for rank in plan.stations)
        ]
        self.due, self.open_s, self.taken = True, -1.0, False
        self.why, self.since_s = NO_CAUSE, 0.0
        for station in self.stations:
            station.seated = [] if station.seated is None else station.seated
        for gate in self.stations[0].wanted_by:
            _guard(gate, lambda: self.open_s == floor.now and not self.taken)
            gate.entered = self._told_of(gate.entered)
        floor.dispatchers.append(self.watch)
        floor.closing.append(self._log)

    def is_open(self, job: Job) -> bool:
        """Whether something is left to be done of a job at its station."""
        raise NotImplementedError

    def move(self, floor: Floor) -> tuple[int, bool]:
        """A takt is over: move on. Why it cannot (NO_CAUSE: it did), and whether something changed."""
        raise NotImplementedError

    def kept(self, floor: Floor) -> int:
        """Why the line has to stand now."""
        for station in self.stations:
            if station.down:
                return station.stands_for
        gone = (BREAK, OFF, ABSENT)
        if self.people and all(worker.kind in gone for worker in self.people):
            return AWAY
        return NO_CAUSE

    def watch(self, floor: Floor) -> bool:
        """Stand or run, and move on where that is due; True where something changed."""
        why, changed = self.kept(floor), False
        if self.due and why == NO_CAUSE:
            why, changed = self.move(floor)
        if why != self.why:
            self._stand(floor, why)
        return changed

    def opens(self, floor: Floor) -> None:
        """A job may come onto the line in this instant; the next takt begins."""
        self.due, self.open_s, self.taken = False, floor.now, False
        floor.stir(self.stations[0])
        tick_s = self.clock.now_s(floor.now) + self.plan.takt_s
        self.clock.at(floor, tick_s, self.stations[0].rank, TICK, self._tick)

    def walks_to(self, _floor: Floor, _job: Job, _worker: Worker) -> bool:
        """Whether somebody who was sent to a job has still to walk along the line to it, and sets out."""
        return False

    def stop_walks(self, floor: Floor, job: Job, but: int = -1) -> None:
        """Whoever walks along the line to a job need not come, but for one of a rank."""

    def stood(self, floor: Floor) -> None:
        """The line has come to stand, or to run."""

    def _tick(self, _floor: Floor) -> None:
        self.due = True

    def _stand(self, floor: Floor, why: int) -> None:
        self._log(floor)
        self.why, self.since_s = why, floor.now
        if self.clock.runs != (why == NO_CAUSE):
            if self.clock.runs:
                self.clock.stop(floor)
            else:
                self.clock.start(floor)
        self.stood(floor)

    def _log(self, floor: Floor) -> None:
        """Write why the line stood until now."""
        if self.why != NO_CAUSE and floor.now > self.since_s:
            floor.write(pack_row(
                STANDS, self.since_s, floor.now, -1, self.stations[0].rank, -1, -1, -1, -1, -1, -1,
                -1, -1, -1, nan, nan, nan, self.why,
            ))  # fmt: skip

    def _told_of(self, before: Callable[[Floor, Job], None] | None) -> Callable[[Floor, Job], None]:
        def entered(floor: Floor, job: Job) -> None:
            self.taken = True
            if before is not None:
                before(floor, job)

        return entered


def _guard(gate: Gate, is_open: Callable[[], bool]) -> None:
    """Nobody comes in while the gate is shut; while it is open whoever could before."""
    picked, lets = gate.pick, gate.lets

    def pick() -> Claim | None:
        if not gate.claims or not is_open():
            return None
        if picked is not None:
            return picked()
        return gate.claims[0] if gate.has_room else None

    def let(product: int, step: int) -> bool:
        return is_open() and (not gate.claims if lets is None else lets(product, step))

    gate.pick, gate.lets = pick, let


def shut_but_at(floor: Floor, line: PacedLine, station: Station) -> None:
    """A station of a line takes jobs only in the instant in which the line moves."""
    for gate in station.wanted_by:
        _guard(gate, lambda: line.open_s == floor.now)
