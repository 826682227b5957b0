"""Lines that move: who works on one is carried along with his job, and walks back to the next."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import hypot
from typing import NamedTuple

import numpy as np

from opsim.log import SETUP, STANDS, WALK, WORK, EventLog
from opsim.plan import Plan
from opsim.plan.lines import LinePlan
from opsim.viewer.floor import Floor, Point
from opsim.viewer.visits import Spots
from opsim.whereabouts import Whereabouts

Clock = Callable[[float], float]


class Stretch(NamedTuple):
    """A station of a moving line: how far from the line's beginning, and which way the line goes there.

    clock : how long the line has moved; began_s : by job number, when each came onto it
    """

    line: LinePlan
    start_m: float
    ahead: Point
    clock: Clock
    began_s: dict[int, float]

    def job_m(self, job: int, at_s: float) -> float:
        """How far a job is past the beginning of the stretch."""
        return (self.clock(at_s) - self.clock(self.began_s[job])) * self.line.speed_m_per_s - self.start_m


def carried_along(log: EventLog, plan: Plan, seen: Whereabouts, spots: Spots, floor: Floor) -> Spots:
    """The spots with those on moving lines where the line has come to; unchanged where there is no such line.

    The place of a station is where its stretch begins. Who walks upstream to nobody goes as far as the time is long.
    """
    stretches = dict(_stretches(log, plan, floor))
    if not stretches:
        return spots
    x, y, dx, dy = (column.copy() for column in (spots.x_m, spots.y_m, spots.dx_m, spots.dy_m))
    station, job = log["station"][seen.row], log["job"][seen.row]
    here, ahead, visit = 0.0, (0.0, 0.0), (-1, -1)
    for i in range(seen.row.size):
        if np.isnan(x[i]) or (int(seen.worker[i]), int(seen.place_from[i])) != visit:
            here, visit = 0.0, (int(seen.worker[i]), int(seen.place_from[i]))
        found = stretches.get(int(station[i])) if seen.kind[i] in (WORK, SETUP) and job[i] >= 0 else None
        gone = 0.0
        if found is not None:
            ahead = found.ahead
            here, there = (found.job_m(int(job[i]), float(at_s)) for at_s in (seen.start_s[i], seen.end_s[i]))
            gone = there - here
        elif seen.kind[i] == WALK and here > 0:
            gone = -min(here, plan.workers[visit[0]].walk_m_per_s * float(seen.end_s[i] - seen.start_s[i]))
        x[i], y[i] = x[i] + here * ahead[0], y[i] + here * ahead[1]
        dx[i], dy[i] = gone * ahead[0], gone * ahead[1]
        here += gone
    return spots._replace(x_m=x, y_m=y, dx_m=dx, dy_m=dy)


def _stretches(log: EventLog, plan: Plan, floor: Floor) -> Iterator[tuple[int, Stretch]]:
    """Of each station of a moving line, by its rank."""
    for line in plan.lines:
        if line.moves:
            clock, began_s = _clock(log, line), _began(log, line)
            points = [floor.points_m[plan.stations[rank].place] for rank in line.stations]
            for at, rank in enumerate(line.stations):
                yield rank, Stretch(line, line.start_m[at], _ahead(points, at), clock, began_s)


def _ahead(points: list[Point], at: int) -> Point:
    """The way a line goes at its at-th station: to the next one, at the last as it came."""
    first = min(at, len(points) - 2)
    if first < 0:
        return 1.0, 0.0
    x, y = points[first + 1][0] - points[first][0], points[first + 1][1] - points[first][1]
    long_m = hypot(x, y)
    return (x / long_m, y / long_m) if long_m > 0 else (1.0, 0.0)


def _clock(log: EventLog, line: LinePlan) -> Clock:
    """How long a line has moved by a time of the run."""
    rows = np.flatnonzero((log["kind"] == STANDS) & (log["station"] == line.stations[0]))
    rows = rows[np.argsort(log["start_s"][rows], kind="stable")]
    start_s, end_s = log["start_s"][rows], log["end_s"][rows]

    def moved_s(at_s: float) -> float:
        return at_s - float((np.clip(end_s, None, at_s) - np.clip(start_s, None, at_s)).sum())

    return moved_s


def _began(log: EventLog, line: LinePlan) -> dict[int, float]:
    """When each job came onto a line."""
    rows = np.flatnonzero((log["job"] >= 0) & np.isin(log["station"], line.stations))
    rows = rows[np.argsort(-log["start_s"][rows], kind="stable")]
    return dict(zip(log["job"][rows].tolist(), log["start_s"][rows].tolist()))
