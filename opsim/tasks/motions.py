"""A task of several motions -> its TaskModel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from opsim.libraries import composite_model, load_library, resolve_library
from opsim.names import natural_key

if TYPE_CHECKING:
    from opsim.scenario.read import Loaded
    from opsim.scenario.schema import Motions, Step

WALK = "walk"
"""What a walk is called in marks, and the task a worker's own effect in it is that of: as in walks between places."""


def motions_model(task: Motions, loaded: Loaded) -> Any:
    """The model of a task's motions, repeats written out. Raises ValueError where their skeletons differ."""
    name = next((name for name, one in loaded.scenario.tasks.items() if one is task), "motions")
    parts = [part for step in task.steps for part in [_part(step, loaded)] * step.repeat]
    return composite_model(name, parts)


def emulators_of(task: Motions, loaded: Loaded) -> list[str]:
    """The emulators behind a task's motions, each once: ``library/task``, that of walking for walks."""
    return list(dict.fromkeys(_emulator(step, loaded) for step in task.steps))


def _part(step: Step, loaded: Loaded) -> tuple[str, Any, dict[str, float] | None, str]:
    """(name in marks, model, condition, key) of a motion."""
    emulator = _emulator(step, loaded)
    if step.walk_m is not None:
        return WALK, _model(emulator, loaded), {"distance_m": step.walk_m}, WALK
    return emulator.partition("/")[2], _model(emulator, loaded), None, same_task(emulator, loaded)


def _emulator(step: Step, loaded: Loaded) -> str:
    """The emulator behind a motion: of a walk, that of ``walking:``."""
    walking = loaded.scenario.walking
    return step.emulator or ("" if walking is None else walking.emulator)


def same_task(emulator: str, loaded: Loaded) -> str:
    """The task of the scenario that is this emulator alone, first in natural order; the emulator's name if none is.

    By it a worker's own effect is found, so that he does in a kit as he does at his bench.
    """
    tasks = loaded.scenario.tasks
    alike = [name for name, task in tasks.items() if getattr(task, "emulator", None) == emulator]
    return min(alike, key=natural_key, default=emulator)


def _model(emulator: str, loaded: Loaded) -> Any:
    library, _, task = emulator.partition("/")
    return load_library(resolve_library(loaded.scenario.libraries[library], loaded.folder))[task]
