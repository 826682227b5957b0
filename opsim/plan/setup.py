"""Set-ups: what a server needs before a job of another class than the one it did last."""

from dataclasses import dataclass

from opsim.names import natural_key
from opsim.plan.ranks import Ranks

NO_SETUP = -1
ANYTHING = -1
"""What a server was last set up for, before its first job: no set-up is needed for whatever comes."""


@dataclass(frozen=True, slots=True)
class SetupPlan:
    """Set-ups at a station. Products are told apart by classes, themselves or their families.

    station  : its rank; attended : whether a worker does it
    class_of : (P,) number of each product's class, -1 where it never comes here
    task     : (C, C) rank of the task from one class to another, ``NO_SETUP`` where there is none
    mean_s   : (C, C) mean time of that task at rating 1
    first    : the class at the start, or ``ANYTHING``
    """

    station: int
    attended: bool
    class_of: tuple[int, ...]
    task: tuple[tuple[int, ...], ...]
    mean_s: tuple[tuple[float, ...], ...]
    first: int

    @property
    def tasks_by_hand(self) -> set[int]:
        """Ranks of the tasks by which workers set up here; some may run alone all the same."""
        return {rank for row in self.task for rank in row if rank != NO_SETUP} if self.attended else set()

    def needed(self, last: int, product: int) -> tuple[int, float]:
        """(task, mean time) of the set-up for a product on a server that last did a class."""
        if last == ANYTHING:
            return NO_SETUP, 0.0
        here = self.class_of[product]
        return self.task[last][here], self.mean_s[last][here]


def setup_tasks(scenario) -> dict:
    """Tasks that a scenario does not name: of set-ups that are said as a time."""
    from opsim.scenario.schema import Fixed

    said = [time for station in scenario.stations.values() for time in _said(station) if isinstance(time, float)]
    return {setup_name(time_s): Fixed.model_validate({"fixed": f"{time_s!r} s"}) for time_s in said if time_s > 0}


def setup_name(time_s: float) -> str:
    """What the task of a set-up is called; a colon is in no name of a scenario."""
    return f"setup: {time_s:.10g} s"


def plan_setups(scenario, ranks: Ranks, tasks) -> tuple[SetupPlan, ...]:
    """Set-ups of all stations that have some, in natural order; ``tasks`` are those of the Plan."""
    stations = sorted(scenario.stations, key=natural_key)
    return tuple(_setup(name, scenario, ranks, tasks) for name in stations if scenario.stations[name].setup is not None)


def _setup(name: str, scenario, ranks: Ranks, tasks) -> SetupPlan:
    setup = scenario.stations[name].setup
    class_of = {product: class_name(scenario, setup, product) for product in ranks.products}
    here = [product for product in ranks.products if comes_to(scenario.products[product], name)]
    first = () if setup.first is None else (setup.first,)
    classes = sorted({*first, *(class_of[product] for product in here)}, key=natural_key)
    said = [[_rank(setup, last, new, ranks) for new in classes] for last in classes]
    return SetupPlan(
        ranks.stations[name],
        setup.attended,
        tuple(classes.index(class_of[product]) if product in here else -1 for product in ranks.products),
        tuple(tuple(row) for row in said),
        tuple(tuple(0.0 if rank == NO_SETUP else tasks[rank].mean_s() for rank in row) for row in said),
        ANYTHING if setup.first is None else classes.index(setup.first),
    )


def class_name(scenario, setup, product: str) -> str:
    """What a product counts as: itself, or its family where set-ups go by families."""
    family = scenario.products[product].family
    return family if setup.by == "family" and family is not None else product


def comes_to(product, station: str) -> bool:
    """Whether a product comes to a station: by its route, or by its routing."""
    if product.route is not None:
        return any(station == step or (isinstance(step, list) and station in step) for step in product.route)
    return any(station == name or station in ways for name, ways in product.routing.items())


def _rank(setup, last: str, new: str, ranks: Ranks) -> int:
    said = setup.times.get(last, {}).get(new)
    if said is None:
        said = 0.0 if last == new else setup.otherwise
    if isinstance(said, str):
        return ranks.tasks[said]
    if not said:
        return NO_SETUP
    return ranks.tasks[setup_name(said)]


def _said(station) -> list[float | str]:
    if station.setup is None:
        return []
    times = [time for row in station.setup.times.values() for time in row.values()]
    return times if station.setup.otherwise is None else [*times, station.setup.otherwise]
