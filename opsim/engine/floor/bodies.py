"""What is asked about bodies in a run: how fast they gather dose."""

from __future__ import annotations

from collections.abc import Callable
from math import nan
from typing import Any


class Bodies:
    """Of a floor that is set up. What was asked stays known until a replication has other people.

    rates : by worker, then task; NaN where nobody has asked
    """

    def __init__(self, build: Any):
        self.plan = build.plan
        self.rates = [[nan] * len(build.plan.tasks) for _ in build.plan.workers]
        self._orders: dict[int, list[int]] = {}
        self._workforce: int | None = None

    def begin(self, floor: Any) -> None:
        """A replication begins."""
        if floor.draws.workforce != self._workforce:
            self._workforce = floor.draws.workforce
            self._orders.clear()
            for row in self.rates:
                row[:] = [nan] * len(row)

    def rates_of(self, worker: int) -> list[float]:
        """A worker's row."""
        return self.rates[worker]

    def asks(self, answer: Callable[[int, Any], None]) -> Callable[[int, Any], None]:
        """What a floor can call."""
        return answer

    def answer_rate(self, worker: int, task: int) -> None:
        """How fast a worker gathers dose at a task."""
        self.rates[worker][task] = self._rates().per_s(worker, task)

    def answer_order(self, rotation: int, into: list[int]) -> None:
        """The posts of a rotation, the heaviest first, where the rules want them."""
        from opsim.engine.heaviest_first import heaviest_first

        if rotation not in self._orders:
            plan = self.plan.rotations[rotation]
            self._orders[rotation] = heaviest_first(self.plan, self._rates(), plan.posts, plan.workers)
        into[:] = self._orders[rotation]

    def _rates(self) -> Any:
        from opsim.ergonomics.shift.dose_rates import dose_rates_of

        return dose_rates_of(self.plan, self._workforce or 0)


def bodies_of(build: Any) -> Bodies:
    """The one of a floor."""
    for one in build.answers:
        if isinstance(one, Bodies):
            return one
    build.answers.append(Bodies(build))
    found: Bodies = build.answers[-1]
    return found
