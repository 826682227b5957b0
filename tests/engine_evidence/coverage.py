"""Which blocks, options and rules of the language a Plan uses, by looking at the Plan, and what its log shows.

``VOCABULARY`` names them all; a block counts where jobs can come to it: at a station on the way of some product.
"""

from __future__ import annotations

import numpy as np
from engine_evidence.acts import ACT_WORDS, acts_of
from engine_evidence.used_material import MATERIAL_WORDS, material_of
from engine_evidence.used_people import PEOPLE_WORDS, people_of
from engine_evidence.used_stations import STATION_WORDS, stations_of
from engine_evidence.used_times import TIME_WORDS, times_of

from opsim import log as kinds
from opsim.log import EventLog
from opsim.plan import Plan

# NOTE: the engine writes no row of the kind "starved" and none with the cause "setup"
KIND_WORDS = tuple(f"log: {name}" for number, name in enumerate(kinds.KINDS) if number != kinds._STARVED)
CAUSE_WORDS = tuple(f"cause: {name}" for name in kinds.CAUSES if name not in ("", "setup"))
PLAN_WORDS = (*MATERIAL_WORDS, *STATION_WORDS, *TIME_WORDS, *PEOPLE_WORDS)
VOCABULARY = (*PLAN_WORDS, *ACT_WORDS, *KIND_WORDS, *CAUSE_WORDS)
"""Every block, option and rule; what a log shows them do; every kind of row and every cause that a log can show."""


def blocks_of(plan: Plan) -> set[str]:
    """The words of ``PLAN_WORDS`` that a plan uses."""
    return {*material_of(plan), *stations_of(plan), *times_of(plan), *people_of(plan)}


def shown_by(plan: Plan, log: EventLog) -> set[str]:
    """What a log shows: acts, kinds of rows and causes, as words."""
    found = {f"log: {kinds.KINDS[number]}" for number in np.unique(log["kind"])}
    causes = {f"cause: {kinds.CAUSES[number]}" for number in np.unique(log["cause"]) if number}
    return found | causes | acts_of(plan, log)


def finished(log: EventLog) -> int:
    """Jobs that were finished."""
    return len(log.of(kinds.FINISH))
