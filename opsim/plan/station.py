"""Stations: a place with servers and room in front of them."""

from dataclasses import dataclass
from math import inf

from opsim.names import natural_key


@dataclass(frozen=True, slots=True)
class StationPlan:
    """servers : jobs in process at once; buffer : places in front of the servers (inf where unlimited);
    tasks : ranks of the tasks a job gets here, in order.
    """

    name: str
    place: int
    servers: int
    buffer: float
    tasks: tuple[int, ...]

    @property
    def capacity(self) -> float:
        """Jobs that fit: on servers and in the buffer."""
        return self.servers + self.buffer


def plan_stations(scenario, places: dict[str, int], tasks: dict[str, int]) -> tuple[StationPlan, ...]:
    """Stations in natural order."""
    return tuple(
        StationPlan(
            name,
            places[station.at],
            station.servers,
            inf if station.buffer is None else station.buffer,
            tuple(tasks[task] for task in station.tasks),
        )
        for name, station in sorted(scenario.stations.items(), key=lambda item: natural_key(item[0]))
    )
