"""Gates at which cards are taken: who may come in, and why the others wait."""

from __future__ import annotations

from dataclasses import dataclass, field

from opsim.engine.simpy_engine.card_lines import Lines, Want, is_outside, want_of
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import OUTSIDE, Claim, Gate, Job
from opsim.log import BLOCKED, GATE, HELD, NO_CARD, NO_CAUSE
from opsim.plan.cards import CardPlan


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
    """Stands at a gate: who may come in, and why the others wait."""

    __slots__ = ("floor", "gate", "lines", "needs")

    def __init__(self, floor: Floor, gate: Gate, needs: dict[Want, tuple[Loop, ...]]):
        self.floor, self.gate, self.needs, self.lines = floor, gate, needs, Lines()

    def lets(self, product: int, step: int) -> bool:
        """Whether a job that is still to be made would find its cards."""
        return all(loop.free for loop in self.needs.get((product, step), ()))

    def allows(self, job: Job) -> bool:
        """Whether the job has, or finds, all the cards it needs here: all of them at once, or none is taken."""
        held = job.cards or ()
        return all(loop.free or loop in held for loop in self.needs.get(want_of(job), ()))

    def entered(self, _floor: Floor, job: Job) -> None:
        """Take the cards; who has one keeps it. One that leaving the station here would give back stands twice."""
        cards = job.cards = [] if job.cards is None else job.cards
        taken: list[Loop] = [] if job.ahead is None else job.ahead.cards
        leaves = job.station.rank
        for loop in self.needs.get(want_of(job), ()):
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
        """The first claim that can be met; jobs that are passed over are marked with what they wait for."""
        gate = self.gate
        if not gate.claims:
            return None
        room = gate.has_room
        lacking: set[Want] = set()
        for claim in self.lines.first(gate.claims, self.floor.now):
            job = claim[3]
            if job.ahead is not None and job.ahead.station is not None:
                return claim
            lacks_card = not self.allows(job)
            if not lacks_card and (room or (job.station in gate.stations and job.keeps_place)):
                return claim
            self._mark(job, lacks_card)
            if lacks_card and is_outside(job):
                lacking.add(want_of(job))
        self._mark_new(lacking)
        return None

    def _mark_new(self, lacking: set[Want]) -> None:
        """Mark those who came just now: they stand in lines whose first waits."""
        for claim in self.lines.newest(self.gate.claims):
            if is_outside(claim[3]):
                self._mark(claim[3], want_of(claim[3]) in lacking)

    def _mark(self, job: Job, lacks_card: bool) -> None:
        """A job outside, or blocked where it is, waits for a card or for room."""
        if job.kind == HELD and job.station is OUTSIDE:
            cause = NO_CARD if lacks_card else GATE
        elif job.kind == BLOCKED:
            cause = NO_CARD if lacks_card else NO_CAUSE
        else:
            return
        if job.cause != cause:
            self.floor.job_now(job, job.kind, cause)
