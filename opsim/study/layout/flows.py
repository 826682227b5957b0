"""Who goes from where to where, how often and how far: the flows of a layout."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opsim.kpi.trips import DRIVEN, EMPTY_HANDED, WITH_A_JOB, ends_of_trip
from opsim.layout import Ways
from opsim.study.jobs import Answers, Job

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
