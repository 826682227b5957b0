"""All streams of a replication, by name: those of ``engine/draws.py``, in arrays of many blocks.

What the replications of a Plan have in common is found once, for a sweep asks a thousand times.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import accumulate
from threading import Lock
from typing import Any

import numpy as np

from opsim.engine.fast_engine.streams.blocks import (
    Drawn,
    DrawnHeld,
    HeldStream,
    Stream,
    drawn_ranks,
    durations,
    exponentials,
    held,
    is_ours,
    ranks_by_number,
    uniforms,
)
from opsim.plan import Plan
from opsim.streams import _hashed, _words
from opsim.subjects.breakdowns.plan import BreakdownPlan, MaintenancePlan
from opsim.subjects.release.plan import ANY
from opsim.subjects.tools.plan import HoldPlan
from opsim.task_model import TaskModel

_KEPT = 4
_last: list[LuckOfPlan] = []
_lock = Lock()


def luck_of(plan: Plan) -> LuckOfPlan:
    """What the replications of a Plan share; that of the last few Plans is kept. NOTE: the same object, not an equal
    one: to compare two Plans costs more than to begin anew."""
    with _lock:
        for one in _last:
            if one.plan is plan:
                return one
        _last.insert(0, LuckOfPlan(plan))
        del _last[_KEPT:]
        return _last[0]


class LuckOfPlan:
    """Names as words, and how each kind of stream is drawn.

    NOTE: threads may find the same thing twice, and it is the same: nothing here is changed once found.
    """

    def __init__(self, plan: Plan):
        self.plan = plan
        self._seed = _words(plan.seed, 4)
        self._named: dict[tuple[str | int, ...], bytes] = {}
        self._drawn: dict[Any, Any] = {}

    def begun(self, replication: int) -> bytes:
        """What the keys of all streams of a replication begin with: as ``opsim.streams._key``."""
        return self._seed + _words(replication, 1)

    def of_worker(self, task: int, worker: int, workforce: int) -> Drawn:
        """Durations of a task by a worker."""
        model = self.plan.tasks[task].model
        return self._of_people(
            (task, worker, workforce), model, lambda: durations(model, self._effect(task, worker, workforce))
        )

    def held_by_worker(self, hold: HoldPlan, task: int, worker: int, workforce: int) -> DrawnHeld:
        """Durations of a task by a worker, with the moments between which a tool is held."""
        model = self.plan.tasks[task].model
        return self._of_people(
            (hold, task, worker, workforce), model, lambda: held(hold, model, self._effect(task, worker, workforce))
        )

    def held_by_station(self, hold: HoldPlan, task: int) -> DrawnHeld:
        """Automatic runs of a task, with the moments between which a tool is held."""
        return self._kept((hold, task), lambda: held(hold, self.plan.tasks[task].model, None))

    def of_model(self, model: Any) -> Drawn:
        """Durations by nobody. NOTE: the model is kept too, so that no other can have its id."""
        return self._kept(("model", id(model)), lambda: (model, durations(model, None)))[1]

    def of_gaps(self, source: int) -> Drawn:
        """Gaps between the arrivals of a source."""
        plan = self.plan.sources[source]
        if plan.gap is not None:
            return self.of_model(plan.gap)
        return self._kept(("gaps", source), lambda: exponentials(plan.every_s))

    def of_products(self, source: int) -> Drawn:
        """Ranks of the products that the jobs of a source are."""
        return self._kept(("products", source), lambda: _products(self.plan.sources[source]))

    def name(self, name: tuple[str | int, ...]) -> bytes:
        """What follows in the key of a stream."""
        words = self._named.get(name)
        if words is None:
            words = self._named[name] = b"".join(map(_hashed, name))
        return words

    def _effect(self, task: int, worker: int, workforce: int) -> Any:
        return self.plan.worker_effect(worker, self.plan.tasks[task], workforce=workforce)

    def _of_people(self, what: tuple, model: Any, make: Callable[[], Any]) -> Any:
        """As ``_kept``, but people of one replication alone, and effects that a plug-in may change, are made anew."""
        redrawn = self.plan.workforce is None and self.plan.staffing == "redrawn"
        return make() if redrawn or not is_ours(model) else self._kept(what, make)

    def _kept(self, what: tuple, make: Callable[[], Any]) -> Any:
        found = self._drawn.get(what)
        if found is None:
            found = self._drawn[what] = make()
        return found


def _products(source: Any) -> Drawn:
    """As ``Draws.products``: in a sequence, by orders, the only one, or drawn from the mix."""
    ranks = [rank for rank, _ in source.mix]
    cumulative = list(accumulate(share for _, share in source.mix))[:-1]
    if source.sequence:
        sequence = np.array(source.sequence, np.int64)
        return ranks_by_number(lambda k: sequence[k % len(sequence)])
    if source.orders and source.orders[0].product != ANY:
        return ranks_by_number(_ordered(source.orders))
    if not cumulative:
        return ranks_by_number(lambda k: np.full(len(k), ranks[0], np.int64))
    return drawn_ranks(ranks, cumulative)


def _ordered(orders: tuple) -> Callable[[np.ndarray], np.ndarray]:
    """As ``release.plan.order_of``, of many jobs: the last order that begins at a job or before, or the first."""
    firsts = np.array([order.first for order in orders], np.int64)
    products = np.array([order.product for order in orders], np.int64)
    return lambda k: products[np.maximum(np.searchsorted(firsts, k, side="right") - 1, 0)]


class BlockDraws:
    """The named streams of one replication. To make one costs a few us, as does each stream."""

    __slots__ = ("_luck", "_plan", "begun", "workforce")

    def __init__(self, plan: Plan, replication: int):
        self._plan, self._luck = plan, luck_of(plan)
        self.begun = self._luck.begun(replication)
        self.workforce = plan.workforce_of(replication)

    def durations(self, task: int, worker: int) -> Stream:
        """All performances of a task by a worker, at skill rating 1."""
        return Stream(self._key(self._of_worker(task, worker)), self._luck.of_worker(task, worker, self.workforce))

    def durations_with(self, hold: HoldPlan, task: int, worker: int) -> HeldStream:
        """``durations``, each with the moments between which a tool is held."""
        drawn = self._luck.held_by_worker(hold, task, worker, self.workforce)
        return HeldStream(self._key(self._of_worker(task, worker)), drawn)

    def automatic_runs(self, task: int, station: int) -> Stream:
        """All automatic runs of a task at a station."""
        return Stream(self._key(self._at_station(task, station)), self._luck.of_model(self._plan.tasks[task].model))

    def runs_with(self, hold: HoldPlan, task: int, station: int) -> HeldStream:
        """``automatic_runs``, each with the moments between which a tool is held."""
        return HeldStream(self._key(self._at_station(task, station)), self._luck.held_by_station(hold, task))

    def gaps(self, source: int) -> Stream:
        """All gaps between the arrivals of a source."""
        return Stream(self._key(("interarrival", self._plan.sources[source].name)), self._luck.of_gaps(source))

    def products(self, source: int) -> Stream:
        """The ranks of the products that the jobs of a source are, int64."""
        return Stream(self._key(("mix", self._plan.sources[source].name)), self._luck.of_products(source))

    def repairs(self, stop: BreakdownPlan | MaintenancePlan) -> Stream:
        """How long each stop lasts."""
        return self.times(("repair", *self._stopped(stop)), self._plan.tasks[stop.task].model)

    def uptimes(self, stop: BreakdownPlan) -> Stream:
        """What lies between one breakdown and the next: seconds or cycles."""
        return self.times(("uptime", *self._stopped(stop)), stop.every)

    def ways(self, operation: str, visit: int, source: int) -> Stream:
        """In [0, 1): where the jobs of a source go after an operation they leave for the ``visit``-th time."""
        return self.chances(("routing", operation, self._plan.sources[source].name, visit))

    def chances(self, name: tuple[str | int, ...]) -> Stream:
        """In [0, 1), by the parts of a name."""
        return Stream(self._key(name), uniforms)

    def times(self, name: tuple[str | int, ...], model: TaskModel) -> Stream:
        """Durations of one of the Plan's models under the name of a stream."""
        return Stream(self._key(name), self._luck.of_model(model))

    def _key(self, name: tuple[str | int, ...]) -> bytes:
        return self.begun + self._luck.name(name)

    def _of_worker(self, task: int, worker: int) -> tuple[str, ...]:
        return "duration", self._plan.tasks[task].stream_name, self._plan.workers[worker].name

    def _at_station(self, task: int, station: int) -> tuple[str, ...]:
        return "automatic", self._plan.tasks[task].name, self._plan.stations[station].name

    def _stopped(self, stop: BreakdownPlan | MaintenancePlan) -> tuple[str, str]:
        """The names of a station and of one of its stops, as parts of the name of a stream."""
        station = self._plan.stations[stop.station].name
        return station, stop.name.removeprefix(f"{station}: ")


class Whole:
    """n : so many numbers; in room that doubles, so that those before are seldom copied."""

    def __init__(self) -> None:
        self._room, self.n = np.empty(0), 0

    @property
    def numbers(self) -> np.ndarray:
        """(n,) NOTE: of the room at hand; whoever was given an earlier one keeps that."""
        return self._room[: self.n]

    def add(self, more: np.ndarray) -> None:
        """Numbers that follow."""
        n = self.n + more.size
        if n > self._room.size:
            room = np.empty(max(n, 2 * self._room.size))
            room[: self.n] = self.numbers
            self._room = room
        self._room[self.n : n] = more
        self.n = n
