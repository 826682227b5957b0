"""What a scenario says of a task beside its time, which no posture tells: load, grip, force, support."""

from __future__ import annotations

from dataclasses import dataclass

from opsim.plan.tools import Moment

GRIPS = ("good", "fair", "poor", "unacceptable")
FORCES = ("intermittent", "repeated", "static", "shock")
FOREARMS = ("mid", "end")
START, END = Moment(share=0.0), Moment(share=1.0)
LEGS = ("balanced", "unbalanced")


@dataclass(frozen=True, slots=True)
class Handling:
    """None: nobody said so, and scores that ask for it are intervals.

    load_kg : in both hands together, from ``start`` to ``end`` of each performance
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


NOT_SAID = Handling()
