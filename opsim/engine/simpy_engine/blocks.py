"""The blocks of the station model: what each hangs on the floor before a run, and what it does with its reports."""

from collections.abc import Callable

from opsim.engine.simpy_engine import (
    assignment,
    base_stock,
    batches,
    cards,
    completion,
    conveyors,
    crews,
    duty,
    failures,
    hands,
    humans,
    kits,
    lines,
    opening,
    places,
    preemption,
    quality,
    release,
    rotations,
    sequence,
    setup,
    splits,
    stores,
    transporters,
    work_sharing,
)
from opsim.engine.simpy_engine.floor import Floor, Handler

INSTALL: tuple[Callable[[Floor], None], ...] = (
    assignment.install,
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
    work_sharing.install,
    hands.install,
    failures.install,
    preemption.install,
    opening.install,
    conveyors.install,
    transporters.install,
    lines.install,
    duty.install,
    crews.install,
    rotations.install,
    humans.install,
)
"""Each looks at its own part of the plan, and does nothing where that is empty."""

HANDLERS: dict[str, Handler] = {
    **completion.HANDLERS,
    **release.HANDLERS,
    **batches.HANDLERS,
    **failures.HANDLERS,
    **opening.HANDLERS,
    **conveyors.HANDLERS,
    **transporters.HANDLERS,
    **lines.HANDLERS,
    **rotations.HANDLERS,
    **duty.HANDLERS,
}
