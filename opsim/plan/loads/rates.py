"""How many jobs of each product come in: by the sources, by what they are part of, by what is split into them."""

from __future__ import annotations

from dataclasses import dataclass

from opsim.plan.loads.visits import visits_of
from opsim.plan.plan import Plan
from opsim.plan.release import BASE_STOCK, SATURATED


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
