"""The blocks of the station model: what each hangs on the floor before a run, and what it does with its reports."""

from collections.abc import Callable

from opsim.engine.simpy_engine import (
    base_stock,
    batches,
    cards,
    completion,
    conveyors,
    failures,
    hands,
    kits,
    places,
    preemption,
    quality,
    release,
    sequence,
    setup,
    splits,
    stores,
    transporters,
)
from opsim.engine.simpy_engine.floor import Floor, Handler

INSTALL: tuple[Callable[[Floor], None], ...] = (
    release.install,
    stores.install,
    kits.install,
    splits.install,
    batches.install,
    setup.install,
    sequence.install,
    places.install,
    cards.install,
    base_stock.install,
    quality.install,
    hands.install,
    failures.install,
    preemption.install,
    conveyors.install,
    transporters.install,
)
"""Each looks at its own part of the plan, and does nothing where that is empty."""

HANDLERS: dict[str, Handler] = {
    **completion.HANDLERS,
    **release.HANDLERS,
    **batches.HANDLERS,
    **failures.HANDLERS,
    **conveyors.HANDLERS,
    **transporters.HANDLERS,
}
