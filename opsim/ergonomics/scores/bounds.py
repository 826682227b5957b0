"""What a scenario says of a task, as the least and most that each score may take from it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from opsim.ergonomics.scores.force import owas_load, reba_load, rula_force
from opsim.plan.handling import FORCES, GRIPS, NOT_SAID, Handling

Pair = tuple[int, int]
EITHER: Pair = (0, 1)
LOADS_KG = (0.0, 2.0, 5.0, 10.0, 10.5, 20.5)
"""A load of each class of each method: none, RULA's and REBA's edges, over 10 kg, over 20 kg."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """Pairs (low, high): the same number twice where the scenario says it, all that it may be where it does not.

    rula_force : 0-3, rula_force_worksheet : by the worksheet's rule;  reba_load : 0-3, with shock;  owas_load : 1-3;
                 coupling : 0-3: these four of what the hands hold
    rapid      : 0-1, REBA's activity of quick large changes or an unstable base
    wrist_twist: 1-2;  supported : 0-1, of the arms
    one_legged : 0-1, whether the legs are not both carrying (RULA's legs 2, REBA's legs 2, OWAS 3 and 5)
    sitting    : 0-1;  walking : whether these are steps of somebody who walks (OWAS legs 7)
    """

    rula_force: Pair = (0, 0)
    rula_force_worksheet: Pair = (0, 0)
    reba_load: Pair = (0, 0)
    owas_load: Pair = (1, 1)
    coupling: Pair = (0, 0)
    rapid: Pair = (0, 0)
    wrist_twist: Pair = (1, 1)
    supported: Pair = (0, 0)
    one_legged: Pair = (0, 0)
    sitting: Pair = (0, 0)
    walking: bool = False

    def empty_handed(self) -> Bounds:
        """The same task in the moments in which it carries nothing."""
        none = (0, 0)
        return replace(
            self, rula_force=none, rula_force_worksheet=none, reba_load=none, owas_load=(1, 1), coupling=none
        )


NOTHING_OPEN = Bounds()
"""A task of which all is said: nothing carried, forearm in mid range, standing on both feet, arms not supported."""


def bounds_of(handling: Handling = NOT_SAID, *, walking: bool = False) -> Bounds:
    """What is not said (None) may be anything that the method knows.

    A load of 0 kg with a force or grip that nobody named has none of either. Somebody who walks does not sit, nothing
    supports his arms, and his feet carry in turn, which RULA and REBA count as balanced.
    """
    loads = LOADS_KG if handling.load_kg is None else (handling.load_kg,)
    forces = (handling.force,) if handling.force else ("intermittent",) if handling.load_kg == 0 else FORCES
    pushed = [(load, force) for load in loads for force in forces]
    grips = (handling.grip,) if handling.grip else ("good",) if handling.load_kg == 0 else GRIPS
    return Bounds(
        rula_force=_span(rula_force(load, force) for load, force in pushed),
        rula_force_worksheet=_span(rula_force(load, force, "worksheet") for load, force in pushed),
        reba_load=_span(reba_load(load, shock=force == "shock") for load, force in pushed),
        owas_load=_span(owas_load(load) for load in loads),
        coupling=_span(GRIPS.index(grip) for grip in grips),
        rapid=_said(handling.rapid),
        wrist_twist=(1, 2) if handling.forearm is None else _twice(2 if handling.forearm == "end" else 1),
        supported=(0, 0) if walking else _said(handling.arms_supported),
        one_legged=(0, 0) if walking else _said(None if handling.legs is None else handling.legs == "unbalanced"),
        sitting=(0, 0) if walking else _said(handling.sitting),
        walking=walking,
    )


def _said(flag: bool | None) -> Pair:
    return EITHER if flag is None else _twice(int(flag))


def _twice(code: int) -> Pair:
    return code, code


def _span(codes: Iterable[int]) -> Pair:
    known = list(codes)
    return min(known), max(known)


WALKING = bounds_of(walking=True)
"""Somebody who walks with something in his hands of which nobody said how heavy; with empty hands, ``empty_handed``."""
