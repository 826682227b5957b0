"""How jobs come in."""

from collections.abc import Callable
from dataclasses import dataclass

from opsim.task import TaskModel


@dataclass(frozen=True, slots=True)
class ReleasePlan:
    """kind : ``saturated`` (a new job whenever the first buffer has room), ``poisson`` or ``renewal``

    every_s : mean gap between jobs, 0 where saturated; gap : model of the gaps, None unless renewal
    """

    name: str
    kind: str
    every_s: float
    when_full: str
    gap: TaskModel | None = None


def plan_release(scenario, model_of: Callable) -> ReleasePlan:
    """The one source of a scenario, called ``release``; ``model_of(block)`` finds the model of its gaps."""
    release = scenario.release
    gap = None if release.gap is None else model_of(release.gap)
    every_s = (release.every_s or 0.0) if gap is None else gap.mean_duration_s()
    return ReleasePlan("release", release.kind, every_s, release.when_full, gap)
