"""How jobs come in: one source or several."""

from collections.abc import Callable
from dataclasses import dataclass

from opsim.plan.ranks import Ranks
from opsim.task import TaskModel

RELEASE = "release"
"""The name of the one source of a scenario that has a ``release``."""


@dataclass(frozen=True, slots=True)
class SourcePlan:
    """kind : ``saturated`` (a new job whenever the first buffer has room), ``poisson`` or ``renewal``

    every_s : mean gap between jobs, 0 where saturated; gap : model of the gaps, None unless renewal
    mix     : (product rank, share) of what it makes, in natural order; the shares sum to 1
    """

    name: str
    kind: str
    every_s: float
    when_full: str
    mix: tuple[tuple[int, float], ...]
    gap: TaskModel | None = None


def plan_sources(scenario, ranks: Ranks, model_of: Callable) -> tuple[SourcePlan, ...]:
    """All sources in natural order of names; ``model_of(block)`` finds the model of their gaps."""
    total = sum(product.share for product in scenario.products.values())
    mix = tuple((rank, scenario.products[name].share / total) for name, rank in ranks.products.items())
    return (_source(RELEASE, scenario.release, mix, model_of),)


def _source(name: str, release, mix: tuple[tuple[int, float], ...], model_of: Callable) -> SourcePlan:
    gap = None if release.gap is None else model_of(release.gap)
    every_s = (release.every_s or 0.0) if gap is None else gap.mean_duration_s()
    return SourcePlan(name, release.kind, every_s, release.when_full, mix, gap)
