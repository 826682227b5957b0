"""How often a job comes to each step of its product on average: rework and scrap included."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from typing import NamedTuple

from opsim.plan.material import ProductPlan
from opsim.plan.plan import Plan
from opsim.plan.quality import NOWHERE, QualityPlan

MOST_REWORKS = 8
"""Reworks of a job that are told apart; where more are allowed there is no limit."""
GONE = -1


class State(NamedTuple):
    """Where a job is: at a step, with a defect or without, sent back so many times."""

    step: int
    bad: bool
    reworks: int


def visits_of(plan: Plan, product: int) -> tuple[float, ...]:
    """(steps,) mean visits of a job of a product to each step of its route."""
    made = plan.products[product]
    touched = {station for operation in made.route for station in operation.stations}
    quality = {one.station: one for one in plan.quality if one.station in touched}
    ends = {one.station for one in plan.splits if one.product == product}
    if not quality and not ends:
        return made.visits()
    return _solved(made, product, quality, ends)


def _solved(made: ProductPlan, product: int, quality: dict[int, QualityPlan], ends: set[int]) -> tuple[float, ...]:
    """The traffic equations v = start + P' v over the states of a job (Jackson 1957)."""
    import numpy as np

    limits = [one.most for one in quality.values() if one.most < inf]
    most = min(int(max(limits)), MOST_REWORKS) if limits else 0
    n_steps, depth = len(made.route), most + 1
    size = 2 * n_steps * depth
    onward, begin = np.zeros((size, size)), np.zeros(size)

    def number(state: State) -> int:
        return (state.step * 2 + state.bad) * depth + min(state.reworks, most)

    for step, share in _shares(made.start):
        begin[number(State(step, False, 0))] += share
    for state in (State(s, b, r) for s in range(n_steps) for b in (False, True) for r in range(depth)):
        for share, other in _onward(state, made, product, quality, ends):
            onward[number(state), number(other)] += share
    visits = np.linalg.solve(np.eye(size) - onward.T, begin)
    return tuple(visits.reshape(n_steps, 2 * depth).sum(axis=1).tolist())


def _onward(
    state: State, made: ProductPlan, product: int, quality: dict[int, QualityPlan], ends: set[int]
) -> Iterator[tuple[float, State]]:
    """(probability, next state) of a job whose work at a step is done; the stations of a step share its visits."""
    stations = made.route[state.step].stations
    for station in stations:
        for share, bad, sent_back in _looked_at(state.bad, quality.get(station)):
            part = share / len(stations)
            if sent_back:
                back = _back(quality[station], product, state)
                if back != NOWHERE:
                    yield part, State(back, False, state.reworks + 1)
            elif station not in ends:
                yield from ((part * p, State(step, bad, state.reworks)) for step, p in _shares(made.onward[state.step]))


def _looked_at(bad: bool, quality: QualityPlan | None) -> Iterator[tuple[float, bool, bool]]:
    """(probability, has a defect, is held to be bad) after the work at a station."""
    if quality is None:
        yield 1.0, bad, False
        return
    for share, now_bad in ((1.0, True),) if bad else ((quality.yield_share, False), (1 - quality.yield_share, True)):
        rejected = (quality.finds if now_bad else quality.false_alarms) if quality.inspects else 0.0
        yield share * rejected, now_bad, True
        yield share * (1 - rejected), now_bad, False


def _back(quality: QualityPlan, product: int, state: State) -> int:
    """The step that a job is sent back to; ``NOWHERE``: it is scrapped."""
    return quality.back[product][state.step] if quality.back and state.reworks < quality.most else NOWHERE


def _shares(ways) -> Iterator[tuple[int, float]]:
    """(step, probability) of each way on that stays on the floor."""
    before = 0.0
    for cumulative, step in ways:
        if step >= 0:
            yield step, cumulative - before
        before = cumulative
