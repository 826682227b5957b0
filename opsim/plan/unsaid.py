"""What nobody said of a task's hands, and which scores it leaves open: for warnings and the assumption sheet."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

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
