"""A moving line by hand: a worker a station, jobs one after the other, by plain recursions. It shares no code with the
engine but the rounding of delays.

A job is job_m(t) = v (shown(t) - begun) down the line, where ``shown`` is the time in which the line has moved. Station
i begins job j when it is in reach, done at i - 1, and the worker has come to it from where he left the job before.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf

TICK = 2.0**-20


def grid(seconds: float) -> float:
    return max(1, round(seconds / TICK)) * TICK


@dataclass
class Worked:
    """When the work of a job at a station began and ended, and whether it was cut off; begin_s inf: it never began."""

    begin_s: float
    end_s: float
    cut: bool = False


@dataclass
class Line:
    """stops : [from, to] of each time in which the line stands, in order"""

    start_m: list[float]
    end_m: list[float]
    speed: float
    takt_s: float
    walk: float
    upstream_m: float = 0.0
    drift_m: float = 0.0
    sends_on: bool = False
    stops: list[list[float]] = field(default_factory=list)

    def shown(self, t: float) -> float:
        return t - sum(min(t, b) - a for a, b in self.stops if a < t)

    def when(self, shown: float) -> float:
        """The first instant at which the line has moved so long."""
        t = shown
        for a, b in self.stops:
            if a >= t:
                break
            t += b - a
        return t

    def job_m(self, j: int, t: float) -> float:
        return self.speed * (self.shown(t) - j * self.takt_s)

    def met(self, x: float, t: float, j: int) -> float:
        """When a worker who sets out from x at t has come to job j."""
        first = True
        while True:
            a, b = next(((a, b) for a, b in self.stops if b > t), (inf, inf))
            speed, turn = (0.0, b) if a <= t else (self.speed, a)
            gap = self.job_m(j, t) - x
            seconds = -gap / (self.walk + speed) if gap <= 0 else gap / (self.walk - speed)
            if first and seconds <= TICK:
                return t
            arrive, first = t + grid(seconds), False
            if arrive <= turn:
                return arrive
            x, t = x + (1 if gap > 0 else -1) * self.walk * (turn - t), turn

    def reach_s(self, i: int) -> float:
        return round(max(0.0, self.start_m[i] - self.upstream_m) / self.speed / TICK) * TICK

    def limit_s(self, i: int) -> float:
        return round((self.end_m[i] + self.drift_m) / self.speed / TICK) * TICK

    def work(self, times: list[list[float]]) -> list[list[Worked]]:
        """All work, by station and job, of times by station and job; where it does not send on, with its stops."""
        while True:
            worked = self._once(times)
            wrong = None if self.sends_on else self._first_wrong_stop(worked)
            if wrong is None:
                return worked
            a, b = wrong
            self.stops = [stop for stop in self.stops if stop[0] < a] + ([[a, b]] if b > a else [])

    def _first_wrong_stop(self, worked: list[list[Worked]]) -> tuple[float, float] | None:
        """The earliest stop that is missing, or ends at another time than the work that it waits for."""
        needed: dict[float, float] = {}
        for i, row in enumerate(worked):
            for j, one in enumerate(row):
                limit = self.when(j * self.takt_s + self.limit_s(i))
                if one.end_s > limit:
                    needed[limit] = max(needed.get(limit, 0.0), one.end_s)
        had = dict(self.stops)
        return next(((a, needed.get(a, a)) for a in sorted({*had, *needed}) if had.get(a) != needed.get(a)), None)

    def _once(self, times: list[list[float]]) -> list[list[Worked]]:
        worked: list[list[Worked]] = []
        done = [0.0] * len(times[0])
        for i, row in enumerate(times):
            mine: list[Worked] = []
            free_s, free_m, k = 0.0, self.start_m[i], 0
            back_m = self.reach_s(i) * self.speed
            for j in range(len(row)):
                set_out = max(free_s, done[j], self.when(j * self.takt_s + self.reach_s(i)))
                strolls = j > 0 and (free_m - back_m) / self.walk > TICK
                x = max(back_m, free_m - self.walk * (set_out - free_s)) if strolls else free_m
                begin = self.met(x, set_out, j)
                limit = self.when(j * self.takt_s + self.limit_s(i))
                if self.sends_on and begin > limit:
                    way = self.walk * (limit - set_out) * (1 if self.job_m(j, set_out) > x else -1)
                    mine.append(Worked(inf, limit, True))
                    free_s, free_m = limit, x + way
                else:
                    end = begin + row[k]
                    k += 1
                    cut = self.sends_on and end > limit
                    end = limit if cut else end
                    mine.append(Worked(begin, end, cut))
                    free_s, free_m = end, self.job_m(j, end)
                done[j] = free_s
            worked.append(mine)
        return worked
