"""Who is to be asked at a gate with cards: one of each line outside, and everybody who is on the floor."""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from opsim.engine.simpy_engine.state import OUTSIDE, Claim, Job

Want = tuple[int, int]
"""(product rank, step of its route)"""


def want_of(job: Job) -> Want:
    """What a job claims a place for."""
    return job.product, job.step if job.ahead is None else job.ahead.step


def is_outside(job: Job) -> bool:
    """Whether a job has neither a place nor a card yet: in this all who want the same are alike, but for their time."""
    return job.station is OUTSIDE and job.ahead is None and not job.cards


@dataclass(slots=True, eq=False)
class Lines:
    """The claims of a gate, as far as they were looked at; some of them may be gone.

    outside : in a line for each product and step; where the first of it waits, the rest do
    inside  : of jobs that come from a station, or have cards: each for itself
    until_s, last : up to when they were looked at, and those of that instant, by identity

    NOTE: with 5,000 jobs outside, going through all of them took 100 times as long as the rest of the run.
    """

    outside: dict[Want, list[Claim]] = field(default_factory=dict)
    inside: list[Claim] = field(default_factory=list)
    until_s: float = -1.0
    last: dict[int, Claim] = field(default_factory=dict)

    def first(self, claims: list[Claim], now: float) -> list[Claim]:
        """The claims that decide which one is met, in order. ``claims``: all of the gate, in order."""
        if claims[0][0] != claims[-1][0]:  # of different priority: the new ones may be anywhere
            self._look(claims, now)
        else:
            self._look(self._new(claims), now)
        self.inside = [claim for claim in self.inside if _is_there(claim, claims)]
        heads = [line[0] for line in self.outside.values() if _moved_up(line, claims)]
        return sorted([*self.inside, *heads])

    def newest(self, claims: list[Claim]) -> list[Claim]:
        """Those that were put down at the instant of the last look, and are still there."""
        return [claim for claim in self.last.values() if _is_there(claim, claims)]

    def _new(self, claims: list[Claim]) -> Iterator[Claim]:
        for claim in reversed(claims):
            if claim[1] < self.until_s:
                return
            yield claim

    def _look(self, claims: Iterable[Claim], now: float) -> None:
        """Put claims that were not looked at before where they belong."""
        last = self.last if now == self.until_s else {}
        for claim in claims:
            if claim[1] < self.until_s or id(claim) in self.last:
                continue
            if claim[1] == now:
                last[id(claim)] = claim
            insort(self.outside.setdefault(want_of(claim[3]), []) if is_outside(claim[3]) else self.inside, claim)
        self.until_s, self.last = now, last


def _moved_up(line: list[Claim], claims: list[Claim]) -> bool:
    """Whether there is a first in a line, once those who are gone are out of it."""
    gone = 0
    while gone < len(line) and not _is_there(line[gone], claims):
        gone += 1
    del line[:gone]
    return bool(line)


def _is_there(claim: Claim, claims: list[Claim]) -> bool:
    at = bisect_left(claims, claim)
    return at < len(claims) and claims[at] is claim
