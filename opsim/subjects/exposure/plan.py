"""What a scenario says of scoring -> Options, with angles in degrees, as the methods' tables have them.

What a scenario says of a task beside its time, which no posture tells: load, grip, force, support.

What nobody said of a task's hands, and which scores it leaves open: for warnings and the assumption sheet.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

from opsim.ergonomics.options import Options, Thresholds
from opsim.subjects.tools.plan import Moment, moment_of

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario


def plan_ergonomics(scenario: Scenario) -> Options:
    """The options of a run."""
    said = scenario.ergonomics
    return Options(
        rate_hz=said.rate_hz,
        arm_reference=said.arm_reference,
        rula_table_a=said.rula.table_a,
        rula_force=said.rula.force,
        owas_disputed=tuple(said.owas.disputed),
        waiting=said.waiting,
        thresholds=_thresholds(said.thresholds),
    )


def _thresholds(said) -> Thresholds:
    names = [field.name for field in fields(Thresholds)]
    return Thresholds(**{name: _value(said, name) for name in names})


def _value(said, name: str) -> Any:
    """Lengths in metres and switches as they are said, angles in degrees."""
    return getattr(said, name) if name in type(said).model_fields else _deg(getattr(said, f"{name}_rad"))


def _deg(angle_rad: float) -> float:
    """NOTE: to a billionth, so that what was written as 10 deg is 10 again."""
    return round(math.degrees(angle_rad), 9)


GRIPS = ("good", "fair", "poor", "unacceptable")
FORCES = ("intermittent", "repeated", "static", "shock")
FOREARMS = ("mid", "end")
START = Moment(share=0.0)
END = Moment(share=1.0)
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


def handling_of(task, scenario: Scenario, model) -> Handling:
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


ALWAYS = {
    "forearm": "RULA is an interval over the twist of the forearm",
    "arms_supported": "RULA and REBA are intervals over whether something carries the arms",
    "sitting": "REBA and OWAS are intervals over whether he sits",
    "legs": "RULA, REBA and OWAS are intervals over whether both feet carry",
    "rapid": "REBA is an interval over whether posture changes quickly or the stand is unstable",
}
"""By key of ``handling``: what it leaves open."""
LOADED = {
    "grip": "REBA is an interval over the grip",
    "force": "RULA is an interval over how the load comes, REBA over whether it comes as a blow",
}
"""The same, where something is, or may be, in the hands."""
LOAD = "load"
NO_LOAD = "RULA, REBA and OWAS are intervals over what is in the hands, and neither a lifting index nor energy has one"


def unsaid(tasks: Iterable[tuple[str, float | None, Any]]) -> dict[str, list[str]]:
    """Tasks by what nobody said of them: ``load``, or a key of ``handling``; in the order of this page.

    tasks : (name, load in kg or None, an object with the keys of ``handling``, or None where it says nothing)
    """
    found: dict[str, list[str]] = {key: [] for key in (LOAD, *LOADED, *ALWAYS)}
    for name, load_kg, handling in tasks:
        if load_kg is None:
            found[LOAD].append(name)
        for key in (*(LOADED if load_kg != 0 else ()), *ALWAYS):
            if getattr(handling, key, None) is None:
                found[key].append(name)
    return {key: names for key, names in found.items() if names}


def leaves_open(key: str) -> str:
    """What follows for the scores where nobody says it."""
    return NO_LOAD if key == LOAD else {**LOADED, **ALWAYS}[key]
