"""Human effects that stand on another one, or on bodies, and experience of tasks that exist."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem
from opsim.scenario.checks.references import named
from opsim.scenario.positions import Node, child, entries, problem, text

BODIES = ("emulator", "motions", "plugin")
"""Keys of tasks that may have a body."""
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
