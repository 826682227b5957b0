"""How often a job comes to each step of its product on average: rework and scrap included.

How many jobs of each product come in: by the sources, by what they are part of, by what is split into them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf
from typing import NamedTuple

from opsim.plan.plan import Plan
from opsim.subjects.quality.plan import NOWHERE, QualityPlan
from opsim.subjects.release.plan import BASE_STOCK, SATURATED
from opsim.subjects.routes.plan import ProductPlan

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


@dataclass(frozen=True, slots=True)
class Flow:
    """Visits of a product to a station at one step: an hour, and for each job of the sources that are saturated."""

    product: int
    station: int
    per_h: float
    per_job: float


@dataclass(frozen=True, slots=True)
class Flows:
    """per_h, n_saturated : jobs an hour by all sources whose rate is known; sources without one; steps : all visits."""

    per_h: float
    n_saturated: int
    steps: tuple[Flow, ...]

    @property
    def saturated(self) -> bool:
        """Whether the floor decides how much comes in."""
        return self.n_saturated > 0


def flows_of(plan: Plan) -> Flows:
    """All visits of all jobs. A part is made as fast as it is used, unless its source has a rate of its own."""
    visits = [visits_of(plan, product) for product in range(len(plan.products))]
    known, saturated = _given(plan)
    for rates in (known, saturated):
        _follow(plan, visits, rates, pulled=_pulled(plan))
    steps = [
        Flow(product, station, known[product] * n / len(step.stations), saturated[product] * n / len(step.stations))
        for product, made in enumerate(plan.products)
        for step, n in zip(made.route, visits[product])
        for station in step.stations
    ]
    per_h = 3600 * sum(source.jobs_per_s(plan.horizon_s) or 0.0 for source in plan.sources)
    return Flows(per_h, len(_decided_by_the_floor(plan)), tuple(steps))


def _parts(plan: Plan) -> set[int]:
    return {part for kit in plan.kits for part, _ in kit.parts}


def _decided_by_the_floor(plan: Plan) -> list[int]:
    """Ranks of saturated sources that make more than parts of something."""
    parts = _parts(plan)
    return [
        rank
        for rank, source in enumerate(plan.sources)
        if source.kind == SATURATED and any(product not in parts for product, _ in source.mix)
    ]


def _pulled(plan: Plan) -> set[int]:
    """Products that come in as fast as they are used."""
    sources = [source for source in plan.sources if source.kind in (SATURATED, BASE_STOCK)]
    return {product for source in sources for product, _ in source.mix} & _parts(plan)


def _given(plan: Plan) -> tuple[list[float], list[float]]:
    """(jobs an hour, jobs for each job of a saturated source) of each product, by the sources alone."""
    known, saturated = [0.0] * len(plan.products), [0.0] * len(plan.products)
    floor = _decided_by_the_floor(plan)
    for rank, source in enumerate(plan.sources):
        per_s = source.jobs_per_s(plan.horizon_s)
        for product, share in source.mix:
            if per_s is not None:
                known[product] += 3600 * per_s * share
            elif rank in floor:
                saturated[product] += share / len(floor)
    return known, saturated


def _follow(plan: Plan, visits: list[tuple[float, ...]], rates: list[float], pulled: set[int]) -> None:
    """Add what is split off, and what is pulled as parts; as often as there are products, so that all is passed on."""
    given = list(rates)
    for _ in plan.products if plan.kits or plan.splits else ():
        now = list(given)
        for split in plan.splits:
            units = _at(plan, visits, split.product, split.station) * rates[split.product]
            for piece, n in split.pieces:
                now[piece] += units * -(-n * plan.products[split.product].lot // plan.products[piece].lot)
        for kit in plan.kits:
            units = _at(plan, visits, kit.product, kit.station) * rates[kit.product] * plan.products[kit.product].lot
            for part, n in kit.parts:
                now[part] += units * n / plan.products[part].lot if part in pulled else 0.0
        if now == rates:
            return
        rates[:] = now


def _at(plan: Plan, visits: list[tuple[float, ...]], product: int, station: int) -> float:
    """Visits of a job of a product to a station."""
    steps = zip(plan.products[product].route, visits[product])
    return sum(n / len(step.stations) for step, n in steps if station in step.stations)
