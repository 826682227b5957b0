"""Human effects at values that nobody may have meant.

Shifts that change nothing: nobody works in them, or what they say of people is followed by none.

Scores that will be intervals, and rules by exposure where nobody has a body.
"""

from __future__ import annotations

from collections.abc import Iterator

from opsim.clock import on_the_clock
from opsim.ergonomics.anthropometry import HEIGHT_M, MASS_KG
from opsim.kpi.catalogue import ENERGY, LIFTED, SCORED, read_asked
from opsim.plan.compile import LEAST_EXPOSED
from opsim.plan.tasks import LOAD, NO_LOAD, unsaid
from opsim.problems import natural_key
from opsim.scenario.schema import Scenario, Shift
from opsim.scenario.warnings.routes import listed

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


def shift_risks(scenario: Scenario) -> Iterator[str]:
    """Shifts without use, and breaks of shifts that no person follows."""
    people = _followed(scenario.workers.values())
    sources = [*scenario.sources.values(), *([] if scenario.release is None else [scenario.release])]
    things = _followed([*scenario.stations.values(), *sources])
    idle = sorted(set(scenario.shifts) - people - things, key=natural_key)
    if idle:
        it = "it" if len(idle) == 1 else "them"
        yield f"shift {listed(idle)}: nobody works in {it}, and nothing is open by {it}"
    for name in sorted(people | things, key=natural_key):
        shift = scenario.shifts[name]
        if shift.start_s == shift.end_s:
            yield f"shift {name}: it ends when it begins ({on_the_clock(shift.start_s)}), which is 24 h later"
    for name in sorted(things - people, key=natural_key):
        said = _of_people(scenario.shifts[name])
        if said:
            hint = "a station closes over noon where it has two shifts, before and after"
            yield f"shift {name}: its {listed(said)} are for people, and no worker follows it; {hint}"


def _followed(blocks) -> set[str]:
    return {name for block in blocks for name in block.shift or ()}


def _of_people(shift: Shift) -> list[str]:
    """What a shift says that is of people alone."""
    return [key for key in ("breaks", "meetings") if getattr(shift, key)]


BODIES = ("emulator", "motions", "plugin")
ASK_LOADS = {*SCORED, *LIFTED, *ENERGY}
"""Figures that ask what is in the hands."""


def exposure_risks(scenario: Scenario) -> Iterator[str]:
    """Loads that nobody says, and rules by exposure without bodies."""
    yield from _no_load(scenario)
    yield from _no_bodies(scenario)


def tasks_with_bodies(scenario: Scenario) -> list[str]:
    """Tasks that have, or with a plug-in may have, a body; in natural order."""
    tasks = scenario.tasks
    found = [name for name, task in tasks.items() if any(hasattr(task, kind) for kind in BODIES)]
    return sorted((name for name in found if tasks[name].automatic is not True), key=natural_key)


def _no_load(scenario: Scenario) -> Iterator[str]:
    asked = {*scenario.outputs, *(read_asked(figure).kpi for figure in scenario.frontier or ())}
    if asked.isdisjoint(ASK_LOADS):
        return
    tasks = [
        (name, scenario.tasks[name].load_kg, scenario.tasks[name].handling) for name in tasks_with_bodies(scenario)
    ]
    names = unsaid(tasks).get(LOAD, [])
    if names:
        yield f"{listed(names)}: no load is said: {NO_LOAD}; write 'load: 0 kg' where nothing heavy is held"


def _no_bodies(scenario: Scenario) -> Iterator[str]:
    if tasks_with_bodies(scenario):
        return
    rules = {"allocation.rule": scenario.allocation.rule}
    rules |= {f"rotations.{name}.rule": made.rule for name, made in scenario.rotations.items()}
    for path, rule in rules.items():
        if rule == LEAST_EXPOSED:
            yield f"{path}: {LEAST_EXPOSED} goes by postures, and no task has a body: everybody is as little exposed"
