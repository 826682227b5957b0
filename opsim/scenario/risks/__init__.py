"""What may go wrong in a scenario that is right: said by ``opsim check`` as a warning, never refused."""

from __future__ import annotations

from opsim.scenario.risks.batches import batch_risks
from opsim.scenario.risks.distances import distance_risks
from opsim.scenario.risks.exposure import exposure_risks
from opsim.scenario.risks.held import held_risks
from opsim.scenario.risks.human import human_risks
from opsim.scenario.risks.locks import lock_risks
from opsim.scenario.risks.shifts import shift_risks
from opsim.scenario.risks.unfinished import unfinished_risks
from opsim.scenario.risks.unused import unused_risks
from opsim.scenario.schema import Scenario

PARTS = (
    *(lock_risks, batch_risks, held_risks, unfinished_risks, distance_risks, unused_risks, shift_risks),
    *(exposure_risks, human_risks),
)


def risks_of(scenario: Scenario) -> list[str]:
    """Every warning in a sentence."""
    return [risk for part in PARTS for risk in part(scenario)]
