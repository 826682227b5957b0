"""Ends of shifts: work that is left under way though others are there, and people whom nobody relieves."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Iterator

from opsim.clock import WEEK_S
from opsim.plan.calendar import Duty
from opsim.plan.hours import Hours
from opsim.plan.hours.spans import Spans
from opsim.plan.plan import Plan, TaskPlan
from opsim.plan.risks.words import SHORT_S, lasting, station_names, worker_names

RESUME, HAND_OVER = "resume", "hand_over"
LONG = 0.01
"""Share of a shift from which on it is worth a word that somebody works on after its end."""
WEEKS_S = 4 * WEEK_S
"""What is looked at: shifts come again."""


def left_under_way(plan: Plan, hours: Hours, by_hand: Collection[int]) -> Iterator[str]:
    """What the rule at the end of shifts does that is hardly meant, once for each shift."""
    ends = [
        (rank, duty, back_s)
        for rank, worker in enumerate(plan.workers)
        for duty, back_s in _ends(worker.duties or (), plan.horizon_s)
    ]
    for shift in range(len(plan.shifts)):
        mine = [end for end in ends if end[1].shift == shift]
        yield from _held(plan, hours, shift, mine, by_hand)
        yield from _not_relieved(plan, hours, shift, mine, by_hand)


def _ends(duties: tuple[Duty, ...], horizon_s: float) -> Iterator[tuple[Duty, float]]:
    """Shifts after which somebody is away, each with when he is back; the horizon where he is not in this run."""
    for duty, back_s in zip(duties, [*(duty.start_s for duty in duties[1:]), horizon_s]):
        if duty.end_s > WEEKS_S:
            return
        if not duty.cut and back_s - duty.end_s >= SHORT_S:
            yield duty, back_s


def _held(
    plan: Plan, hours: Hours, shift: int, ends: list[tuple[int, Duty, float]], by_hand: Collection[int]
) -> Iterator[str]:
    """Jobs that wait for who began them while others who could go on with them are there; the first time it is so."""
    for worker, duty, back_s in ends:
        others = {
            station: who
            for station in by_hand
            if _leaves_by(plan, hours, shift, station, worker, RESUME)
            and not any(station in crew.stations for crew in plan.crews)
            and (who := _there(plan, hours, station, worker, (duty.end_s, back_s)))
        }
        if others:
            able = worker_names(plan, set().union(*others.values()))
            name = plan.workers[worker].name
            away = f"away for {lasting(back_s - duty.end_s)}" if back_s < plan.horizon_s else "not back in this run"
            yield (
                f"what is under way when shift {plan.shifts[shift].name} ends waits at {station_names(plan, others)} "
                f"for who began it (rule resume), though {able} could go on with it: {name} is {away}; write "
                "hand_over, resume_any or finish"
            )
            return


def _not_relieved(
    plan: Plan, hours: Hours, shift: int, ends: list[tuple[int, Duty, float]], by_hand: Collection[int]
) -> Iterator[str]:
    """Stations where a shift is to hand over long work, and nobody comes before it is done."""
    longest: dict[int, float] = {}
    for worker, duty, _ in ends:
        for station in by_hand:
            if _leaves_by(plan, hours, shift, station, worker, HAND_OVER):
                seconds = _longest_s(plan, shift, station) / plan.workers[worker].rating[station]
                alone = not _there(plan, hours, station, worker, (duty.end_s, duty.end_s + seconds))
                if alone and seconds >= LONG * (duty.end_s - duty.start_s):
                    longest[station] = max(seconds, longest.get(station, 0.0))
    if longest:
        yield (
            f"nobody comes to whom shift {plan.shifts[shift].name} could hand over at its end, at "
            f"{station_names(plan, longest)}: who is at work there works on to the end of the task, which takes up to "
            f"{lasting(max(longest.values()))} on average"
        )


def _leaves_by(plan: Plan, hours: Hours, shift: int, station: int, worker: int, rule: str) -> bool:
    return worker in hours.able(station) and bool(_left(plan, shift, station, rule))


def _left(plan: Plan, shift: int, station: int, rule: str) -> list[TaskPlan]:
    """The tasks of a station that one person at a time does, and leaves at the end of a shift by some rule."""
    by_hand = [task for number in plan.stations[station].tasks if not (task := plan.tasks[number]).automatic]
    return [task for task in by_hand if task.team == 1 and (task.interruption or plan.shifts[shift].at_end) == rule]


def _longest_s(plan: Plan, shift: int, station: int) -> float:
    return max(task.mean_s() for task in _left(plan, shift, station, HAND_OVER))


def _there(plan: Plan, hours: Hours, station: int, worker: int, when: tuple[float, float]) -> set[int]:
    """Who else can work at a station, and is on shift while it is open at some time."""
    spans = [(max(a, when[0]), min(b, when[1])) for a, b in _meeting(hours.open(station), when)]
    others = hours.able(station) - {worker}
    return {other for other in others if any(_long_enough(hours.on_duty[other], span) for span in spans)}


def _meeting(spans: Spans, when: tuple[float, float]) -> Spans:
    """Those that some time meets."""
    first = max(0, bisect_right(spans, (when[0],)) - 1)
    return tuple(span for span in spans[first : bisect_right(spans, (when[1],))] if span[1] > when[0])


def _long_enough(spans: Spans, when: tuple[float, float]) -> bool:
    return any(min(b, when[1]) - max(a, when[0]) >= SHORT_S for a, b in _meeting(spans, when))
