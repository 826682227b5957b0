"""What may go wrong in a scenario that is right: said by ``opsim check`` as a warning, never refused."""

from __future__ import annotations

from opsim.scenario.schema import Scenario
from opsim.scenario.warnings.deadlock import held_risks, lock_risks
from opsim.scenario.warnings.flow import batch_risks, distance_risks, unfinished_risks, unused_risks
from opsim.scenario.warnings.people import exposure_risks, human_risks, shift_risks

PARTS = (
    *(lock_risks, batch_risks, held_risks, unfinished_risks, distance_risks, unused_risks, shift_risks),
    *(exposure_risks, human_risks),
)


def risks_of(scenario: Scenario) -> list[str]:
    """Every warning in a sentence."""
    return [risk for part in PARTS for risk in part(scenario)]
