"""What becomes of people as they work: each effect hangs in at a worker, and is asked where his next time is drawn."""

from __future__ import annotations

from collections.abc import Callable
from math import exp
from typing import Protocol

from opsim.engine.simpy_engine import human_clock, human_fatigue, human_learning, human_pace, human_rest
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.state import Station, Worker
from opsim.human.memory import Memory
from opsim.human.tired import Tired

Effect = Callable[[Floor, Worker, Station, int, int], float]
"""Of a worker's k-th performance of a task at a station, which begins now: a factor, or a shift of its log time."""


class Told(Protocol):
    """Who is told what a worker does. Between he rests: he waits, walks, has a break or is off."""

    def works(self, now: float, task: int, until_s: float) -> None: ...
    def stops(self, now: float) -> None: ...


class Human:
    """The effects on one worker.

    shifts  : of log time; posture follows them, where they act on it (``pace_shift``), else they are factors
    factors : of time alone
    told    : who is told when he works, and when he is broken off
    tired   : his fatigue, where people tire: told first, and with where in his task he begins
    memory  : what he has not forgotten, where people forget: told which performance it is
    """

    __slots__ = ("factors", "memory", "on_posture", "shifts", "tired", "told", "worker")

    def __init__(self, worker: Worker, on_posture: bool):
        self.worker, self.on_posture = worker, on_posture
        self.shifts: list[Effect] = []
        self.factors: list[Effect] = []
        self.told: list[Told] = []
        self.tired: Tired | None = None
        self.memory: Memory | None = None

    def drawn(self, floor: Floor, station: Station, task: int, k: int, drawn_s: float) -> float:
        """His own next time as it is now; neutral effects leave its bits alone."""
        worker, shift = self.worker, 0.0
        for effect in self.shifts:
            shift += effect(floor, worker, station, task, k)
        for effect in self.factors:
            drawn_s *= effect(floor, worker, station, task, k)
        worker.pace_shift = shift if self.on_posture else 0.0
        return drawn_s * exp(shift)

    def level(self, now: float) -> float:
        """How tired he is, 0 (fresh, or where nobody tires) to 1."""
        return 0.0 if self.tired is None else self.tired.level_at(now)

    def works(self, now: float, task: int, until_s: float, done: float = 0.0, k: int = -1) -> None:
        """He works on his k-th of a task from now, ``done`` of which is done, until then if nothing comes between."""
        if self.tired is not None:
            self.tired.works(now, task, until_s, done)
        if self.memory is not None:
            self.memory.works(now, task, k, until_s)
        for told in self.told:
            told.works(now, task, until_s)

    def stops(self, now: float) -> None:
        """What he worked on is broken off, or waits for something."""
        if self.tired is not None:
            self.tired.stops(now)
        if self.memory is not None:
            self.memory.stops(now)
        for told in self.told:
            told.stops(now)


INSTALL: tuple[Callable[[Floor], None], ...] = (
    human_clock.install,
    human_pace.install,
    human_fatigue.install,
    human_rest.install,
    human_learning.install,
)
"""Each looks whether its effect is on, and hangs it on ``floor.humans``."""


def install(floor: Floor) -> None:
    """A human side for every worker, where any effect is on."""
    plan = floor.plan.human
    if not plan.any:
        return
    floor.humans = tuple(Human(worker, plan.acts_on == "posture") for worker in floor.workers)
    for worker, human in zip(floor.workers, floor.humans):
        worker.human = human
    for effect in INSTALL:
        effect(floor)


HANDLERS: dict[str, Handler] = human_rest.HANDLERS
