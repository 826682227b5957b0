"""Sources: the process of a release that does not wait for room."""

from collections.abc import Generator

import simpy

from opsim.clock import on_grid
from opsim.engine.rules import ARRIVAL
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.material import create
from opsim.engine.simpy_engine.state import Source

ARRIVED = "job arrived"


def install(floor: Floor) -> None:
    """A process for each source of a time of its own."""
    for source in floor.sources:
        if source.plan.kind != "saturated":
            floor.env.process(release_by_time(floor, source))


def release_by_time(floor: Floor, source: Source) -> Generator[simpy.Event, None, None]:
    """The SimPy process of a source of its own time: wait a gap, report an arrival."""
    for number, gap_s in enumerate(floor.draws.gaps(source.rank)):
        yield floor.env.timeout(on_grid(gap_s))
        floor.report(ARRIVAL, source.rank, number, ARRIVED, source)


def _arrived(floor: Floor, source: Source) -> None:
    create(floor, source)


HANDLERS: dict[str, Handler] = {ARRIVED: _arrived}
