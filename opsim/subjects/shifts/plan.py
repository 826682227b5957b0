"""When people, stations and sources are there: weekly patterns laid on the time of a run.

Arithmetic of times: (from_s, to_s) pairs in order, none of which touch.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, Any

from opsim.clock import DAY_S, DAYS, WEEK_S
from opsim.plan.ranks import ranked
from opsim.problems import natural_key

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario

OPEN = tuple[tuple[float, float], ...]
"""(from_s, to_s) of each time that something is open, in order, from 0 to the horizon."""


@dataclass(frozen=True, slots=True)
class Pause:
    """A break or a meeting: from when to when it is planned; place : where it is, -1 where the worker stands."""

    name: str
    start_s: float
    end_s: float
    meeting: bool = False
    place: int = -1


@dataclass(frozen=True, slots=True)
class Duty:
    """One shift of one worker. Times are seconds from the start of the run, cut at its start and its horizon.

    shift : rank among the shifts; number : how many shifts of his were before it
    cut   : whether it goes on beyond the horizon
    whole_s : from when to when it would be were it not cut; None: as it is
    """

    start_s: float
    end_s: float
    shift: int
    number: int
    pauses: tuple[Pause, ...] = ()
    cut: bool = False
    whole_s: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class ShiftPlan:
    """at_break, at_end : the rules of interruption, one of ``RULES``; overtime_s : how long after its end people stay
    while the floor needs them.
    """

    name: str
    at_break: str
    at_end: str
    overtime_s: float = 0.0


def plan_shifts(scenario: Scenario) -> tuple[ShiftPlan, ...]:
    """All shifts in natural order of names."""
    shifts = sorted(scenario.shifts.items(), key=lambda item: natural_key(item[0]))
    return tuple(
        ShiftPlan(name, one.at_break, one.at_end, 0.0 if one.overtime is None else one.overtime.most_s)
        for name, one in shifts
    )


def plan_duties(scenario: Scenario, ranks: Any) -> dict[str, tuple[Duty, ...] | None]:
    """By worker, his shifts within the run, in order; None where he is always there.

    Those who follow the same shifts share them: a year of a hundred workers would else take seconds.
    """
    known: dict[tuple[str, ...], tuple[Duty, ...]] = {}
    for worker in scenario.workers.values():
        if worker.shift is not None and tuple(worker.shift) not in known:
            known[tuple(worker.shift)] = _duties(worker.shift, scenario, ranks)
    return {name: None if one.shift is None else known[tuple(one.shift)] for name, one in scenario.workers.items()}


def _duties(names: list[str], scenario: Scenario, ranks: Any) -> tuple[Duty, ...]:
    shift_ranks, horizon_s = ranked(scenario.shifts), scenario.run.horizon_s
    return tuple(
        Duty(
            max(start_s, 0.0),
            min(end_s, horizon_s),
            shift_ranks[name],
            number,
            _pauses(scenario.shifts[name], day, start_s, horizon_s, ranks.places),
            end_s > horizon_s,
            (start_s, end_s),
        )
        for number, (start_s, end_s, day, name) in enumerate(begun(names, scenario))
    )


def open_times(shifts: list[str] | None, scenario: Scenario) -> OPEN | None:
    """When something that is open in all of some shifts is open within the run; None where always."""
    if shifts is None:
        return None
    times = sorted((start_s, end_s) for name in shifts for start_s, end_s, _, _ in begun([name], scenario))
    joined: list[tuple[float, float]] = []
    for start_s, end_s in times:
        if joined and start_s <= joined[-1][1]:
            joined[-1] = joined[-1][0], max(end_s, joined[-1][1])
        else:
            joined.append((start_s, end_s))
    return tuple((max(start_s, 0.0), min(end_s, scenario.run.horizon_s)) for start_s, end_s in joined)


def next_open(hours: OPEN, at_s: float) -> float:
    """The first time from ``at_s`` on at which something with hours is open; inf where there is none in the run."""
    return next((max(at_s, from_s) for from_s, to_s in hours if at_s < to_s), inf)


def begun(names: list[str], scenario: Scenario) -> Iterator[tuple[float, float, str, str]]:
    """(start_s, end_s, day, name) of each time that shifts, which follow each other week by week, come up in a run.

    In order of time, in seconds from the start of the run, the first of them perhaps begun before it. The first name is
    that of the week, from Monday 00:00, in which the run starts.
    """
    horizon_s, week = scenario.run.horizon_s, -1
    while week * WEEK_S - scenario.run.start_s < horizon_s:
        name = names[week % len(names)]
        shift = scenario.shifts[name]
        for day in shift.days:
            start_s = week * WEEK_S + DAYS.index(day) * DAY_S + shift.start_s - scenario.run.start_s
            if start_s + shift.length_s > 0 and start_s < horizon_s:
                yield start_s, start_s + shift.length_s, day, name
        week += 1


def _pauses(shift: Any, day: str, start_s: float, horizon_s: float, places: dict[str, int]) -> tuple[Pause, ...]:
    """The breaks and meetings of one shift, in order of time."""
    found = []
    for meeting, named in ((False, shift.breaks), (True, shift.meetings)):
        for name, pause in named.items():
            from_s = start_s + shift.offset_s(pause)
            to_s = from_s + pause.lasts_s
            if (pause.days is None or day in pause.days) and to_s > 0 and from_s < horizon_s:
                place = -1 if pause.place is None else places[pause.place]
                found.append(Pause(name, max(from_s, 0.0), min(to_s, horizon_s), meeting, place))
    return tuple(sorted(found, key=lambda one: (one.start_s, natural_key(one.name))))


Spans = tuple[tuple[float, float], ...]


def at_least(n: int, several: Iterable[Spans]) -> Spans:
    """When at least n of several are there at once; n = 1: when any of them is."""
    found: list[tuple[float, float]] = []
    for start_s, end_s, n_there in _counted(several):
        if n_there >= n:
            if found and found[-1][1] == start_s:
                found[-1] = found[-1][0], end_s
            else:
                found.append((start_s, end_s))
    return tuple(found)


def either(*several: Spans) -> Spans:
    """When any of them is."""
    return at_least(1, several)


def both(one: Spans, other: Spans) -> Spans:
    """When both are."""
    return at_least(2, (one, other))


def without(one: Spans, other: Spans) -> Spans:
    """When the one is and the other is not."""
    found, number = [], 0
    for start_s, end_s in one:
        while number < len(other) and other[number][1] <= start_s:
            number += 1
        here = number
        while here < len(other) and other[here][0] < end_s:
            if start_s < other[here][0]:
                found.append((start_s, other[here][0]))
            start_s = other[here][1]
            here += 1
        if start_s < end_s:
            found.append((start_s, end_s))
    return tuple(found)


def total_s(spans: Spans) -> float:
    """How long all of them are together."""
    return sum(end_s - start_s for start_s, end_s in spans)


def together(several: Iterable[Spans]) -> Iterator[tuple[float, float, frozenset[int]]]:
    """(from_s, to_s, the numbers of those who are there) from each change to the next, where anybody is."""
    changes: dict[float, set[int]] = {}
    for number, spans in enumerate(several):
        for start_s, end_s in spans:
            for time_s in (start_s, end_s):
                changes.setdefault(time_s, set()).symmetric_difference_update({number})
    there: set[int] = set()
    times = sorted(changes)
    for start_s, end_s in pairwise(times):
        there ^= changes[start_s]
        if there:
            yield start_s, end_s, frozenset(there)


def _counted(several: Iterable[Spans]) -> Iterator[tuple[float, float, int]]:
    """(from_s, to_s, how many are there) from each change to the next."""
    changes: dict[float, int] = {}
    for spans in several:
        for start_s, end_s in spans:
            if start_s < end_s:
                changes[start_s] = changes.get(start_s, 0) + 1
                changes[end_s] = changes.get(end_s, 0) - 1
    n_there, times = 0, sorted(changes)
    for start_s, end_s in pairwise(times):
        n_there += changes[start_s]
        yield start_s, end_s, n_there
