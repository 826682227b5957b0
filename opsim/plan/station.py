"""Points of the flow: stations with servers and room in front of them; stores and conveyors stand in the same list."""

from dataclasses import dataclass
from math import inf

from opsim.names import natural_key
from opsim.plan.ranks import Ranks

STATION, STORE, CONVEYOR = "station", "store", "conveyor"


@dataclass(frozen=True, slots=True)
class StationPlan:
    """servers : jobs in process at once; buffer : places in front of the servers (inf where unlimited);
    tasks : ranks of the tasks a job gets here, in order; kind : ``station``, ``store`` or ``conveyor``.
    """

    name: str
    place: int
    servers: int
    buffer: float
    tasks: tuple[int, ...]
    kind: str = STATION

    @property
    def capacity(self) -> float:
        """Jobs that fit: on servers and in the buffer."""
        return self.servers + self.buffer


def plan_stations(scenario, ranks: Ranks) -> tuple[StationPlan, ...]:
    """All points of the flow in natural order."""
    points = {name: _station(name, station, ranks) for name, station in scenario.stations.items()}
    return tuple(points[name] for name in sorted(points, key=natural_key))


def _station(name: str, station, ranks: Ranks) -> StationPlan:
    buffer = inf if station.buffer is None else station.buffer
    tasks = tuple(ranks.tasks[task] for task in station.tasks)
    return StationPlan(name, ranks.places[station.at], station.servers, buffer, tasks)
