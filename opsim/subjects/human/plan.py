"""Human effects that a scenario switches on: each None where it is off."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from opsim.plan.ranks import Ranks
from opsim.problems import natural_key
from opsim.subjects.tasks.plan import task_said

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario


@dataclass(frozen=True, slots=True)
class HumanPlan:
    """Each a frozen model of ``subjects.human``, or None.

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
EFFECTS = ("learning", "forgetting", "fatigue", "state_pace", "circadian", "rest", "errors")


def plan_human(scenario: Scenario, ranks: Ranks) -> HumanPlan:
    """The effects that a scenario names, each made by ``subjects.human``; NO_EFFECTS where it names none."""
    said = scenario.human
    named = {effect: getattr(said, effect) for effect in EFFECTS if getattr(said, effect) is not None}
    experience = _experience(scenario, ranks)
    if not named and not experience:
        return NO_EFFECTS
    from opsim.subjects.human.catalogue import made

    models = {
        effect: made(effect, getattr(block, "model", effect), parameters(block)) for effect, block in named.items()
    }
    return HumanPlan(**models, acts_on=said.acts_on, experience=experience, start_s=scenario.run.start_s)


def parameters(block: Any) -> dict[str, Any]:
    """What the file, or the default, says of a model, by names of its parameters."""
    return {name: getattr(block, name) for name in type(block).model_fields if name != "model"}


def _experience(scenario: Scenario, ranks: Ranks) -> tuple[tuple[float, ...], ...]:
    """(workers, tasks), both in natural order; nothing where nobody has any."""
    workers = [worker for _, worker in sorted(scenario.workers.items(), key=lambda item: natural_key(item[0]))]
    if not any(worker.experience for worker in workers):
        return ()
    return tuple(tuple(worker.experience.get(task_said(task), 0.0) for task in ranks.tasks) for worker in workers)
