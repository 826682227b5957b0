"""What bodies went through: one pass over all postures of a replication, for whatever figures are asked for."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from typing import Any, NamedTuple

from opsim.ergonomics.shift.booking import Booking
from opsim.ergonomics.shift.fold import fold
from opsim.ergonomics.shift.regions import Regions
from opsim.ergonomics.strain.energy import Spent
from opsim.ergonomics.strain.lifts import Lifted
from opsim.ergonomics.strain.still import Still
from opsim.kpi.energy import Resting, energy_spent, rest_allowances
from opsim.kpi.exposure_by_region import exposure_by_region
from opsim.kpi.exposure_levels import exposure_levels, measured_share
from opsim.kpi.figure import Figure
from opsim.kpi.holds import holds
from opsim.kpi.lifting import lifting
from opsim.kpi.names import ENERGY, EXPOSURE, HELD, LIFTED, POSTURE, REGION, REST, SCORED
from opsim.log import EventLog
from opsim.plan import Plan


class Asking(NamedTuple):
    """Some figures, the fold over postures that they are made from, and how they are made from it."""

    names: tuple[str, ...]
    make: Callable[[EventLog, Plan], Any]
    figures: Callable[[Any, EventLog, Plan], Iterator[Figure]]


ASKING: tuple[Asking, ...] = (
    Asking(REGION, lambda log, plan: Regions(plan), exposure_by_region),
    Asking(LIFTED, lambda log, plan: Lifted(plan), lifting),
    Asking(HELD, lambda log, plan: Still(len(plan.workers), plan.start_s), holds),
    Asking(ENERGY, lambda log, plan: Spent(plan), energy_spent),
    Asking(REST, lambda log, plan: Resting(plan), rest_allowances),
)
"""What is asked beside ``SCORED``, in the order in which it stands in the summary."""


def exposure(log: EventLog, plan: Plan, asked: Collection[str]) -> Iterator[Figure]:
    """Whatever is asked for of what needs all postures, from one pass over them; nothing where there are no workers.

    How much of the work was measured stands beside it, where ``kpi/posture.py`` does not say so already.
    Raises what ``opsim.ergonomics.shift.day.days`` raises.
    """
    if not plan.workers or set(EXPOSURE).isdisjoint(asked):
        return
    wanted = [asking for asking in ASKING if not set(asking.names).isdisjoint(asked)]
    booking, folds = Booking(plan.start_s), [asking.make(log, plan) for asking in wanted]
    fold(log, plan, [booking, *folds])
    if not set(SCORED).isdisjoint(asked):
        yield from exposure_levels(booking, log, plan)
    for asking, made in zip(wanted, folds):
        yield from asking.figures(made, log, plan)
    if set(POSTURE).isdisjoint(asked):
        yield from measured_share(booking, plan)
