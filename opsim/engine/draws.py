"""All luck of a replication, by name: durations, gaps between arrivals, product mix."""

from collections.abc import Callable, Iterator
from functools import cache, partial
from itertools import accumulate

import numpy as np

from opsim.plan import Plan
from opsim.streams import BLOCK, Items, Scattered
from opsim.subjects.release.plan import ANY, order_of
from opsim.subjects.tools.plan import HoldPlan, Moment
from opsim.task_model import TaskModel, seconds_of
from opsim.threads import one_blas_thread

Held = tuple[float, float, float]
"""Seconds of a performance, and the shares of it from which to which a tool is held."""


def _performed(model, effect):
    """How a block of durations is drawn from a task model."""
    at = getattr(model, "at", None) if getattr(model, "by_index", False) else None
    if at is not None:
        return lambda _rng, block: seconds_of(model, at(np.arange(block * BLOCK, (block + 1) * BLOCK))).tolist()
    return lambda rng, _block: seconds_of(model, model.sample(BLOCK, rng, worker=effect).duration_s).tolist()


def _held(hold: HoldPlan, model, effect):
    """How a block of durations with two moments of each is drawn: as ``_performed`` draws, from the same numbers."""
    if getattr(model, "by_index", False):
        at, start, end = _performed(model, effect), hold.start.share, hold.end.share
        return lambda rng, block: [(duration_s, start, end) for duration_s in at(rng, block)]

    def draw(rng, _block: int) -> list[Held]:
        drawn = model.sample(BLOCK, rng, worker=effect)
        start = _shares(drawn, hold.start)
        end = np.maximum(start, _shares(drawn, hold.end))
        return list(zip(seconds_of(model, drawn.duration_s).tolist(), start.tolist(), end.tolist()))

    return draw


def _shares(drawn, moment: Moment) -> np.ndarray:
    """(BLOCK,) where a moment lies in each performance, as a share of its duration."""
    if moment.mark < 0:
        return np.full(BLOCK, moment.share)
    return np.clip(np.asarray(drawn.mark_s)[:, moment.mark] / drawn.duration_s, 0.0, 1.0)


class Draws:
    """Looks up item after item of the named streams of one replication."""

    def __init__(self, plan: Plan, replication: int):
        self._plan, self._replication = plan, replication
        self._workforce = self.workforce = plan.workforce_of(replication)
        self._durations: dict[tuple[int, int], Items] = {}
        self._chances: dict[tuple[str | int, ...], Scattered] = {}

    def duration_s(self, task: int, worker: int, k: int) -> float:
        """The k-th performance of a task by a worker, at skill rating 1."""
        items = self._durations.get((task, worker))
        if items is None:
            items = self._durations[task, worker] = self._of_worker(task, worker)
        return items[k]

    def durations(self, task: int, worker: int) -> Iterator[float]:
        """All performances of a task by a worker, one after the other: ``duration_s`` at k = 0, 1, 2, ..."""
        return iter(self._of_worker(task, worker))

    def durations_with(self, hold: HoldPlan, task: int, worker: int) -> Iterator[Held]:
        """``durations``, each with the moments between which a tool is held."""
        return iter(self._of_worker(task, worker, partial(_held, hold)))

    def runs_with(self, hold: HoldPlan, task: int, station: int) -> Iterator[Held]:
        """``automatic_runs``, each with the moments between which a tool is held."""
        name = ("automatic", self._plan.tasks[task].name, self._plan.stations[station].name)
        return iter(self._items(name, _held(hold, self._plan.tasks[task].model, None)))

    def automatic_runs(self, task: int, station: int) -> Iterator[float]:
        """All automatic runs of a task at a station, one after the other."""
        name = ("automatic", self._plan.tasks[task].name, self._plan.stations[station].name)
        return self.times(name, self._plan.tasks[task].model)

    def gaps(self, source: int) -> Iterator[float]:
        """All gaps between the arrivals of a source, one after the other."""
        plan = self._plan.sources[source]
        gap = _exponential(plan.every_s) if plan.gap is None else _performed(plan.gap, None)
        return iter(self._items(("interarrival", plan.name), gap))

    def products(self, source: int) -> Callable[[int], int]:
        """The rank of the product that the n-th job of a source is, by n."""
        plan = self._plan.sources[source]
        if plan.sequence:
            return lambda n: plan.sequence[n % len(plan.sequence)]
        ranks = [rank for rank, _ in plan.mix]
        cumulative = list(accumulate(share for _, share in plan.mix))[:-1]
        if plan.orders and plan.orders[0].product != ANY:
            return lambda n: order_of(plan.orders, n).product
        if not cumulative:
            return lambda _n: ranks[0]
        drawn = self._items(("mix", plan.name), _ranks(cumulative))
        return lambda n: ranks[drawn[n]]

    def way(self, operation: str, visit: int, source: int, n: int) -> float:
        """A number in [0, 1) that decides where a job goes after an operation it leaves for the ``visit``-th time."""
        return self.chance(("routing", operation, self._plan.sources[source].name, visit), n)

    def chance(self, name: tuple[str | int, ...], item: int) -> float:
        """The number in [0, 1) of an item of a named stream."""
        chances = self._chances.get(name)
        if chances is None:
            chances = self._chances[name] = Scattered(self._items(name, _uniform))
        return chances[item]

    def times(self, name: tuple[str, ...], model: TaskModel) -> Iterator[float]:
        """Durations of a model under the name of a stream, one after the other, without end."""
        return iter(self._items(name, _performed(model, None)))

    def _of_worker(self, task: int, worker: int, drawn: Callable = _performed) -> Items:
        plan, name = self._plan.tasks[task], self._plan.workers[worker].name
        with one_blas_thread():
            effect = self._plan.worker_effect(worker, plan, workforce=self._workforce)
        return self._items(("duration", plan.stream_name, name), drawn(plan.model, effect))

    def _items(self, name, draw) -> Items:
        return Items(self._plan.seed, self._replication, name, _on_one_thread(draw))


def _on_one_thread(draw):
    """The same draw, whoever asks for it: in somebody's own model nothing around it sees to that."""

    def drawn(rng, block):
        with one_blas_thread():
            return draw(rng, block)

    return drawn


@cache
def _exponential(mean_s: float):
    return lambda rng, _block: rng.exponential(mean_s, BLOCK).tolist()


def _ranks(cumulative: list[float]):
    """How a block of ranks is drawn: rank i with probability cumulative[i] - cumulative[i - 1]."""
    return lambda rng, _block: np.searchsorted(cumulative, rng.random(BLOCK), side="right").tolist()


def _uniform(rng: np.random.Generator, _block: int) -> list[float]:
    return rng.random(BLOCK).tolist()
