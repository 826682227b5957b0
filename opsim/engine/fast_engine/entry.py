"""Where Python enters the compiled engine: three functions of a floor's address. They release the GIL."""

from __future__ import annotations

from opsim.engine.fast_engine.machine import cast
from opsim.engine.fast_engine.machine.compiling import entered
from opsim.engine.fast_engine.parts.state import Floor
from opsim.engine.fast_engine.settle import close, run_on, start

_as_floor = cast(Floor)


@entered
def start_floor(at: int) -> int:
    """Everything that happens before the first instant."""
    start(_as_floor(at))
    return 0


@entered
def run_floor(at: int, most: int) -> int:
    """So many events at most, see ``settle.run_on``."""
    return run_on(_as_floor(at), most)


@entered
def close_floor(at: int) -> int:
    """The rows that are open at the horizon."""
    close(_as_floor(at))
    return 0
