"""Human effects at values that nobody may have meant."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.ergonomics.joint_loads.strength import HEIGHT_M, MASS_KG
from opsim.names import natural_key
from opsim.scenario.risks.words import listed
from opsim.scenario.schema import Scenario

MEASURED = ("emulator", "motions", "recorded")
"""Tasks whose times were taken from somebody."""
STRONG_BY = {"height_m": "height", "mass_kg": "mass", "sex": "sex"}
"""What strength is made of."""


FIGURES_OF = {
    "learned_share": "learning",
    "fatigue_mean": "fatigue",
    "fatigue_most": "fatigue",
    "rest_taken_min_per_h": "rest",
}
"""Figures that only an effect has."""


def human_risks(scenario: Scenario) -> Iterator[str]:
    """Every warning about human effects."""
    for part in (_first_time, _bodies, _experience, _absence, _outputs):
        yield from part(scenario)


def _first_time(scenario: Scenario) -> Iterator[str]:
    """Times of people who knew the task, taken for those of a first repetition."""
    learning = scenario.human.learning
    if learning is None or learning.measured_at != 1:
        return
    found = [name for name, task in scenario.tasks.items() if any(hasattr(task, kind) for kind in MEASURED)]
    if found:
        yield (
            f"learning: the times of {listed(sorted(found, key=natural_key))} are taken for those of a first "
            "repetition (measured_at: 1), and everybody gets faster than they were recorded: say 'measured_at', how "
            "often those who were recorded had done it"
        )


def _bodies(scenario: Scenario) -> Iterator[str]:
    """Muscles of people of whom nobody knows how strong they are."""
    fatigue = scenario.human.fatigue
    if fatigue is None or not (fatigue.model == "3cc_r" or getattr(fatigue, "by", "") == "posture"):
        return
    lacking: dict[tuple[str, ...], list[str]] = {}
    for name, worker in scenario.workers.items():
        keys = tuple(word for key, word in STRONG_BY.items() if getattr(worker, key) is None)
        if keys:
            lacking.setdefault(keys, []).append(name)
    for keys, names in lacking.items():
        yield (
            f"fatigue: {listed(keys)} of {listed(sorted(names, key=natural_key))} not said: joints are as strong, and "
            f"bodies as heavy, as of {HEIGHT_M:g} m, {MASS_KG:g} kg and the mean of women and men"
        )


def _experience(scenario: Scenario) -> Iterator[str]:
    names = [name for name, worker in scenario.workers.items() if worker.experience]
    if names and scenario.human.learning is None:
        who = listed(sorted(names, key=natural_key))
        yield f"the experience of {who} changes nothing: nobody learns ('human.learning')"


def _absence(scenario: Scenario) -> Iterator[str]:
    said = scenario.human.absence
    if said and all(worker.shift is None for worker in scenario.workers.values()):
        yield "human.absence changes nothing: nobody has a shift that could be missed"


def _outputs(scenario: Scenario) -> Iterator[str]:
    """Figures of effects that are off."""
    for name in scenario.outputs:
        effect = FIGURES_OF.get(name)
        if effect is not None and getattr(scenario.human, effect) is None:
            yield f"outputs: {name}: there is none, as 'human.{effect}' is off"
