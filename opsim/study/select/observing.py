"""A study's answers as what procedures ask for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opsim.kpi.amounts import LimitText, bounds
from opsim.kpi.better import Asked
from opsim.kpi.names import needs_postures
from opsim.problems import did_you_mean
from opsim.results import Key
from opsim.study.jobs import Answers, Job, Point
from opsim.study.no_figure import remedy
from opsim.study.select.asking import Ask, Limit


@dataclass(frozen=True)
class Replications:
    """Which replication each ask means.

    first : the number of the first; apart : whether each point has numbers of its own, in turn, or all have the same
    """

    answers: Answers
    points: tuple[Point, ...]
    keys: tuple[Key, ...]
    first: int
    apart: bool = False

    def number(self, system: int, r: int) -> int:
        """The number of the r-th replication of a point."""
        return self.first + (r * len(self.points) + system if self.apart else r)

    def after(self, n: Sequence[int]) -> int:
        """A number beyond all of the first n of each point."""
        return max([self.first, *(self.number(i, r - 1) + 1 for i, r in enumerate(n) if r)])

    def observe(self, asks: Sequence[Ask]) -> list[np.ndarray]:
        """As procedures want it. Raises ValueError where a replication has no such figure."""
        jobs = [Job(self.points[a.system], self.number(a.system, r)) for a in asks for r in range(a.first, a.upto)]
        values = self.answers.values(jobs, self.keys)
        for row, column in np.argwhere(np.isnan(values))[:1]:
            raise ValueError(nothing_seen(jobs[row], self.keys[column]))
        return np.split(values, np.cumsum([a.upto - a.first for a in asks])[:-1])


def nothing_seen(job: Job, key: Key) -> str:
    """That a replication has no number of a figure, and why that may be."""
    why = "nobody knows the postures of its work" if needs_postures([key[0]]) else "nothing was observed"
    return f"{job.point.name}: {name_of(key)}: {why} in replication {job.replication}; a choice needs a number of each"


def key_of(asked: Asked, keys: Sequence[Key]) -> Key:
    """The figure that is meant. ``rula_mean/worst`` is that of whoever has most, as nobody is called so.

    Raises ValueError where there is no such figure: the nearest one, or what to do about it.
    """
    named = [(asked.kpi, asked.subject, asked.part)]
    if asked.subject and not asked.part:
        named.append((asked.kpi, "", asked.subject))
    for one in named:
        for key in keys:
            if key[:3] == one:
                return key
    of = [name_of(key) for key in keys if key[0] == asked.kpi]
    hint = did_you_mean(name_of((*named[-1], "")), of, otherwise="there are") if of else remedy(asked.kpi, [])
    raise ValueError(f"no figure {asked.name!r} in this scenario; {hint}")


def name_of(key: Key) -> str:
    """As it is written: kpi, kpi/subject, kpi/part, kpi/subject/part."""
    return "/".join(filter(None, key[:3]))


def limit_of(text: LimitText, key: Key) -> Limit:
    """A limit in the unit of its figure. Raises ValueError where it is written in another."""
    bound, tolerance = bounds(text, key[3])
    return Limit(name_of(key), bound, tolerance, text.sense)
