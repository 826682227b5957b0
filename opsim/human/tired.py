"""Fatigue of one worker through time: told when he works and when he is broken off, he rests between."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class Tired:
    """model : one of ``opsim.human`` with fresh, passed, rested, level; burden_of : what it asks of a task, by rank.

    Time goes forward only. Engine and replay ask the same questions of the same code.
    """

    __slots__ = ("_begun_s", "_burden_of", "_done", "_task", "_until_s", "at_s", "burdens", "model", "state")

    def __init__(self, model: Any, burden_of: Callable[[int], Any]):
        self.model, self._burden_of = model, burden_of
        self.state = model.fresh()
        self.at_s = 0.0
        self.burdens: dict[int, Any] = {}
        self._task, self._begun_s, self._until_s, self._done = -1, 0.0, 0.0, 0.0

    def works(self, now: float, task: int, until_s: float, done: float = 0.0) -> None:
        """He works on a task from now, at share ``done`` of it, until it is done then."""
        if now > self.at_s:
            self.pass_to(now)
        self._task, self._begun_s, self._until_s, self._done = task, now, until_s, done

    def is_at(self, task: int, begun_s: float, until_s: float, done: float) -> None:
        """He works on a task (-1: none) since some time, begun at share ``done`` of it, until it is done then."""
        self._task, self._begun_s, self._until_s, self._done = task, begun_s, until_s, done

    def stops(self, now: float) -> None:
        """He works no more."""
        self.pass_to(now)
        self._task = -1

    def level_at(self, now: float) -> float:
        """0 (fresh) to 1."""
        self.pass_to(now)
        return float(self.model.level(self.state))

    def pass_to(self, now: float) -> None:
        """Time goes on until now."""
        at_s = self.at_s
        if now <= at_s:
            return
        self.at_s, task = now, self._task
        if task < 0:
            self.state = self.model.rested(self.state, now - at_s)
            return
        first, last, work_s, rest_s = piece(at_s, now, self._begun_s, self._until_s, self._done)
        if now >= self._until_s:
            self._task = -1
        if task in self.burdens:
            burden = self.burdens[task]
        else:
            burden = self.burdens[task] = self._burden_of(task)
        self.state = self.model.passed(self.state, burden, first, last, work_s, rest_s)


def piece(at_s: float, now: float, begun_s: float, until_s: float, done: float) -> tuple[float, float, float, float]:
    """What passes from a time until now of a performance that was begun at share ``done``, and goes on until then: from
    which share of it to which, how many seconds of work, and how many of rest after its end.
    """
    to_s, rest_s = now, 0.0
    if now >= until_s:
        to_s, rest_s = until_s, now - until_s
    if done == 0.0 and at_s == begun_s and to_s == until_s:  # NOTE: a whole performance, most often
        return 0.0, 1.0, to_s - at_s, rest_s
    a_second = (1.0 - done) / (until_s - begun_s)
    return done + a_second * (at_s - begun_s), min(1.0, done + a_second * (to_s - begun_s)), to_s - at_s, rest_s


def tired(model: Any, burdens: Any, worker: int) -> Tired:
    """A worker who is fresh at 0; ``burdens``: a ``Burdens`` of his plan."""
    if not model.needs_burden:
        return Tired(model, lambda _task: 1.0)
    if hasattr(model, "by"):
        return Tired(model, lambda task: burdens.heaviness(worker, task))
    return Tired(model, lambda task: model.felt(burdens.course(worker, task)))
