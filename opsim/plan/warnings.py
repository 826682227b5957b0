"""What may go wrong in a scenario that is right: said by ``opsim check`` as warnings, never refused.

``risks_of`` what the scenario alone shows; ``hour_risks`` what loads and hours show.
"""

from __future__ import annotations

from opsim.plan.loads.bottleneck import Loads, loads_of
from opsim.plan.loads.people import worked_by_hand
from opsim.plan.plan import Plan
from opsim.scenario.schema import Scenario
from opsim.scenario.warnings.deadlock import held_risks, lock_risks
from opsim.scenario.warnings.flow import unfinished_risks, unused_risks
from opsim.subjects.exposure.checks import exposure_risks
from opsim.subjects.human.checks import human_risks
from opsim.subjects.lines.warnings import in_lines, standing_lines, too_long_for_the_takt
from opsim.subjects.people.warnings import empty_posts, unmanned
from opsim.subjects.shifts.checks import shift_risks
from opsim.subjects.shifts.hours import Hours
from opsim.subjects.shifts.warnings import left_under_way, starving_breaks
from opsim.subjects.stations.checks import batch_risks
from opsim.subjects.transport.checks import distance_risks

PARTS = (
    *(lock_risks, batch_risks, held_risks, unfinished_risks, distance_risks, unused_risks, shift_risks),
    *(exposure_risks, human_risks),
)


def risks_of(scenario: Scenario) -> list[str]:
    """Every warning in a sentence."""
    return [risk for part in PARTS for risk in part(scenario)]


def hour_risks(plan: Plan, loads: Loads | None = None) -> list[str]:
    """Every warning in a sentence."""
    loads = loads_of(plan) if loads is None else loads
    hours = Hours(plan)
    by_hand = worked_by_hand(plan, loads.flows)
    return [
        *unmanned(plan, hours, by_hand - in_lines(plan)),
        *standing_lines(plan, hours, by_hand),
        *too_long_for_the_takt(plan, hours, loads.flows),
        *left_under_way(plan, hours, by_hand),
        *starving_breaks(plan, hours, loads, by_hand),
        *empty_posts(plan, hours, by_hand),
    ]
