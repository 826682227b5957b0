"""The points of a labour study, all known before the first run: as it is, each source off, what may buy it back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from opsim.scenario.read import Loaded
from opsim.study.jobs import Job, Point
from opsim.study.labour.candidates import Candidate
from opsim.study.labour.parts import NESTED
from opsim.study.labour.sources import BETWEEN, VariabilitySource, changes_off


@dataclass(frozen=True)
class Points:
    """full : as it is; equal : the same without differences between people

    off, alone : by source, all_off : empty and None where there is no budget; more : by candidate, a point for each
    step
    """

    full: Point
    equal: Point
    off: dict[str, Point] = field(default_factory=dict)
    alone: dict[str, Point] = field(default_factory=dict)
    all_off: Point | None = None
    more: tuple[tuple[Candidate, tuple[Point, ...]], ...] = ()

    @property
    def every(self) -> list[Point]:
        """All that are needed, each once, in a fixed order."""
        equal = [self.equal] if self.more else []
        ends = equal if self.all_off is None else [self.all_off, *equal]
        steps = [point for _, points in self.more for point in points]
        return list(dict.fromkeys([self.full, *self.off.values(), *ends, *self.alone.values(), *steps]))


def points_of(
    loaded: Loaded,
    variant: str | None,
    sources: Sequence[VariabilitySource],
    candidates: Sequence[Candidate],
    *,
    budget: bool,
    alone: bool,
) -> Points:
    """The points of what is asked."""
    names = [source.name for source in sources]

    def without(name: str, off: Sequence[str]) -> Point:
        return Point(name, changes_off(loaded, off), variant)

    off = {name: without(f"without {name}", [name]) for name in names}
    only = {name: without(f"{name} alone", [other for other in names if other != name]) for name in names}
    return Points(
        Point("full", {}, variant),
        off[BETWEEN],
        off if budget else {},
        only if budget and alone else {},
        without("all off", names) if budget else None,
        tuple((one, _steps(one, variant)) for one in candidates),
    )


def _steps(candidate: Candidate, variant: str | None) -> tuple[Point, ...]:
    return tuple(Point(f"{candidate.name} +{count}", changes, variant) for count, changes in candidate.steps)


def jobs_of(point: Point, workforces: int, replications: int, design: str) -> list[Job]:
    """W x R jobs, one workforce after the other. Crossed: replications 0 to R - 1 of each; nested: R of its own."""
    first = replications if design == NESTED else 0
    return [
        Job(point, first * number + replication, number + 1)
        for number in range(workforces)
        for replication in range(replications)
    ]
