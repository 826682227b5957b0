"""Scenarios that have nothing to split, each with the reason and the way out; and what is too little to be sure."""

from __future__ import annotations

from opsim.plan import Plan
from opsim.scenario.read import Loaded
from opsim.study.labour.parts import CROSSED
from opsim.study.labour.people import people_differ
from opsim.study.labour.sources import BETWEEN, LEFT


def refuse_nothing(loaded: Loaded, plan: Plan) -> None:
    """Raises ValueError where there is nobody, or people do not differ."""
    if not plan.workers:
        raise ValueError(f"{loaded.file}: there are no workers, so nobody is hired; 'opsim sweep' asks of machines")
    said = loaded.scenario.run.variability
    if BETWEEN not in LEFT[said]:
        raise ValueError(
            f"{loaded.file}: run.variability is {said}: differences between people are switched off already; take full"
        )
    if not people_differ(plan):
        raise ValueError(
            f"{loaded.file}: people do not differ in any task, so there is nothing to split; say how much of the "
            "spread of a time lies between them, such as 'between_share: 0.4' beside its cv, or take emulated tasks"
        )


FEWEST_DAYS = 3
"""Replications of a crossed design whose intervals hold what they say."""


def too_few_days(design: str, replications: int) -> str:
    """What to say of a crossed design whose intervals are too narrow; "" otherwise."""
    if design != CROSSED or replications >= FEWEST_DAYS:
        return ""
    return (
        "Two days cannot tell how much days differ, so the intervals here are too narrow (95 % ones hold 9 times in "
        "10): take --replications 4, or --design nested."
    )
