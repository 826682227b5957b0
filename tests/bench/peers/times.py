"""The numbers a model spends: drawn as it goes (for timing), or given beforehand (so that answers must agree)."""

import random
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

ARRIVALS_PER_S = 0.8
N_STATIONS, BUFFER = 10, 5
POOL_STATIONS, POOL_WORKERS, POOL_ARRIVALS_PER_S = 20, 8, 6.8
SKILLS = [
    frozenset(s for s in range(POOL_STATIONS) if s % POOL_WORKERS in (w, (w + 1) % POOL_WORKERS))
    for w in range(POOL_WORKERS)
]


@dataclass(frozen=True, slots=True)
class Times:
    """gap : next seconds between arrivals; station : next station asked for; service : next seconds by station"""

    gap: Callable[[], float]
    station: Callable[[], int]
    service: tuple[Callable[[], float], ...]


@dataclass(frozen=True, slots=True)
class Given:
    """Lists of the numbers of ``Times``, long enough for a run."""

    gaps: list[float]
    stations: list[int]
    services: list[list[float]]

    def times(self) -> Times:
        """A fresh reading from the start."""
        services = tuple(iter(column).__next__ for column in self.services)
        return Times(iter(self.gaps).__next__, iter(self.stations).__next__, services)


def drawn(model: str, seed: int) -> Times:
    """Numbers of one seed, drawn when asked for."""
    rng = random.Random(seed)
    gap = partial(rng.expovariate, POOL_ARRIVALS_PER_S if model == "pool" else ARRIVALS_PER_S)
    return Times(gap, partial(rng.randrange, POOL_STATIONS), (partial(rng.expovariate, 1.0),) * N_STATIONS)


def given(model: str, seed: int, n: int) -> Given:
    """n numbers of each kind."""
    times = drawn(model, seed)
    services = [[draw() for _ in range(n)] for draw in times.service]
    return Given([times.gap() for _ in range(n)], [times.station() for _ in range(n)], services)
