"""The law of places: every second of every worker has one."""

from collections.abc import Iterator

from opsim.laws.stays import Stays
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.whereabouts import unaccounted


def places(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """Nobody is nowhere, and nobody moves but by walking."""
    yield from unaccounted(log, plan)
