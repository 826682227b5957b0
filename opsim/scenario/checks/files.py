"""The files a scenario names: they exist, can be read, and hold what is asked of them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from opsim.libraries import LibraryMissing, library_tasks, resolve_library
from opsim.problems import Problem, did_you_mean, shown
from opsim.recorded import RecordedError, read_times, resolve_times
from opsim.scenario.checks.failures import stop_times
from opsim.scenario.checks.references import emulators
from opsim.scenario.checks.releases import releases
from opsim.scenario.positions import Node, Part, child, entries, problem, text


def file_problems(tree: Node, folder: Path) -> Iterator[Problem]:
    """Libraries that are missing or broken, tasks they do not have, recorded times that cannot be read."""
    tasks_of: dict[str, list[str]] = {}
    for name, node in entries(tree, "libraries").items():
        if not isinstance(node.value, str):
            continue
        try:
            tasks_of[name] = library_tasks(resolve_library(node.value, folder))
        except LibraryMissing as error:
            yield problem(node.place, ("libraries", name), error.message, error.hint)
    for path, model in emulators(tree):
        library, _, inside = model.value.partition("/")
        if inside and library in tasks_of and inside not in tasks_of[library]:
            hint = did_you_mean(inside, tasks_of[library], otherwise="tasks in it")
            yield problem(model.place, path, f"no task {shown(inside)} in library {shown(library)}", hint)
    for name, task in entries(tree, "tasks").items():
        yield from _recorded(task, ("tasks", name), folder)
    for path, release in releases(tree).items():
        gap = child(release, "every")
        if gap is not None:
            yield from _recorded(gap, (*path, "every"), folder)
    for path, time in stop_times(tree):
        yield from _recorded(time, path, folder)


def _recorded(model: Node, path: tuple[Part, ...], folder: Path) -> Iterator[Problem]:
    """What is wrong with a file of recorded times."""
    file = text(model, "recorded")
    if file is None:
        return
    try:
        read_times(resolve_times(file, folder), text(model, "column"))
    except RecordedError as error:
        yield problem(model.value["recorded"].place, (*path, "recorded"), error.message, error.hint)
