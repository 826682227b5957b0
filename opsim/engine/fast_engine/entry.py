"""Where Python enters the compiled engine: three steps, called at their addresses. They release the GIL."""

from __future__ import annotations

from opsim.engine.fast_engine.loop import run_on
from opsim.engine.fast_engine.machine.calling import caller
from opsim.engine.fast_engine.settle import close, start

start_floor = caller(start)
"""Everything that happens before the first instant, of the floor at an address."""
run_floor = caller(run_on)
"""So many events at most, see ``loop.run_on``."""
close_floor = caller(close)
"""The rows that are open at the horizon."""
