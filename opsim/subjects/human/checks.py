"""What is wrong: human effects that need another one, or bodies, and experience of tasks that there are not.

What is risky: human effects at values that nobody may have meant.
"""

from __future__ import annotations

from collections.abc import Iterator

from opsim.ergonomics.anthropometry import HEIGHT_M, MASS_KG
from opsim.problems import Problem, enumerated, natural_key
from opsim.scenario.checks.lookup import named
from opsim.scenario.schema import Scenario
from opsim.scenario.tree import Node, child, entries, problem, text
from opsim.subjects.exposure.checks import BODIES

NEEDS = {
    "rest": ("fatigue", "nobody tires, and nobody rests from it", "{model: lffrm}"),
    "errors": ("fatigue", "nobody tires, and nobody errs by it", "{model: lffrm}"),
    "forgetting": ("learning", "nobody learns what could be forgotten", "{model: wright}"),
}
"""Of an effect: the one that it stands on, what there is without it, and what is missing."""


def human_problems(tree: Node) -> Iterator[Problem]:
    """What is wrong with human effects."""
    for name in entries(tree, "workers"):
        for task, times in entries(tree, "workers", name, "experience").items():
            path = ("workers", name, "experience", task)
            yield from named(Node(task, times.name_place), entries(tree, "tasks"), "task", path)
    for effect, (other, found, such) in NEEDS.items():
        node = child(tree, "human", effect)
        if node is not None and child(tree, "human", other) is None:
            hint = f"add e.g. '{other}: {such}' to 'human', or remove {effect!r}"
            yield problem(node.name_place, ("human", effect), found, hint)
    yield from _errors(tree)
    yield from _muscles(tree)


def _errors(tree: Node) -> Iterator[Problem]:
    """Errors of people, where every station works alone."""
    node, tasks = child(tree, "human", "errors"), entries(tree, "tasks").values()
    if node is not None and tasks and all(_alone(task) for task in tasks):
        yield problem(node.name_place, ("human", "errors"), "every task is automatic: nobody is there to err")


def _alone(task: Node) -> bool:
    node = child(task, "automatic")
    return node is not None and node.value is True


def _muscles(tree: Node) -> Iterator[Problem]:
    """Muscles that tire by the torque of joints, where no task has any."""
    tasks = entries(tree, "tasks").values()
    node = child(tree, "human", "fatigue")
    if node is None or text(node, "model") != "3cc_r" or not tasks:
        return
    if not any(child(task, key) is not None for task in tasks for key in BODIES):
        found = "3cc_r tires muscles by the torque of joints, and no task has a body"
        hint = "take 'model: lffrm', or give a task an emulator"
        yield problem(node.value["model"].place, ("human", "fatigue", "model"), found, hint)


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
            f"learning: the times of {enumerated(sorted(found, key=natural_key))} are taken for those of a first "
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
        who = enumerated(sorted(names, key=natural_key))
        yield (
            f"fatigue: {enumerated(keys)} of {who} not said: joints are as strong, and "
            f"bodies as heavy, as of {HEIGHT_M:g} m, {MASS_KG:g} kg and the mean of women and men"
        )


def _experience(scenario: Scenario) -> Iterator[str]:
    names = [name for name, worker in scenario.workers.items() if worker.experience]
    if names and scenario.human.learning is None:
        who = enumerated(sorted(names, key=natural_key))
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
