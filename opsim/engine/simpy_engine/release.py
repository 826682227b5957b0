"""Sources: the process of a release that does not wait for room."""

from collections.abc import Generator

import simpy

from opsim.clock import on_grid
from opsim.engine.rules import ARRIVAL
from opsim.engine.simpy_engine.floor import Floor

ARRIVED = "job arrived"


def release_by_time(floor: Floor) -> Generator[simpy.Event, None, None]:
    """The SimPy process of a source of its own time: wait a gap, report an arrival."""
    for number, gap_s in enumerate(floor.draws.gaps()):
        yield floor.env.timeout(on_grid(gap_s))
        floor.report(ARRIVAL, 0, number, ARRIVED, number)
