"""When people are there, and who may be sent to a station: from shifts, breaks, absence and skills."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from itertools import compress

from opsim.plan.calendar import Duty
from opsim.plan.crews import CrewPlan
from opsim.plan.hours.spans import Spans, at_least, both, together, total_s, without
from opsim.plan.plan import Plan


class Hours:
    """The hours of a Plan's people and stations; each is worked out when it is asked for, once."""

    def __init__(self, plan: Plan):
        self.plan = plan
        self.always: Spans = ((0.0, plan.horizon_s),)
        self._able: dict[int, frozenset[int]] = {}
        self._during: dict[int, Spans] = {}

    @cached_property
    def on_duty(self) -> list[Spans]:
        """Of each worker: when he is on shift, breaks included."""
        duties = [worker.duties for worker in self.plan.workers]
        return [self.always if those is None else at_least(1, [_shifts(those)]) for those in duties]

    @cached_property
    def at_work(self) -> list[Spans]:
        """Of each worker: when he is on shift, and has neither a break nor a meeting."""
        return [
            spans if worker.duties is None else without(spans, at_least(1, [_pauses(worker.duties)]))
            for worker, spans in zip(self.plan.workers, self.on_duty)
        ]

    @cached_property
    def share(self) -> list[float]:
        """Of each worker: the share of the run that he is at work; days that he misses count as missed."""
        return [self._share(spans) * (1 - w.absence) for w, spans in zip(self.plan.workers, self.at_work)]

    @cached_property
    def share_with_overtime(self) -> list[float]:
        """Of each worker: as ``share``, if he stayed for all the overtime that his shifts allow."""
        return [
            min(1.0, share + self._overtime_s(rank) * (1 - self.plan.workers[rank].absence) / self.plan.horizon_s)
            for rank, share in enumerate(self.share)
        ]

    @cached_property
    def somebody(self) -> Spans:
        """When anybody at all is on shift."""
        return at_least(1, self.on_duty)

    def able(self, station: int) -> frozenset[int]:
        """Ranks of those who may ever be sent to a station: with the skill, and of its crew where it has one."""
        if station not in self._able:
            crews = [crew for crew in self.plan.crews if station in crew.stations]
            elsewhere = _in_crews(crew for crew in self.plan.crews if crew not in crews)
            members = _in_crews(crews)
            skilled = self._skilled[station]
            self._able[station] = frozenset(skilled & members if crews else skilled - elsewhere)
        return self._able[station]

    @cached_property
    def _skilled(self) -> list[set[int]]:
        found: list[set[int]] = [set() for _ in self.plan.stations]
        for number, worker in enumerate(self.plan.workers):
            for rank in compress(range(len(worker.rating)), worker.rating):  # NOTE: workers x stations, and most are 0
                found[rank].add(number)
        return found

    def team(self, station: int) -> int:
        """How many people the largest task of a station takes at once."""
        return max((self.plan.tasks[task].team for task in self.plan.stations[station].tasks), default=1)

    def manned(self, station: int, *, at_work: bool = False) -> Spans:
        """When enough people who can work at a station are on shift; at_work: and have no break."""
        there = self.at_work if at_work else self.on_duty
        return at_least(self.team(station), [there[worker] for worker in self.able(station)])

    def working_share(self, station: int, by_hand: bool) -> float:
        """The share of the run in which a station is open, and its people are at work; days missed count as missed.

        by_hand : whether it needs people; where nobody is able at all, which is told elsewhere, it is not asked.
        """
        is_open = self.open(station)
        able = sorted(self.able(station)) if by_hand else []
        missed = [self.plan.workers[worker].absence for worker in able]
        if not any(missed):
            return self._share(both(is_open, self.manned(station, at_work=True)) if able else is_open)
        there = [both(is_open, self.at_work[worker]) for worker in able]
        team = self.team(station)
        found = ((end_s - start_s, [missed[n] for n in who]) for start_s, end_s, who in together(there))
        return sum(seconds * chance_of(team, missing) for seconds, missing in found) / self.plan.horizon_s

    def open(self, station: int) -> Spans:
        """When a station is open."""
        open_s = self.plan.stations[station].open_s
        return self.always if open_s is None else open_s

    def during(self, shift: int) -> Spans:
        """When anybody is on a shift."""
        if shift not in self._during:
            duties = [worker.duties or () for worker in self.plan.workers]
            mine = [_shifts(duty for duty in those if duty.shift == shift) for those in duties]
            self._during[shift] = at_least(1, mine)
        return self._during[shift]

    def _share(self, spans: Spans) -> float:
        return total_s(spans) / self.plan.horizon_s

    def _overtime_s(self, worker: int) -> float:
        """All overtime that a worker may have in the run, ended by his next shift."""
        duties, total = self.plan.workers[worker].duties or (), 0.0
        for duty, after in zip(duties, [*(duty.start_s for duty in duties[1:]), self.plan.horizon_s]):
            total += max(0.0, min(self.plan.shifts[duty.shift].overtime_s, after - duty.end_s))
        return total


def chance_of(team: int, missing: Sequence[float]) -> float:
    """The probability that at least so many of some people have come, each of whom is missing with his own."""
    exactly = [1.0, *[0.0] * len(missing)]
    for share in missing:
        exactly = [here * share + before * (1 - share) for here, before in zip(exactly, [0.0, *exactly])]
    return sum(exactly[team:])


def _shifts(duties: Iterable[Duty]) -> Spans:
    return tuple((duty.start_s, duty.end_s) for duty in duties)


def _pauses(duties: Iterable[Duty]) -> Spans:
    return tuple((pause.start_s, min(pause.end_s, duty.end_s)) for duty in duties for pause in duty.pauses)


def _in_crews(crews: Iterable[CrewPlan]) -> set[int]:
    return {worker for crew in crews for worker in crew.workers}
