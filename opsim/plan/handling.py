"""What a scenario says of a task beside its time, which no posture tells: load, grip, force, support."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from opsim.plan.tools import Moment, moment_of

GRIPS = ("good", "fair", "poor", "unacceptable")
FORCES = ("intermittent", "repeated", "static", "shock")
FOREARMS = ("mid", "end")
START, END = Moment(share=0.0), Moment(share=1.0)
LEGS = ("balanced", "unbalanced")
SAID = ("grip", "force", "forearm", "arms_supported", "sitting", "legs", "rapid")
"""What ``handling:`` of a task may say beside its load."""


@dataclass(frozen=True, slots=True)
class Handling:
    """None: nobody said so, and scores that ask for it are intervals.

    load_kg : in both hands together, of each member of a team, from ``start`` to ``end`` of each performance
    grip    : one of GRIPS (REBA's coupling, NIOSH's coupling multiplier)
    force   : one of FORCES, how the load or force comes (RULA's force, REBA's shock)
    forearm : one of FOREARMS, how far the forearm is twisted (RULA's wrist twist)
    arms_supported, sitting : whether something carries the arms, and the body
    legs    : one of LEGS, whether both feet carry (RULA's legs, REBA's legs)
    rapid   : whether posture changes quickly and far, or the base is unstable (REBA's activity)
    """

    load_kg: float | None = None
    grip: str | None = None
    force: str | None = None
    forearm: str | None = None
    arms_supported: bool | None = None
    sitting: bool | None = None
    legs: str | None = None
    rapid: bool | None = None
    start: Moment = START
    end: Moment = END

    @property
    def by_share(self) -> bool:
        """Whether it is known without a performance when hands are full."""
        return self.start.mark < 0 and self.end.mark < 0


NOT_SAID = Handling()


def handling_of(task, scenario, model) -> Handling:
    """What a scenario says of a task; its marks by the names that the model has for them.

    Raises ValueError for another name. Tasks that no scenario names, such as repairs, have NOT_SAID.
    """
    said, loaded = getattr(task, "handling", None), getattr(task, "loaded", None)
    more: dict[str, Any] = {} if said is None else {key: getattr(said, key) for key in SAID}
    names = tuple(getattr(model, "mark_names", ()))
    if loaded is not None:
        more |= {"start": moment_of(loaded.start, names), "end": moment_of(loaded.end, names)}
    made = Handling(load_kg=getattr(task, "load_kg", None), **more)
    return NOT_SAID if made == NOT_SAID else made
