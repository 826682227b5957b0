"""The blocks of the station model: what each hangs on the floor before a run, and what it does with its reports."""

from collections.abc import Callable

from opsim.engine.simpy_engine import completion, release
from opsim.engine.simpy_engine.floor import Floor, Handler

INSTALL: tuple[Callable[[Floor], None], ...] = (release.install,)
"""Each looks at its own part of the plan, and does nothing where that is empty."""

HANDLERS: dict[str, Handler] = {**completion.HANDLERS, **release.HANDLERS}
