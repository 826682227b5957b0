"""How jobs come in."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ReleasePlan:
    """kind : ``saturated`` (a new job whenever the first buffer has room) or ``poisson`` (mean gap ``every_s``)."""

    name: str
    kind: str
    every_s: float
    when_full: str


def plan_release(scenario) -> ReleasePlan:
    """The one source of a scenario, called ``release``."""
    release = scenario.release
    return ReleasePlan("release", release.kind, release.every_s or 0.0, release.when_full)
