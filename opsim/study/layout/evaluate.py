"""Layouts simulated and compared with the present one, replication by replication.

Who goes from where to where, how often and how far: the flows of a layout.

First proposals: the stations put so that today's trips are short. They know nothing of queues; a simulation does.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from opsim.kpi.catalogue import LESS, AskedFigure, read_asked
from opsim.layout import Ways
from opsim.study.compare import holm, paired
from opsim.study.intervals import CONFIDENCE, Interval, t_interval
from opsim.study.jobs import Answers, Job
from opsim.study.layout.floor import Floor, Movable
from opsim.study.layout.moves import Candidate, changes_of
from opsim.study.layout.quadratic_assignment import Assignment, assigned, changes_step_by_step
from opsim.subjects.people.figures import DRIVEN, EMPTY_HANDED, WITH_A_JOB, ends_of_trip

WALKED, EACH, SHARE = "walked_m_per_h", "walked_m_per_part", "walking_share"
BEST, EXPOSURE, EXPOSURE_EACH = "best", "exposure", "exposure_per_part"
MEASURES = (BEST, WALKED, EACH, SHARE, EXPOSURE, EXPOSURE_EACH)
WORST = "worst"
"""The part of a figure that is of the worker who has most of it already."""


@dataclass(frozen=True, slots=True)
class Against:
    """One measure of a layout against the present one on the same random numbers; p_together : Holm over layouts."""

    now: Interval
    then: Interval
    difference: Interval
    p: float
    p_together: float

    @property
    def measured(self) -> bool:
        """Whether both layouts have the figure in any replication that they share."""
        return bool(np.isfinite(self.difference.mean))

    @property
    def clear(self) -> bool:
        """Whether all layouts compared together are rightly told apart from the present one with 95 %."""
        return bool(self.p_together <= 1 - CONFIDENCE) and self.difference.mean != 0

    @property
    def less(self) -> bool:
        """Whether it is clearly less than now."""
        return self.clear and self.difference.mean < 0

    @property
    def more(self) -> bool:
        """Whether it is clearly more than now."""
        return self.clear and self.difference.mean > 0

    def within(self, share: float) -> bool:
        """Whether the whole interval lies within +- a share of the present mean."""
        mean, half = self.relative
        return bool(abs(mean) + half <= share)

    @property
    def identical(self) -> bool:
        """The same in every replication, but for rounding."""
        return self.difference.mean == 0 and self.difference.sd == 0

    @property
    def relative(self) -> tuple[float, float]:
        """(mean, half-width) as a share of the present mean; nan where that is 0."""
        of = abs(self.now.mean) or np.nan
        return self.difference.mean / of, self.difference.half_width / of


def measures(
    answers: Answers, jobs: Sequence[Job], hours: float, best: AskedFigure, exposure: AskedFigure | None
) -> dict[str, np.ndarray]:
    """By measure, its (R,) values in the replications of one layout; hours : of the window.

    walked_m_per_h : of all people together; walking_share : of people's time, their mean; best : the figure asked for,
    summed over its subjects where it has no value of the whole; exposure : of the worker who has most of it
    walked_m_per_part, exposure_per_part : by good parts made, since who makes more walks and bends more
    """
    keys = answers.keys(jobs)
    values = answers.values(jobs, keys)

    def of(kpi: str, part: str | None = None) -> np.ndarray:
        columns = [n for n, key in enumerate(keys) if key[0] == kpi and (part is None or key[2] == part)]
        return values[:, columns]

    found = {
        BEST: _whole(keys, values, best),
        WALKED: of("walked_m").sum(axis=1) / hours,
        SHARE: _mean(of("worker_states", "walk")),
    }
    parts_per_h = _whole(keys, values, AskedFigure("throughput_per_h"))
    parts_per_h = np.where(parts_per_h > 0, parts_per_h, np.nan)
    found[EACH] = found[WALKED] / parts_per_h
    if exposure is not None:
        found[EXPOSURE] = _worst(keys, values, exposure)
        if exposure.kpi.endswith("_per_h"):
            found[EXPOSURE_EACH] = found[EXPOSURE] / parts_per_h
    return found


def against(
    layouts: Mapping[str, Mapping[str, np.ndarray]], now: Mapping[str, np.ndarray]
) -> dict[str, dict[str, Against]]:
    """By layout and measure, the paired comparison with the present one; tests of a measure held together (Holm)."""
    found: dict[str, dict[str, Against]] = {name: {} for name in layouts}
    for measure in MEASURES:
        if measure not in now:
            continue
        for name, values in layouts.items():
            difference, p, _ = paired(values[measure].tolist(), now[measure].tolist())
            found[name][measure] = Against(t_interval(now[measure]), t_interval(values[measure]), difference, p, p)
        together = holm([found[name][measure].p for name in layouts])
        for name, p in zip(layouts, together):
            found[name][measure] = replace(found[name][measure], p_together=float(p))
    return found


def exposure_asked(outputs: Sequence[str], said: str | None) -> AskedFigure | None:
    """The second criterion: what was said, or the first output that says what bodies go through, and less is better."""
    from opsim.kpi.catalogue import EXPOSURE as SCORED
    from opsim.kpi.catalogue import POSTURE, WALKING

    if said is not None:
        return read_asked(said)
    bodily = [kpi for kpi in outputs if kpi in (*POSTURE, *SCORED) and kpi not in WALKING]
    return next((asked for asked in map(read_asked, bodily) if asked.better == LESS), None)


def _whole(keys: Sequence[tuple[str, ...]], values: np.ndarray, asked: AskedFigure) -> np.ndarray:
    named = [n for n, key in enumerate(keys) if key[0] == asked.kpi and key[2] == asked.part]
    if asked.subject or any(keys[n][1] == "" for n in named):
        named = [n for n in named if keys[n][1] == asked.subject]
    if not named:
        raise ValueError(f"no figure {asked.name} in this scenario; name another one with --best or --exposure")
    return values[:, named].sum(axis=1)


def _worst(keys: Sequence[tuple[str, ...]], values: np.ndarray, asked: AskedFigure) -> np.ndarray:
    """(R,) of the worker who has most of it, of those of whom it is known; nan where it is of nobody."""
    of_each = [n for n, key in enumerate(keys) if key[0] == asked.kpi and key[1] and key[2] == asked.part]
    if asked.subject or asked.part == WORST or not of_each:
        return _whole(keys, values, asked)
    most = np.where(np.isnan(values[:, of_each]), -np.inf, values[:, of_each]).max(axis=1)
    return np.where(np.isfinite(most), most, np.nan)


def _mean(values: np.ndarray) -> np.ndarray:
    return values.mean(axis=1) if values.shape[1] else np.zeros(len(values))


PARTS = (EMPTY_HANDED, WITH_A_JOB, DRIVEN)


@dataclass(frozen=True, slots=True)
class Flow:
    """Trips of people between two places, both ways together: in an hour, of these with a job in hand, and how far.

    there, back : trips an hour of each way; distance_m : of the way there (where one way is longer, of the mean trip)
    """

    start: str
    end: str
    there_per_h: float
    back_per_h: float
    with_a_job_per_h: float
    distance_m: float

    @property
    def trips_per_h(self) -> float:
        return self.there_per_h + self.back_per_h

    @property
    def metres_per_h(self) -> float:
        return self.trips_per_h * self.distance_m


@dataclass(frozen=True)
class Flows:
    """Mean trips an hour between P places; every array is (P, P), from row to column, places in natural order."""

    ways: Ways
    empty_handed: np.ndarray
    with_a_job: np.ndarray
    driven: np.ndarray

    @property
    def walked(self) -> np.ndarray:
        """All trips of people."""
        return self.empty_handed + self.with_a_job

    @property
    def walked_m_per_h(self) -> float:
        """Metres that people walk in an hour, all together."""
        return float(_metres(self.walked, self.ways).sum())

    @property
    def driven_m_per_h(self) -> float:
        """Metres that vehicles go, where they go as people do."""
        return float(_metres(self.driven, self.ways).sum())

    def largest_first(self, *, of: np.ndarray | None = None) -> list[Flow]:
        """Every two places between which anybody walks, by metres; or what else goes, such as ``driven``."""
        trips = self.walked if of is None else of
        metres = _metres(trips, self.ways)
        names, found = self.ways.places, []
        for a in range(len(names)):
            for b in range(a + 1, len(names)):
                both = trips[a, b] + trips[b, a]
                if both > 0:
                    loaded = 0.0 if of is not None else self.with_a_job[a, b] + self.with_a_job[b, a]
                    far = (metres[a, b] + metres[b, a]) / both
                    found.append(Flow(names[a], names[b], trips[a, b], trips[b, a], float(loaded), float(far)))
        return sorted(found, key=lambda flow: -flow.metres_per_h)


def flows_of(answers: Answers, jobs: Sequence[Job], ways: Ways) -> Flows:
    """The mean over some replications of one layout; ways : of that layout."""
    keys = [key for key in answers.keys(jobs) if key[0] == "trips_per_h"]
    mean = np.nan_to_num(answers.values(jobs, keys)).mean(axis=0) if keys else np.zeros(0)
    rank = {place: number for number, place in enumerate(ways.places)}
    trips = {part: np.zeros((len(rank), len(rank))) for part in PARTS}
    for (_, subject, part, _), per_h in zip(keys, mean.tolist()):
        start, end = ends_of_trip(subject)
        trips[part][rank[start], rank[end]] = per_h
    return Flows(ways, *(trips[part] for part in PARTS))


def _metres(trips: np.ndarray, ways: Ways) -> np.ndarray:
    """(P, P) metres an hour; what nobody goes is 0, however far."""
    return np.where(trips > 0, trips, 0.0) * np.where(trips > 0, np.array(ways.distance_m), 0.0)


STEPS = 2
"""Proposals that change little, among the others: the best single change, and the best two."""


@dataclass(frozen=True)
class Proposals:
    """Layouts that shorten today's trips, the shortest first. exact : whether all ways to put the stations were tried.

    now_m_per_h, best_m_per_h : metres of today's trips, now and where they are the shortest that were found
    """

    candidates: tuple[Candidate, ...]
    exact: bool
    tried: int
    now_m_per_h: float
    best_m_per_h: float


def proposals(floor: Floor, free: Movable, flows: Flows, most: int, seed: int) -> Proposals:
    """At most so many layouts, by quadratic assignment of what stands at each place to places.

    Stations that stand at one place today stay together. What is not a station stays where it is.
    """
    names = flows.ways.places
    rank = {place: number for number, place in enumerate(names)}
    trips = flows.walked
    visited = [place for place in names if trips[rank[place]].any() or trips[:, rank[place]].any()]
    things = [*free.things, *(place for place in visited if place not in free.things)]
    spots = list(dict.fromkeys([*things, *free.allowed]))
    of, to = np.array([rank[place] for place in things]), np.array([rank[place] for place in spots])
    flow, distance = trips[np.ix_(of, of)], np.array(flows.ways.distance_m)[np.ix_(to, to)]
    asked: Any = {
        "now": list(range(len(things))),
        "fixed": list(range(len(free.things), len(things))),
        "allowed": [spots.index(place) for place in free.allowed],
    }
    steps = changes_step_by_step(flow, distance, **asked, steps=STEPS) if most > STEPS else []
    found = assigned(flow, distance, **asked, most=most + 1, seed=seed)
    now_m = float((flow * distance[: len(things), : len(things)]).sum())
    better = [one for one in found.best if one.cost < now_m * (1 - 1e-9) or free.exclusive]
    chosen = _chosen(better, steps, most)
    candidates = tuple(_candidate(floor, free, spots, one, number) for number, one in enumerate(chosen, 1))
    return Proposals(candidates, found.exact, found.tried, now_m, min([now_m, *(one.cost for one in better)]))


def _chosen(best: Sequence[Assignment], steps: Sequence[Assignment], most: int) -> list[Assignment]:
    """The cheapest, with room kept for those that change little; cheapest first."""
    few = [one for one in steps if all(one.cost > other.cost * (1 + 1e-9) for other in best[: most - len(steps)])]
    return sorted([*best[: most - len(few)], *few], key=lambda one: one.cost)


def _candidate(floor: Floor, free: Movable, spots: Sequence[str], one: Assignment, number: int) -> Candidate:
    goes = {place: spots[one.place_of[thing]] for thing, place in enumerate(free.things)}
    at = {station: goes.get(place, place) for station, place in floor.at.items()}
    return Candidate(f"proposal_{number}", changes_of(floor, at), at, proposed=True, predicted_m_per_h=one.cost)
