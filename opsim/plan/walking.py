"""How workers walk: the emulator behind their walks, where the scenario names one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class WalkingPlan:
    """name : ``library/task`` as the scenario says it; model : its emulator.

    The model draws walks of given lengths: ``sample(n, rng, worker=effect, condition={"distance_m": (n,),
    "speed_m_per_s": (n,)})``, each row knowing nothing of the lengths of the others. No rule and no time of a run asks
    it anything: it is asked for postures, by figures and reports.
    """

    name: str
    model: Any


def plan_walking(loaded: Any) -> WalkingPlan | None:
    """The emulator of ``walking:``, or None where a scenario has none."""
    from opsim.libraries import load_library, resolve_library

    walking = loaded.scenario.walking
    if walking is None:
        return None
    file = resolve_library(loaded.scenario.libraries[walking.library], loaded.folder)
    return WalkingPlan(walking.emulator, load_library(file)[walking.library_task])
