"""Human effects that a scenario switches on: each None where it is off."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class HumanPlan:
    """Each a frozen model of ``opsim.human``, or None.

    acts_on    : ``posture``: what slows a person is a shift of log duration that posture follows; ``time``: a factor
    experience : (workers, tasks) repetitions that each worker has behind him at the start; empty: none
    """

    learning: Any = None
    forgetting: Any = None
    fatigue: Any = None
    state_pace: Any = None
    circadian: Any = None
    rest: Any = None
    errors: Any = None
    acts_on: str = "posture"
    experience: tuple[tuple[float, ...], ...] = ()
    start_s: float = 0.0

    @property
    def any(self) -> bool:
        """Whether any effect is on."""
        return self.changes_times or self.rest is not None or self.errors is not None

    @property
    def changes_times(self) -> bool:
        """Whether any effect acts on the time of a performance."""
        effects = (self.learning, self.forgetting, self.fatigue, self.state_pace, self.circadian)
        return any(effect is not None for effect in effects)


NO_EFFECTS = HumanPlan()
