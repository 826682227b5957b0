"""Gates at which cards are taken: who may come in, and why the others wait."""

from __future__ import annotations

from dataclasses import dataclass, field

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Claim, Gate, Job
from opsim.log import BLOCKED, GATE, HELD, NO_CARD, NO_CAUSE
from opsim.plan.cards import CardPlan
from opsim.plan.release import INSIDE

Want = tuple[int, int]
"""(product rank, step of its route)"""


@dataclass(slots=True, eq=False)
class Loop:
    """free : cards that no job has; gates : where they are taken"""

    plan: CardPlan
    free: int
    gates: list[Gate] = field(default_factory=list)

    def take_back(self, floor: Floor, job: Job) -> None:
        """A card that a job has is given back; free it is when the job has none of the loop any more."""
        job.cards.remove(self)  # type: ignore[union-attr]
        if self not in job.cards:  # type: ignore[operator]
            self.free += 1
            floor.stirred.update(gate for gate in self.gates if gate.claims)


class Guard:
    """Stands at a gate: who may come in, and why the others wait.

    lines : whether every job comes here once, without cards, and from elsewhere; n_wants : products and steps there are
    """

    __slots__ = ("floor", "gate", "lines", "n_wants", "needs")

    def __init__(self, floor: Floor, gate: Gate, wants: list[Want], needs: dict[Want, tuple[Loop, ...]]):
        self.floor, self.gate, self.needs, self.n_wants = floor, gate, needs, len(wants)
        keeps_places = any(station.place_first for station in floor.plan.stations)
        self.lines = not keeps_places and all(_comes_once(floor, *want) for want in wants)

    def lets(self, product: int, step: int) -> bool:
        """Whether a job that is still to be made would find its cards."""
        return all(loop.free for loop in self.needs.get((product, step), ()))

    def allows(self, job: Job) -> bool:
        """Whether the job has, or finds, all the cards it needs here: all of them at once, or none is taken."""
        held = job.cards or ()
        return all(loop.free or loop in held for loop in self.needs.get(_want(job), ()))

    def entered(self, _floor: Floor, job: Job) -> None:
        """Take the cards; who has one keeps it. One that leaving the station here would give back stands twice."""
        cards = job.cards = [] if job.cards is None else job.cards
        taken: list[Loop] = [] if job.ahead is None else job.ahead.cards
        leaves = -1 if job.station is None else job.station.rank
        for loop in self.needs.get(_want(job), ()):
            if loop not in cards:
                loop.free -= 1
                taken.append(loop)
                cards.append(loop)
            if leaves in loop.plan.back and cards.count(loop) == 1:
                taken.append(loop)
                cards.append(loop)

    def given_up(self, floor: Floor, job: Job) -> None:
        """The place that was kept for the job is given up, and the cards that were taken with it are given back."""
        taken, job.ahead.cards = job.ahead.cards, []  # type: ignore[union-attr]
        for loop in taken:
            loop.take_back(floor, job)

    def pick(self) -> Claim | None:
        """The first claim that can be met; jobs that are passed over are marked with what they wait for.

        Where nobody comes twice, those of one product wait in one line: when the first of each waits, the rest do.
        NOTE: with 5,000 jobs outside, going through all of them took 100 times as long as the rest of the run.
        """
        gate, room = self.gate, self.gate.has_room
        in_lines = self.lines and bool(gate.claims) and gate.claims[0][0] == gate.claims[-1][0]
        lacking: set[Want] = set()
        stuck: set[Want] = set()
        for claim in gate.claims:
            job = claim[3]
            if job.ahead is not None and job.ahead.station is not None:
                return claim
            want = _want(job)
            if (want in lacking and not job.cards) or not self.allows(job):
                lacking.add(want)
                self._mark(job, True)
            elif room or (job.station in gate.stations and job.keeps_place):
                return claim
            else:
                self._mark(job, False)
            stuck.add(want)
            if in_lines and len(stuck) == self.n_wants:
                self._mark_new(lacking)
                break
        return None

    def _mark_new(self, lacking: set[Want]) -> None:
        """Mark those who came just now: they stand at the end of the line."""
        for claim in reversed(self.gate.claims):
            if claim[1] < self.floor.now:
                return
            self._mark(claim[3], _want(claim[3]) in lacking)

    def _mark(self, job: Job, lacks_card: bool) -> None:
        """A job outside, or blocked where it is, waits for a card or for room."""
        if job.kind == HELD and job.station is None:
            cause = NO_CARD if lacks_card else GATE
        elif job.kind == BLOCKED:
            cause = NO_CARD if lacks_card else NO_CAUSE
        else:
            return
        if job.cause != cause:
            self.floor.job_now(job, job.kind, cause)


def _comes_once(floor: Floor, product: int, step: int) -> bool:
    """Whether a job that comes to a step has no card and no place yet: it is the first, and no way leads back to it."""
    onward = floor.plan.products[product].onward
    inside = any(source.kind == INSIDE and product in dict(source.mix) for source in floor.plan.sources)
    sure = floor.plan.products[product].start == ((1.0, step),) and not inside
    return sure and not any(step == to for way in onward for _, to in way)


def _want(job: Job) -> Want:
    return job.product, job.step if job.ahead is None else job.ahead.step
