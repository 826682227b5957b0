"""What buys back what differences between people cost: gained by each step, and the first that is enough.

What may buy back what differences between people cost: people more, or skills more for those who are there.

The points of a labour study, all known before the first run: as it is, each source off, what may buy it back.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from statistics import fmean
from typing import Any

import numpy as np

from opsim.plan import Plan
from opsim.problems import did_you_mean, natural_key, shown
from opsim.scenario.schema.scenario import Loaded
from opsim.study.intervals import CONFIDENCE, Interval
from opsim.study.jobs import Job, Point
from opsim.study.labour.budget import (
    BETWEEN,
    VariabilitySource,
    changes_off,
    difference_interval,
    pace_of,
    table_interval,
    whole_workers,
)
from opsim.study.labour.variance_components import CROSSED, NESTED


@dataclass(frozen=True, slots=True)
class Step:
    """So many more: what that gains, and what is then left over (more than 0) or missing, in pairs.

    gained : against the people as they are; beyond : against the same people without differences between them
    sure   : the interval of ``beyond`` with all steps of all ways held together (Bonferroni), since the best of many
             steps is partly lucky; None where this is the only one
    """

    count: int
    gained: Interval
    beyond: Interval
    sure: Interval | None = None

    @property
    def enough(self) -> bool:
        """Whether the mean reaches the rate without the loss."""
        return self.beyond.mean >= 0

    @property
    def surely(self) -> bool:
        """Whether the interval does, with all steps that were tried held together."""
        return (self.sure or self.beyond).low >= 0


@dataclass(frozen=True, slots=True)
class Curve:
    """One way to buy the loss back, step by step."""

    name: str
    kind: str
    steps: tuple[Step, ...]

    @property
    def first(self) -> Step | None:
        """The first step whose mean is enough."""
        return next((step for step in self.steps if step.enough), None)


@dataclass(frozen=True, slots=True)
class BoughtBack:
    """loss : of throughput by differences between people, equal : throughput without them; curves : way by way."""

    loss: Interval
    equal: Interval
    curves: tuple[Curve, ...]

    def best(self, kind: str) -> Curve | None:
        """Of a kind the curve that is enough first, then the one that gains most; None where there is none."""
        of = [curve for curve in self.curves if curve.kind == kind]
        return min(of, key=_rank, default=None)


def _rank(curve: Curve) -> tuple[float, float]:
    first = curve.first
    last = curve.steps[-1] if first is None else first
    return (np.inf if first is None else float(first.count)), -last.gained.mean


def curve_of(
    name: str,
    kind: str,
    steps: Sequence[tuple[int, np.ndarray]],
    full: np.ndarray,
    equal: np.ndarray,
    design: str = CROSSED,
    tried: int | None = None,
) -> Curve:
    """steps : (how many more, (W, R) rates); full, equal : rates as they are, and without differences of people.

    tried : steps of all ways, held together; by default those of this one
    """
    crossed, together = design == CROSSED, 1 - (1 - CONFIDENCE) / (tried or len(steps))
    made = (
        Step(
            n,
            difference_interval(table - full, full, crossed),
            difference_interval(table - equal, full, crossed),
            difference_interval(table - equal, full, crossed, together),
        )
        for n, table in steps
    )
    return Curve(name, kind, tuple(made))


def bought_back(full: np.ndarray, equal: np.ndarray, curves: Sequence[Curve], design: str = CROSSED) -> BoughtBack:
    """full, equal : (W, R) rates as they are, and without differences between people."""
    crossed = design == CROSSED
    return BoughtBack(difference_interval(equal - full, full, crossed), table_interval(equal, crossed), tuple(curves))


WORKERS, SKILLS = "workers", "skills"
MOST_KINDS = 6
"""Kinds of people tried, each of whom costs as many runs as the study without him."""


@dataclass(frozen=True)
class Candidate:
    """One way to buy it back, step by step.

    kind  : ``workers`` or ``skills``; steps : (how many more, changes of the scenario)
    added : skills: (worker, station) in the order in which they are learned
    """

    name: str
    kind: str
    steps: tuple[tuple[int, Mapping[str, Any]], ...]
    added: tuple[tuple[str, str], ...] = ()


def more_workers(loaded: Loaded, most: int, like: Sequence[str] | None = None) -> tuple[list[Candidate], list[str]]:
    """(a candidate for each kind of worker, what was left out in words): 1 to ``most`` people more like him.

    like : workers by name; by default one of those who are alike, in natural order, at most MOST_KINDS
    Raises ValueError for a name that is no worker.
    """
    if not most:
        return [], []
    kinds = list(like) if like is not None else _kinds(loaded)
    workers = loaded.resolved["workers"]
    if unknown := [name for name in kinds if name not in workers]:
        said = (f"studies.labour.buy_back.like: no worker {shown(n)}; {did_you_mean(n, workers)}" for n in unknown)
        raise ValueError("\n".join(said))
    left = [] if like is not None else kinds[MOST_KINDS:]
    words = [f"Not tried: people like {', '.join(left)}; name them under 'buy_back: {{like: [...]}}'."] if left else []
    return [_like(loaded, name, most) for name in kinds[: None if like is not None else MOST_KINDS]], words


def _kinds(loaded: Loaded) -> list[str]:
    """The first of those who are alike in stations, hours and zones."""
    found: dict[tuple[Any, ...], str] = {}
    for name, worker in sorted(loaded.scenario.workers.items(), key=lambda item: natural_key(item[0])):
        kind = (*(tuple(sorted(of or ())) for of in (worker.skills, worker.shift, worker.zone)), worker.floater)
        found.setdefault(kind, name)
    return list(found.values())


def _like(loaded: Loaded, name: str, most: int) -> Candidate:
    """People like one who is not a recorded person: nobody is there twice."""
    said = {key: value for key, value in loaded.resolved["workers"][name].items() if key != "person"}
    names = _new_names(name, most, loaded.resolved["workers"])
    steps = tuple((k, whole_workers(loaded, dict.fromkeys(names[:k], said))) for k in range(1, most + 1))
    return Candidate(f"more like {name}", WORKERS, steps)


def _new_names(name: str, most: int, taken: Mapping[str, Any]) -> list[str]:
    found: list[str] = []
    number = 2
    while len(found) < most:
        if (made := f"{name}_{number}") not in taken:
            found.append(made)
        number += 1
    return found


def more_skills(loaded: Loaded, plan: Plan, most: int) -> list[Candidate]:
    """A chain: each worker in turn learns the next station of the flow that he does not know, at his mean pace.

    At most ``most`` steps, spread evenly where the chain is longer. Nothing where everybody knows every station.
    Source of the chain: Hopp, Tekin & Van Oyen 2004, Management Science 50(1):83-98.
    """
    links = _links(loaded, _stations(plan))
    if not links or not most:
        return []
    n = min(most, len(links))
    counts = sorted({1 + round(at * (len(links) - 1) / max(1, n - 1)) for at in range(n)})
    steps = tuple((k, whole_workers(loaded, _taught(loaded, links[:k]))) for k in counts)
    return [Candidate("skills more, in a chain", SKILLS, steps, tuple(links))]


def _stations(plan: Plan) -> list[str]:
    """Stations where people work, in the order of the first product that comes to them."""
    ranks = [rank for product in plan.products for operation in product.route for rank in operation.stations]
    by_hand = (rank for rank in ranks if any(not plan.tasks[task].automatic for task in plan.stations[rank].tasks))
    return list(dict.fromkeys(plan.stations[rank].name for rank in by_hand))


def _links(loaded: Loaded, stations: Sequence[str]) -> list[tuple[str, str]]:
    """(worker, station that he learns), in the order of the flow."""
    found = []
    for name, worker in loaded.scenario.workers.items():
        known = [place for place, station in enumerate(stations) if station in worker.skills]
        onward = [*stations[known[0] :], *stations[: known[0]]] if known else []
        new = next((station for station in onward if station not in worker.skills), None)
        if new is not None:
            found.append((known[0], natural_key(name), name, new))
    return [(name, new) for _, _, name, new in sorted(found)]


def _taught(loaded: Loaded, links: Sequence[tuple[str, str]]) -> dict[str, dict[str, Any]]:
    """By worker, his keys with what he has learned. His own stations come first: they are his zone, if he has none.

    He is trained: in the tasks of the new station he has as many repetitions behind him as the least of those who know
    it.
    """
    said, workers = loaded.resolved["workers"], loaded.scenario.workers
    found = {}
    for name, station in links:
        known = list(workers[name].skills)
        found[name] = {
            "skills": {**said[name].get("skills", {}), station: _mean_pace(workers[name].skills.values())},
            "zone": workers[name].zone or known,
            "experience": {**workers[name].experience, **_experience(loaded, station)},
        }
    return found


def _experience(loaded: Loaded, station: str) -> dict[str, float]:
    """Repetitions of the tasks of a station behind the least experienced of those who know it; where there are any."""
    who = [worker for worker in loaded.scenario.workers.values() if station in worker.skills]
    least = {
        task: min((worker.experience.get(task, 0.0) for worker in who), default=0.0)
        for task in loaded.scenario.stations[station].tasks
    }
    return {task: repetitions for task, repetitions in least.items() if repetitions > 0}


def _mean_pace(skills: Any) -> float:
    return fmean(pace_of(skill) for skill in skills)


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
