"""When people are there, and who may be sent to a station: from shifts, breaks, absence and skills.

Scheduled hours: when the floor as a whole is meant to work. Times and names as a sentence says them.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from functools import cached_property
from itertools import compress

from opsim.plan.plan import Plan
from opsim.problems import enumerated
from opsim.subjects.lines.plan import CrewPlan
from opsim.subjects.shifts.plan import Duty, Spans, at_least, both, either, together, total_s, without


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
    def with_overtime(self) -> list[Spans]:
        """Of each worker: as ``at_work``, if he stayed for all the overtime that his shifts allow."""
        if not any(shift.overtime_s for shift in self.plan.shifts):
            return self.at_work
        return [at_least(1, (spans, self._overtime(rank))) for rank, spans in enumerate(self.at_work)]

    @cached_property
    def share(self) -> list[float]:
        """Of each worker: the share of the run that he is at work; days that he misses count as missed."""
        return [self._share(spans) * (1 - w.absence) for w, spans in zip(self.plan.workers, self.at_work)]

    @cached_property
    def share_with_overtime(self) -> list[float]:
        """Of each worker: as ``share``, if he stayed for all the overtime that his shifts allow."""
        return [self._share(spans) * (1 - w.absence) for w, spans in zip(self.plan.workers, self.with_overtime)]

    @cached_property
    def somebody(self) -> Spans:
        """When anybody at all is on shift."""
        return at_least(1, self.on_duty)

    def able(self, station: int) -> frozenset[int]:
        """Ranks of those who may be sent to a station: with the skill, and of its crew where it has one.

        Who comes to a paced line only when he is called is not among them.
        """
        if station not in self._able:
            crews = [crew for crew in self.plan.crews if station in crew.stations]
            elsewhere = _in_crews(crew for crew in self.plan.crews if crew not in crews)
            members = _in_crews(crews)
            on_call = {worker for line in self.plan.lines if station in line.stations for worker in line.floaters}
            skilled = self._skilled[station] - on_call
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

    def working_share(self, station: int, hand_s: float, alone_s: float, *, overtime: bool = False) -> float:
        """The share of the run in which a station can work: it is open, and its people are at work, or what it does
        without them lasts; days missed count as missed.

        hand_s, alone_s : seconds of a visit with people and without. Where nobody is able, which is told elsewhere,
        only its own hours count.
        """
        is_open, there = self.open(station), self.with_overtime if overtime else self.at_work
        able = sorted(self.able(station)) if hand_s > 0 else []
        if not able:
            return self._share(is_open)
        team, missed = self.team(station), [self.plan.workers[worker].absence for worker in able]
        manned = self._when_open(at_least(team, [there[worker] for worker in able]), is_open)
        on = alone_s / (hand_s + alone_s) * sum(runs_on_s(b - a, alone_s) for a, b in without(is_open, manned))
        if not any(missed):
            return self._share(manned) + on / self.plan.horizon_s
        seconds: defaultdict[frozenset[int], float] = defaultdict(float)
        for a, b, who in together([self._when_open(there[worker], is_open) for worker in able]):
            seconds[who] += b - a
        work_s = sum(s * chance_of(team, [missed[n] for n in sorted(who)]) for who, s in seconds.items())
        return (work_s + on) / self.plan.horizon_s

    def _when_open(self, spans: Spans, is_open: Spans) -> Spans:
        return spans if is_open is self.always else both(spans, is_open)

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

    def _overtime(self, worker: int) -> Spans:
        """All overtime that a worker may have in the run, ended by his next shift."""
        duties, found = self.plan.workers[worker].duties or (), []
        for duty, after in zip(duties, [*(duty.start_s for duty in duties[1:]), self.plan.horizon_s]):
            end_s = min(duty.end_s + self.plan.shifts[duty.shift].overtime_s, after)
            found.append((duty.end_s, max(end_s, duty.end_s)))
        return tuple(found)


def runs_on_s(gap_s: float, alone_s: float) -> float:
    """How long a machine that is in the middle of a run of ``alone_s`` goes on in a gap without people, on average."""
    return alone_s / 2 if gap_s >= alone_s else gap_s - gap_s**2 / (2 * alone_s)


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


def has_hours(plan: Plan) -> bool:
    """Whether anything or anybody of a plan keeps hours."""
    return floor_has_hours(plan) or any(source.open_s is not None for source in plan.sources)


def floor_has_hours(plan: Plan) -> bool:
    """Whether a station or somebody keeps hours."""
    stations = any(station.open_s is not None for station in plan.stations)
    return stations or any(worker.duties is not None for worker in plan.workers)


def scheduled(plan: Plan, hours: Hours | None = None) -> Spans:
    """When the floor is scheduled to be open, from 0 to the horizon: while at least one station on a route may work.

    A station may work while it is open (always, where it has no hours) and, where its tasks need people, while as many
    as its largest task takes of those who may be sent there are on shift: by plan, so breaks count, and absence and
    overtime change nothing; members of a crew count at its stations alone. A machine that works alone needs nobody.
    Sources do not count: what came in their hours is worked off in those of the stations. Where no station and nobody
    keeps hours it is all the time.
    """
    hours = Hours(plan) if hours is None else hours
    if not floor_has_hours(plan):
        return hours.always
    alike = {(plan.stations[rank].open_s, _people(hours, rank)): rank for rank in _on_routes(plan)}
    return either(*(_may_work(hours, rank) for rank in alike.values()))


def _may_work(hours: Hours, station: int) -> Spans:
    """When a station is open, and has the people it needs."""
    needs, is_open = _people(hours, station) is not None, hours.open(station)
    return both(is_open, hours.manned(station)) if needs else is_open


def _people(hours: Hours, station: int) -> tuple[int, frozenset[int]] | None:
    """How many people a station takes at most, and who they may be; None where it needs nobody."""
    alone = all(hours.plan.tasks[task].automatic for task in hours.plan.stations[station].tasks)
    return None if alone else (hours.team(station), hours.able(station))


def _on_routes(plan: Plan) -> list[int]:
    """Ranks of the stations where jobs are worked on; stores and conveyors have no tasks."""
    found = {rank for product in plan.products for operation in product.route for rank in operation.stations}
    return sorted(rank for rank in found if plan.stations[rank].tasks)


SHORT_S = 60.0
"""What is shorter is not worth a word."""


def lasting(seconds: float) -> str:
    """``45 s``, ``30 min``, ``7.5 h``."""
    if seconds < 120:
        return f"{seconds:.3g} s"
    return f"{seconds / 60:.3g} min" if seconds < 5400 else f"{seconds / 3600:.4g} h"


def station_names(plan: Plan, ranks: Iterable[int]) -> str:
    """The names of stations, in natural order."""
    return enumerated([plan.stations[rank].name for rank in sorted(ranks)])


def worker_names(plan: Plan, ranks: Iterable[int]) -> str:
    """The names of workers, in natural order."""
    return enumerated([plan.workers[rank].name for rank in sorted(ranks)])
