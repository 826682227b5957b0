"""A task of a scenario, of one motion, of several or of none, -> its TaskModel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from opsim.problems import natural_key
from opsim.subjects.tasks.distributions import (
    Beta,
    Empirical,
    Erlang,
    Exponential,
    Fixed,
    Gamma,
    Geometric,
    Hyperexponential,
    Lognormal,
    Normal,
    Recorded,
    Triangular,
    Uniform,
    Weibull,
)

if TYPE_CHECKING:
    from opsim.libraries import HandTarget
    from opsim.scenario.schema import Emulated, Layout, Motions, Step
    from opsim.scenario.schema.scenario import Loaded

WALK = "walk"
"""What a walk is called in marks, and the task a worker's own effect in it is that of: as in walks between places."""


def motions_model(task: Motions, loaded: Loaded) -> Any:
    """The model of a task's motions, repeats written out. Raises ValueError where their skeletons differ."""
    from opsim.libraries import composite_model

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
    from opsim.libraries import load_library, resolve_library

    library, _, task = emulator.partition("/")
    return load_library(resolve_library(loaded.scenario.libraries[library], loaded.folder))[task]


def task_model(task: Any, loaded: Loaded) -> Any:
    """The TaskModel of a task of a scenario; an emulated one comes out of its library, ``cv: 0`` is a fixed time."""
    from opsim.scenario import schema

    match task:
        case schema.Emulated():
            from opsim.libraries import library_model, resolve_library

            file = resolve_library(loaded.scenario.libraries[task.library], loaded.folder)
            return library_model(file, task.library_task, hand_targets(task, loaded.scenario.layout))
        case schema.Motions():
            return motions_model(task, loaded)
        case schema.Recorded():
            from opsim.csv_input import read_times, resolve_times

            times = tuple(read_times(resolve_times(task.recorded, loaded.folder), task.column))
            return Empirical(times) if task.by == "smooth" else Recorded(times, by_index=task.by == "trace")
        case schema.Plugged():
            from opsim.plugins import plugin_model

            return plugin_model(task.plugin, task.said)
        case _:
            return time_model(task)


def hand_targets(task: Emulated, layout: Layout) -> tuple[HandTarget, ...]:
    """Where a task's hands go, in the order of its marks by name; each mark of one height."""
    return tuple(_target(mark, task.hands[mark], layout) for mark in sorted(task.hands, key=natural_key))


def _target(mark: str, said: Any, layout: Layout) -> HandTarget:
    from opsim.libraries import HandTarget

    if isinstance(said, float):
        return HandTarget(mark, said)
    name, level = said
    place = layout.with_heights[name]
    return HandTarget(mark, place.heights_m[level], place.depth_m)


def time_model(task: Any) -> Any:
    """The model of a time that stands in the scenario itself: fixed, or from a distribution."""
    from opsim.scenario import schema

    match task:
        case schema.Fixed():
            return Fixed(task.fixed_s)
        case schema.Exponential():
            return Exponential(task.mean_s)
        case schema.Erlang():
            return Erlang(task.mean_s, task.k)
        case schema.Geometric():
            return Geometric(task.mean_s, task.step_s)
        case schema.Uniform():
            return Uniform(task.low_s, task.high_s)
        case schema.Triangular():
            return Triangular(task.low_s, task.mode_s, task.high_s)
        case schema.Empirical():
            return Empirical(tuple(task.values_s))
        case schema.Normal() | schema.Beta():
            return Fixed(task.mean_s) if task.spread == 0 else _bounded(task)
        case schema.Lognormal() | schema.Gamma() | schema.Weibull() | schema.Hyperexponential():
            family = _FAMILIES[task.dist]
            return Fixed(task.mean_s) if task.cv == 0 else family(task.mean_s, task.cv, task.between_share)
    raise TypeError(f"no model for a {type(task).__name__}")


_FAMILIES = {"lognormal": Lognormal, "gamma": Gamma, "weibull": Weibull, "hyperexponential": Hyperexponential}


def _bounded(task: Any) -> Normal | Beta:
    if task.dist == "normal":
        return Normal(task.mean_s, task.spread, task.between_share, task.low_s)
    return Beta(task.mean_s, task.spread, task.between_share, task.low_s, task.high_s)
