"""Paced lines: stations whose jobs move together."""

from opsim.engine.simpy_engine import line_clock, line_walks
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.indexed_line import IndexedLine
from opsim.engine.simpy_engine.moving_line import MovingLine


def install(floor: Floor) -> None:
    """A line that moves jobs at intervals, or all the time, for each that the plan has."""
    for plan in floor.plan.lines:
        (MovingLine if plan.moves else IndexedLine)(floor, plan)


HANDLERS: dict[str, Handler] = {**line_clock.HANDLERS, **line_walks.HANDLERS}
