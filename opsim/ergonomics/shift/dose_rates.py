"""How fast a worker gathers posture dose at a task: what a rule that evens out exposure can know before the shift."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np

from opsim.ergonomics.measures import has_body, measures_of
from opsim.ergonomics.neutral import neck_neutrals_rad
from opsim.ergonomics.scores.bounds import bounds_of
from opsim.ergonomics.scores.scoring import score
from opsim.plan import Plan

N_DRAWS = 16
"""Performances of the worker that are looked at: their mean RULA stands within 0.1 of the mean of many."""


class DoseRates:
    """Mean RULA, the least that it may be, a second of work; each (worker, task) is looked at when it is asked for.

    Times without a body, and tasks that the station does alone, have 0: what nobody has seen is no dose.
    """

    def __init__(self, plan: Plan, workforce: int):
        self._plan, self._workforce = plan, workforce
        self._found: dict[tuple[int, int], float] = {}
        self._neutral_rad: dict[str, float] | None = None

    def per_s(self, worker: int, task: int) -> float:
        """RULA x seconds of a second of work, by ranks."""
        if (worker, task) not in self._found:
            self._found[worker, task] = self._mean(worker, task)
        return self._found[worker, task]

    def _mean(self, worker: int, task: int) -> float:
        """Over performances of his own: stream ``dose, task, worker`` of the workforce."""
        from opsim.effects import worker_effect
        from opsim.one_thread import one_blas_thread
        from opsim.streams import stream

        plan, person, named = self._plan, self._plan.workers[worker], self._plan.tasks[task]
        if named.automatic or named.attended:
            return 0.0
        who = (person.name, plan.seed, self._workforce, person.body, plan.across_tasks)
        with one_blas_thread():
            effect = worker_effect(named.model, named.name, *who)
            rng = stream(plan.seed, self._workforce, "dose", named.name, person.name, 0)
            block = named.model.sample(N_DRAWS, rng, worker=effect)
            return self._mean_rula(block, named) if has_body(block) else 0.0

    def _mean_rula(self, block: Any, named: Any) -> float:
        """Weighted by time: each performance has as many parts as every other one, of its own length."""
        options = self._plan.ergonomics
        measures = measures_of(block, np.arange(N_DRAWS), options, self._neutral(named.name))
        n, parts, _ = measures.shape
        known = np.isfinite(measures).any(axis=2)
        rula = score(measures.reshape(n * parts, -1), bounds_of(named.handling), options).rula[:, 0].reshape(n, parts)
        weights = np.asarray(block.duration_s)[:, None] * known
        return float((rula * weights).sum() / weights.sum()) if weights.any() else 0.0

    def _neutral(self, task: str) -> float:
        if self._neutral_rad is None:
            self._neutral_rad = neck_neutrals_rad({one.name: one.model for one in self._plan.tasks})
        return self._neutral_rad[task]


_KEPT: deque[tuple[Plan, int, DoseRates]] = deque(maxlen=4)


def dose_rates_of(plan: Plan, workforce: int) -> DoseRates:
    """The rates of a plan and a workforce; those asked for last are kept, since all replications ask for the same."""
    for other, number, rates in _KEPT:
        if other is plan and number == workforce:
            return rates
    _KEPT.append((plan, workforce, DoseRates(plan, workforce)))
    return _KEPT[-1][2]
