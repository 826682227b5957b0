"""Paced lines: stations whose jobs move together.

Crews: people who share a line by a rule of their own.

Work sharing: the last tasks of a station, which the next one may do instead.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING

from opsim.clock import TICKS_PER_S, on_grid
from opsim.plan.ranks import Ranks, ranked
from opsim.problems import natural_key

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario

INDEXED, MOVING = "indexed", "moving"
STOP, SEND_ON = "stop", "send_on"
NEVER_S = inf


@dataclass(frozen=True, slots=True)
class LinePlan:
    """stations : ranks, in the order of the line; takt_s : from one job coming onto it to the next

    sends_on : whether a job that is not done goes on as it is; else the line stands until it is done
    floaters : ranks of the workers who are called ``call_s`` after a job has come to a station (its stretch), and
               whether they help who is there; nobody where there are none
    speed_m_per_s : of a moving line; 0 of an indexed one
    start_m  : of a moving line, where each station's stretch begins, from the beginning of the line
    reach_s, limit_s : for each station of a moving line, how long after it came onto the line a job is where its worker
               may begin, and where he must stop, while the line moves; exit_s : when it is at the end of the line
    """

    name: str
    kind: str
    stations: tuple[int, ...]
    takt_s: float
    sends_on: bool = False
    floaters: tuple[int, ...] = ()
    call_s: float = NEVER_S
    helps: bool = False
    speed_m_per_s: float = 0.0
    start_m: tuple[float, ...] = ()
    reach_s: tuple[float, ...] = ()
    limit_s: tuple[float, ...] = ()
    exit_s: float = 0.0

    @property
    def moves(self) -> bool:
        """Whether it is a line that moves all the time."""
        return self.kind == MOVING

    def start_s(self, at: int) -> float:
        """How long after it came onto a moving line a job is where the stretch of the at-th station begins."""
        return _line_s(self.start_m[at] / self.speed_m_per_s)

    def reach_m(self, at: int) -> float:
        """Where on a moving line the worker of the at-th station may begin."""
        return self.reach_s[at] * self.speed_m_per_s


def plan_lines(scenario: Scenario, ranks: Ranks) -> tuple[LinePlan, ...]:
    """All paced lines in natural order of names."""
    lines = sorted(scenario.lines.items(), key=lambda item: natural_key(item[0]))
    return tuple(_line(name, line, scenario, ranks) for name, line in lines)


def buffer_of(name: str, buffer: float, scenario: Scenario) -> float:
    """Places in front of a station: none at one of an indexed line, any number on a stretch of a moving one."""
    kind = next((line.kind for line in scenario.lines.values() if name in line.stations), None)
    return {None: buffer, INDEXED: 0, MOVING: inf}[kind]


def _line(name: str, line, scenario: Scenario, ranks: Ranks) -> LinePlan:
    stations = tuple(ranks.stations[station] for station in line.stations)
    sends_on = line.unfinished == SEND_ON
    common = LinePlan(name, line.kind, stations, on_grid(line.takt_s), sends_on, *_andon(line, scenario))
    return _moving(common, line) if line.kind == MOVING else common


def _andon(line, scenario: Scenario) -> tuple[tuple[int, ...], float, bool]:
    """Who is called, when, and whether he helps."""
    if line.andon is None:
        return (), NEVER_S, False
    workers = ranked(scenario.workers)
    floaters = tuple(sorted(workers[name] for name in set(line.andon.workers)))
    return floaters, _line_s(line.andon.at_s), line.andon.does == "help"


def _moving(plan: LinePlan, line) -> LinePlan:
    """The stretches of the stations one after the other, in metres and in the time that the line takes."""
    speed = line.pace_m_per_s
    start_m = [0.0]
    for station in line.stations:
        start_m.append(start_m[-1] + line.lengths_m.get(station, line.length_m))
    return replace(
        plan,
        speed_m_per_s=speed,
        start_m=tuple(start_m[:-1]),
        reach_s=tuple(_line_s(max(0.0, metres - line.upstream_m) / speed) for metres in start_m[:-1]),
        limit_s=tuple(_line_s((metres + line.drift_m) / speed) for metres in start_m[1:]),
        exit_s=_line_s(start_m[-1] / speed),
    )


def _line_s(seconds: float) -> float:
    """A time on the line's clock, on the grid; it may be 0, where a delay may not."""
    return round(seconds * TICKS_PER_S) / TICKS_PER_S


BUCKET_BRIGADE, RABBIT_CHASE = "bucket_brigade", "rabbit_chase"


@dataclass(frozen=True, slots=True)
class CrewPlan:
    """stations, workers : ranks, in the order of the line; of a brigade, from who begins jobs to who ends them."""

    name: str
    kind: str
    stations: tuple[int, ...]
    workers: tuple[int, ...]


def kept_from(worker: str, scenario: Scenario) -> set[str]:
    """Stations where somebody does not work, skill or not: those of crews he is not in, and of a member all others."""
    theirs = {station for crew in scenario.crews.values() for station in crew.stations}
    own = {station for crew in scenario.crews.values() if worker in crew.workers for station in crew.stations}
    return set(scenario.stations) - own if own else theirs


def plan_crews(scenario: Scenario, ranks: Ranks) -> tuple[CrewPlan, ...]:
    """All crews in natural order of names."""
    people = ranked(scenario.workers)
    return tuple(
        CrewPlan(
            name,
            crew.kind,
            tuple(ranks.stations[station] for station in crew.stations),
            tuple(people[worker] for worker in crew.workers),
        )
        for name, crew in sorted(scenario.crews.items(), key=lambda item: natural_key(item[0]))
    )


FILLED = {"half_full": 0.5, "full": 1.0}
"""By word: the share of the next station's buffer from which on a station does the shared work itself."""


@dataclass(frozen=True, slots=True)
class SharePlan:
    """station, partner : ranks of the two; tasks : the last of the first, which may be done first at the other

    In the Plan they are tasks of ``station``, so that loads count them there.

    filled : the share of the partner's buffer from which on the station does them itself
    """

    station: int
    partner: int
    tasks: tuple[int, ...]
    filled: float


def plan_shares(scenario: Scenario, ranks: Ranks) -> tuple[SharePlan, ...]:
    """All of them in natural order of stations."""
    shares = (
        SharePlan(
            ranks.stations[name],
            ranks.stations[station.share.partner],
            tuple(ranks.tasks[task] for task in station.share.tasks),
            FILLED[station.share.when],
        )
        for name, station in scenario.stations.items()
        if station.share is not None
    )
    return tuple(sorted(shares, key=lambda share: share.station))
