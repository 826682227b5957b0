"""The loop of a run: events in their order. An instant is settled after the last of them."""

from __future__ import annotations

from typing import Any

from opsim.engine.fast_engine import log_rows
from opsim.engine.fast_engine.event_list import is_last_of_instant, pop_event
from opsim.engine.fast_engine.floor_state import Floor
from opsim.engine.fast_engine.machine import here, line_of, step
from opsim.engine.fast_engine.settle import happen, settle

DONE, MORE, FAILED = range(3)


@step
def run_on(floor: Floor, most: int) -> int:
    """Everything that happens before the horizon, but so many events at most: DONE, MORE to come, or FAILED."""
    for _ in range(most):
        if floor.settle_pending and is_last_of_instant(floor):
            settle(floor)
        elif floor.heap_n == 0 or floor.heap_time[0] >= floor.horizon_s:
            return DONE
        else:
            floor.env_now = floor.heap_time[0]
            _happens(floor, pop_event(floor))
        if floor.error:
            return FAILED
    return MORE


_happens = here(happen)


def prepare(build: Any) -> None:
    """A floor needs its loop, and somebody who puts rows into columns."""
    build.line(run_on)
    build.line(log_rows.flush_rows)
    build.floor.flush_line = line_of(log_rows.flush_rows)
