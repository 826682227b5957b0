"""What each station would have to do if nothing ever waited: found from mean durations, without a run."""

from dataclasses import dataclass

from opsim.plan.plan import Plan


@dataclass(frozen=True, slots=True)
class StationLoad:
    """work_s : mean work a visit at rating 1; visits : visits per job released (parallel stations share evenly);
    arrivals_per_h : None where release is saturated; load : share of the servers' time wanted, None where saturated.
    """

    station: str
    servers: int
    work_s: float
    visits: float
    arrivals_per_h: float | None
    load: float | None
    most_per_h: float


def station_loads(plan: Plan) -> list[StationLoad]:
    """Load of each station in natural order; a load above 1 cannot be worked off."""
    visits = _visits(plan)
    return [_load(plan, rank, visits[rank]) for rank in range(len(plan.stations))]


def _load(plan: Plan, rank: int, visits: float) -> StationLoad:
    station = plan.stations[rank]
    work_s = sum(plan.tasks[task].mean_s() for task in station.tasks)
    per_h = 3600 / plan.release.every_s * visits if plan.release.every_s else None
    most_per_h = station.servers * 3600 / work_s
    return StationLoad(
        station.name, station.servers, work_s, visits, per_h, None if per_h is None else per_h / most_per_h, most_per_h
    )


def _visits(plan: Plan) -> list[float]:
    visits = [0.0] * len(plan.stations)
    for product in plan.products:
        for operation, passed in zip(product.route, product.visits()):
            for station in operation.stations:
                visits[station] += product.share * passed / len(operation.stations)
    return visits
