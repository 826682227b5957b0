"""Numbers of named streams: the next of one, or a certain one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from opsim.engine.draws import Draws
from opsim.plan import Plan

DURATION, AUTOMATIC, GAP, MIX, REPAIR, UPTIME, ROUTING, START, YIELD, QUALITY, ABSENCE, HOLD, HOLD_RUN = range(1, 14)
"""Purposes of streams, each of up to three ranks."""
Named = Callable[[Draws, Plan, int, int, int], Any]


class Luck:
    """A stream. next : gives one number after the other; at : gives a certain one."""

    __slots__ = ("at", "next")

    def __init__(self, numbers: Any):
        self.next, self.at = getattr(numbers, "__next__", None), numbers


def _chance(word: str) -> Named:
    """Of (operation, source, visit)."""
    return lambda draws, plan, operation, source, visit: _at(
        draws, (word, plan.operations[operation], plan.sources[source].name, visit)
    )


def _at(draws: Draws, name: tuple[str | int, ...]) -> Callable[[int], float]:
    return lambda item: draws.chance(name, item)


def _hold(plan: Plan, task: int) -> Any:
    """The hold of a task that has one."""
    return plan.tasks[task].hold


def _stop_name(plan: Plan, stop: Any) -> tuple[str, str]:
    station = plan.stations[stop.station].name
    return station, stop.name.removeprefix(f"{station}: ")


NAMED: dict[int, Named] = {
    DURATION: lambda draws, _plan, worker, task, _: draws.durations(task, worker),
    AUTOMATIC: lambda draws, _plan, station, task, _: draws.automatic_runs(task, station),
    HOLD: lambda draws, plan, worker, task, _: draws.durations_with(_hold(plan, task), task, worker),
    HOLD_RUN: lambda draws, plan, station, task, _: draws.runs_with(_hold(plan, task), task, station),
    GAP: lambda draws, _plan, source, *_: draws.gaps(source),
    MIX: lambda draws, _plan, source, *_: draws.products(source),
    REPAIR: lambda draws, plan, stop, *_: draws.times(
        ("repair", *_stop_name(plan, plan.stops[stop])), plan.tasks[plan.stops[stop].task].model
    ),
    UPTIME: lambda draws, plan, stop, *_: draws.times(
        ("uptime", *_stop_name(plan, plan.breakdowns[stop])), plan.breakdowns[stop].every
    ),
    ROUTING: _chance("routing"),
    YIELD: _chance("yield"),
    QUALITY: _chance("quality"),
    START: lambda draws, _plan, source, *_: lambda n: draws.way("start", 0, source, n),
    ABSENCE: lambda draws, plan, worker, *_: _at(draws, ("absence", plan.workers[worker].name)),
}
"""By purpose, the stream of up to three ranks."""


def stream_of(floor: Any, purpose: int, one: int, two: int, three: int) -> Any:
    """A stream from its beginning."""
    return Luck(NAMED[purpose](floor.draws, floor.plan, one, two, three))


class Planned(Luck):
    """A stream that a floor has before it runs: each replication has its own numbers."""

    __slots__ = ("purpose", "rank")

    def __init__(self, purpose: int, rank: int):
        super().__init__(None)
        self.purpose, self.rank = purpose, rank

    def begin(self, floor: Any) -> None:
        """A replication begins."""
        super().__init__(NAMED[self.purpose](floor.draws, floor.plan, self.rank, 0, 0))


def planned(build: Any, purpose: int, rank: int) -> Planned:
    """A stream from its beginning, of a floor that is being set up."""
    made = Planned(purpose, rank)
    build.answers.append(made)
    return made


def next_number(_floor: Any, luck: Any) -> Any:
    """The next one of a stream whose numbers come one after the other."""
    return luck.next()


def number_at(_floor: Any, luck: Any, item: int) -> Any:
    """A certain one of a stream that is asked in no order."""
    return luck.at(item)


def next_held(floor: Any, luck: Any) -> Any:
    """The next duration of a stream; the shares between which the tool is held are in ``floor.holds``."""
    duration_s, floor.holds.start, floor.holds.end = luck.next()
    return duration_s
