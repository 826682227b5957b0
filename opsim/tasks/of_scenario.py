"""A task of a scenario -> its TaskModel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from opsim.libraries import load_library, resolve_library
from opsim.recorded import read_times, resolve_times
from opsim.tasks.bounded import Beta, Normal
from opsim.tasks.motions import motions_model
from opsim.tasks.seen import Empirical, Recorded
from opsim.tasks.shared import Gamma, Hyperexponential, Lognormal, Weibull
from opsim.tasks.simple import Erlang, Exponential, Fixed, Geometric, Triangular, Uniform

if TYPE_CHECKING:
    from opsim.scenario.read import Loaded


def task_model(task: Any, loaded: Loaded) -> Any:
    """The TaskModel of a task of a scenario; an emulated one comes out of its library, ``cv: 0`` is a fixed time."""
    from opsim.scenario import schema

    match task:
        case schema.Emulated():
            file = resolve_library(loaded.scenario.libraries[task.library], loaded.folder)
            return load_library(file)[task.library_task]
        case schema.Motions():
            return motions_model(task, loaded)
        case schema.Recorded():
            times = tuple(read_times(resolve_times(task.recorded, loaded.folder), task.column))
            return Empirical(times) if task.by == "smooth" else Recorded(times, by_index=task.by == "trace")
        case schema.Plugged():
            from opsim.plugins import plugin_model

            return plugin_model(task.plugin, task.said)
        case _:
            return time_model(task)


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
