"""What Python is asked about bodies in a run: how heavy tasks are on people, and how fast they gather dose.

Both are looked at when they are asked for, as in the reference engine: by draws of task models, which are Python's.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np

from opsim.engine.fast_engine.interrupts import handled
from opsim.engine.fast_engine.machine.arena import MORE
from opsim.engine.fast_engine.settle import NO_LUCK

UNKNOWN = -1
"""The address of a course that nobody has asked for yet."""


class Bodies:
    """Of a floor that is set up. What was asked stays known until a replication has other people, or an answer fails.

    heaviness, rates, courses : (workers, tasks), NaN or UNKNOWN where nobody has asked; the engine reads them in place
    """

    def __init__(self, build: Any):
        self.plan, self.floor = build.plan, build.floor
        shape = len(build.plan.workers), len(build.plan.tasks)
        self.heaviness, self.rates = np.full(shape, np.nan), np.full(shape, np.nan)
        self.courses = np.full(shape, UNKNOWN, dtype=np.int64)
        self._kept: list[np.ndarray] = []
        self._orders: dict[int, list[int]] = {}
        self._workforce: int | None = None
        self._numbers: Any = None
        self._callbacks: list[Any] = []
        self._spoilt = False

    def begin(self, numbers: Any) -> None:
        """A replication begins; ``numbers`` : those of it, which are told where something fails."""
        self._numbers = numbers
        if self._spoilt or numbers.draws.workforce != self._workforce:
            self._spoilt, self._workforce = False, numbers.draws.workforce
            self._forget()

    def _forget(self) -> None:
        from opsim.human.burden import Burdens

        self.heaviness[:] = self.rates[:] = np.nan
        self.courses[:] = UNKNOWN
        self._kept.clear()
        self._orders.clear()
        self._burdens = Burdens(self.plan, self._workforce or 0)

    def heaviness_of(self, worker: int) -> int:
        """The address of a worker's row."""
        return int(self.heaviness[worker].ctypes.data)

    def rates_of(self, worker: int) -> int:
        """The address of a worker's row."""
        return int(self.rates[worker].ctypes.data)

    def courses_of(self, worker: int) -> int:
        """The address of a worker's row."""
        return int(self.courses[worker].ctypes.data)

    def asks(self, answer: Callable[[int, int], None]) -> int:
        """The address of a function of two numbers that the engine can call."""

        def asked(one: int, other: int) -> int:
            try:
                handled(answer, one, other)
            except BaseException as error:  # NOTE: nothing may be raised through compiled code
                self._spoilt = True  # what the engine goes on with until it ends is no answer
                self._numbers.failed, self.floor.error = error, NO_LUCK
            return 0

        self._callbacks.append(MORE(asked))
        return int(ctypes.cast(self._callbacks[-1], ctypes.c_void_p).value or 0)

    def answer_heaviness(self, worker: int, task: int) -> None:
        """How heavy a task is for a worker, beside the others."""
        self.heaviness[worker, task] = 1.0
        self.heaviness[worker, task] = self._burdens.heaviness(worker, task)

    def answer_course(self, worker: int, task: int) -> None:
        """The loads on a worker's joints in a task, as his muscles feel them."""
        self.courses[worker, task] = 0
        felt = self.plan.human.fatigue.felt(self._burdens.course(worker, task))
        if felt is not None:
            self._kept.append(np.ascontiguousarray(felt, dtype=np.float64))
            self.courses[worker, task] = self._kept[-1].ctypes.data

    def answer_rate(self, worker: int, task: int) -> None:
        """How fast a worker gathers dose at a task."""
        self.rates[worker, task] = 0.0
        self.rates[worker, task] = self._rates().per_s(worker, task)

    def answer_order(self, rotation: int, address: int) -> None:
        """The posts of a rotation, the heaviest first, where the engine wants them."""
        posts = self.plan.rotations[rotation].posts
        into: Any = (ctypes.c_int64 * len(posts)).from_address(address)
        into[:] = range(len(posts))
        if rotation not in self._orders:
            self._orders[rotation] = self._heaviest_first(rotation)
        into[:] = self._orders[rotation]

    def _heaviest_first(self, rotation: int) -> list[int]:
        from opsim.engine.heaviest_first import heaviest_first

        plan = self.plan.rotations[rotation]
        return heaviest_first(self.plan, self._rates(), plan.posts, plan.workers)

    def _rates(self) -> Any:
        from opsim.ergonomics.shift.dose_rates import dose_rates_of

        return dose_rates_of(self.plan, self._workforce or 0)


def bodies_of(build: Any) -> Bodies:
    """The one of a floor."""
    for one in build.answers:
        if isinstance(one, Bodies):
            return one
    build.answers.append(Bodies(build))
    return build.answers[-1]
