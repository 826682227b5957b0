"""Limits of single angles: ISO 11226 for postures that are held, EN 1005-4 for postures and movements at machines.

Both standards are not free. Their numbers here are as their secondary literature gives them (for instance Delleman,
Haslegrave & Chaffin 2004, Working postures and movements, CRC Press) and as two public implementations have them;
whoever judges by them should check them against the standard itself. Zones that ask for support, stability or
recovery that nobody told are taken as not given.

Seconds in the zones of EN 1005-4: held, reached rarely, reached often; movements counted minute by minute.

A fold over workers' days: static postures by ISO 11226, zones of EN 1005-4, movements a minute.

Who does the same again and again: performances of one task a minute, from rows of the log alone.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.clock import STEP_S
from opsim.ergonomics.angles import AT
from opsim.ergonomics.shift.frames import Frames
from opsim.ergonomics.strain.static_holds import (
    REGIONS,
    STATIC_WORK,
    Movements,
    Runs,
    RunsOf,
    StaticMarker,
    arm_angle_deg,
    region_angles_deg,
)
from opsim.log import SETUP, WORK, EventLog

ACCEPTABLE, CONDITIONAL, NOT_RECOMMENDED = range(3)
WORDS = ("acceptable", "conditional", "not recommended")


@dataclass(frozen=True, slots=True)
class Held:
    """How long one angle may be held; degrees and seconds. Between free and most, linear from ``longest_s`` down.

    least : below it nothing is recommended (without support)
    free  : up to it any time will do; most: beyond it no time will do
    longest_s, shortest_s : the longest acceptable holding time just beyond ``free``, and at ``most``
    """

    least: float
    free: float
    most: float
    longest_s: float
    shortest_s: float


@dataclass(frozen=True, slots=True)
class Iso11226:
    """ISO 11226:2000, Ergonomics, Evaluation of static working postures (and Cor 1:2006).

    trunk : inclination against upright, table 1 and figure 2: 20 to 60 degrees, 4 min down to 1 min
    arm   : elevation of the upper arm without support, table 4 and figure 4: 20 to 60 degrees, 3 min down to 1 min
    head  : inclination of the head against upright, table 3 and figure 3: 25 to 85 degrees, 8 min down to 1 min
    neck  : flexion of the neck, head against trunk, table 3: 0 to 25 degrees and nothing else

    Backward nothing is recommended without support; the standard says beyond 0 degrees, 5 allow for how a neutral is
    measured (source: design). Asymmetry, which it says should not be visible, is judged by EN 1005-4.
    """

    trunk: Held = Held(-5.0, 20.0, 60.0, 240.0, 60.0)
    left_arm: Held = Held(-5.0, 20.0, 60.0, 180.0, 60.0)
    right_arm: Held = Held(-5.0, 20.0, 60.0, 180.0, 60.0)
    head: Held = Held(-5.0, 25.0, 85.0, 480.0, 60.0)
    neck: Held = Held(-5.0, 25.0, 25.0, 0.0, 0.0)


ISO_11226 = Iso11226()


def holding_time_s(angle_deg: np.ndarray | float, held: Held) -> np.ndarray:
    """How long an angle may be held at most: inf where any time will do, 0 where none will; nan for nan."""
    angle = np.asarray(angle_deg, float)
    share = (angle - held.free) / max(held.most - held.free, 1e-12)
    between = held.longest_s + (held.shortest_s - held.longest_s) * np.clip(share, 0.0, 1.0)
    time = np.where(angle <= held.free, np.inf, np.where(angle <= held.most, between, 0.0))
    return np.where(np.isnan(angle), np.nan, np.where(angle < held.least, 0.0, time))


def judged_static(angle_deg: np.ndarray | float, held_s: np.ndarray | float, held: Held) -> np.ndarray:
    """One of ACCEPTABLE, CONDITIONAL (a time limit that is kept), NOT_RECOMMENDED for an angle held so long; int8."""
    limit_s = holding_time_s(angle_deg, held)
    within = np.where(np.isinf(limit_s), ACCEPTABLE, CONDITIONAL)
    return np.where(np.asarray(held_s, float) <= limit_s, within, NOT_RECOMMENDED).astype(np.int8)


@dataclass(frozen=True, slots=True)
class Zones:
    """EN 1005-4's zones of one angle, degrees: below ``low`` is the backward zone, up to ``free`` zone 1, up to ``far``
    zone 2, beyond it zone 3.

    Each of the four has its verdicts for (static, moved rarely, moved often); rarely is below ``often_per_min``.
    leeway_deg : so far below ``low`` is zone 1 still, for how a neutral is measured: who stands upright leans back by a
        degree as often as forward. The standard has none. Source: design, as ``least`` of ISO 11226 here
    """

    low: float
    free: float
    far: float
    backward: tuple[int, int, int]
    zone_2: tuple[int, int, int]
    zone_3: tuple[int, int, int]
    leeway_deg: float = 5.0

    @property
    def backward_from(self) -> float:
        """The backward zone lies below it."""
        return self.low - self.leeway_deg

    @property
    def verdicts(self) -> tuple[tuple[int, int, int], ...]:
        """Of the backward zone, zones 1, 2 and 3."""
        return self.backward, (ACCEPTABLE,) * 3, self.zone_2, self.zone_3


_NEVER_OFTEN = (NOT_RECOMMENDED, CONDITIONAL, NOT_RECOMMENDED)
_HELD_FOR_A_WHILE = (CONDITIONAL, ACCEPTABLE, NOT_RECOMMENDED)
STATIC, RARELY, OFTEN = range(3)


@dataclass(frozen=True, slots=True)
class En1005:
    """EN 1005-4:2005+A1:2008, Safety of machinery, Human physical performance, Part 4.

    trunk     : bending forward, table 1: 20 and 60 degrees; below 0 it is backward, only with support
    arm       : of the upper arm, forward or sideways, table 3: 20 and 60 degrees; behind the trunk as beyond 60
    sideways  : side bend and twist of the trunk, table 2: 10 degrees
    neck      : table 4 is of the line of sight, 0 to 40 degrees below level; flexion of the head against upright stands
                for it here, as no skeleton tells where eyes look. Source of that: design
    often_per_min : movements a minute from which one moves often (tables 1 to 4)
    arm_often_per_min : from here zone 2 of the arms is no longer conditional but not acceptable (table 3, note)
    static_s  : held for longer than this is static (3.4, as in ISO 11226)
    """

    trunk: Zones = Zones(0.0, 20.0, 60.0, (CONDITIONAL, CONDITIONAL, NOT_RECOMMENDED), _HELD_FOR_A_WHILE, _NEVER_OFTEN)
    arm: Zones = Zones(0.0, 20.0, 60.0, _NEVER_OFTEN, (CONDITIONAL, ACCEPTABLE, CONDITIONAL), _NEVER_OFTEN)
    sideways: Zones = Zones(-1e9, 10.0, 1e9, _NEVER_OFTEN, _NEVER_OFTEN, _NEVER_OFTEN)
    neck: Zones = Zones(0.0, 40.0, 1e9, _NEVER_OFTEN, _NEVER_OFTEN, _NEVER_OFTEN)
    often_per_min: float = 2.0
    arm_often_per_min: float = 10.0
    static_s: float = 4.0


EN_1005_4 = En1005()


def zone(angle_deg: np.ndarray | float, zones: Zones) -> np.ndarray:
    """0 the backward zone, 1, 2 or 3; nan is in no zone: -1. Edges belong to the better zone."""
    angle = np.asarray(angle_deg, float)
    found = np.where(angle < zones.backward_from, 0, 1 + (angle > zones.free) + (angle > zones.far))
    return np.where(np.isnan(angle), -1, found).astype(np.int8)


def judged_moving(angle_deg: np.ndarray | float, way: np.ndarray | int, zones: Zones) -> np.ndarray:
    """ACCEPTABLE, CONDITIONAL or NOT_RECOMMENDED for angles that are STATIC, or reached RARELY or OFTEN; -1 for nan."""
    table = np.array(zones.verdicts, np.int8)
    found = zone(angle_deg, zones)
    return np.where(found < 0, -1, table[np.maximum(found, 0), way]).astype(np.int8)


ZONED = ("trunk", "sideways", "left_arm", "right_arm", "neck")
MINUTE_S = 60.0


def zoned_angles_deg(measures: np.ndarray) -> dict[str, np.ndarray]:
    """The angle (N,) of each of ``ZONED``; sideways: side bend or twist, whichever is more; neck: the whole head; arms:
    elevation, less than 0 behind the trunk."""
    at = {name: np.asarray(measures[:, place], float) for name, place in AT.items()}
    return {
        "trunk": at["trunk_flexion"],
        "sideways": np.fmax(np.abs(at["trunk_side"]), np.abs(at["trunk_twist"])),
        "left_arm": arm_angle_deg(measures, "left"),
        "right_arm": arm_angle_deg(measures, "right"),
        "neck": at["trunk_flexion"] + at["neck_flexion"],
    }


def per_minute(moved: np.ndarray, start_s: np.ndarray) -> np.ndarray:
    """(N,) how many movements there are in the minute of the clock in which each frame begins."""
    minute = np.floor(start_s / MINUTE_S).astype(np.int64)
    _, which = np.unique(minute, return_inverse=True)
    return np.bincount(which, moved)[which] if moved.size else np.zeros(0)


def ways(held: np.ndarray, a_minute: np.ndarray, often_per_min: float) -> np.ndarray:
    """(N,) STATIC, OFTEN or RARELY."""
    return np.where(held, STATIC, np.where(a_minute >= often_per_min, OFTEN, RARELY))


class Zoned:
    """Judges the angle of one of ``ZONED`` of one worker, stretch after stretch.

    How often one moves is counted for each zone by itself, by the movements that cross the edge at which it begins,
    away from upright: who bends from 40 to 70 degrees again and again moves into zone 3 and not into zone 2. What goes
    beyond zone 2 has crossed its edge too, and coming back is no movement of its own. One backward is over when half of
    the leeway is left, as who stands upright need not lean forward. Source of that: design
    """

    def __init__(self, region: str, said: En1005 = EN_1005_4):
        self._arm, self._said = region.endswith("_arm"), said
        self.zones: Zones = getattr(said, "arm" if self._arm else region)
        self._backward = Movements(-self.zones.backward_from, self.zones.leeway_deg / 2.0)
        self._into_2, self._into_3 = Movements(self.zones.free), Movements(self.zones.far)

    def verdicts(self, angle_deg: np.ndarray, held: np.ndarray, start_s: np.ndarray) -> np.ndarray:
        """(N,) ACCEPTABLE, CONDITIONAL, NOT_RECOMMENDED, or -1 where nobody knows, for the angles (N,) of a stretch.

        held : (N,) whether the frame is in a static posture; start_s : (N,) on the clock. A minute is of one stretch.
        """
        a_minute = self._a_minute(angle_deg, start_s)
        found = judged_moving(angle_deg, ways(held, a_minute, self._said.often_per_min), self.zones)
        if self._arm:
            too_often = ~held & (zone(angle_deg, self.zones) == 2) & (a_minute >= self._said.arm_often_per_min)
            found = np.where(too_often, NOT_RECOMMENDED, found)
        return found

    def _a_minute(self, angle_deg: np.ndarray, start_s: np.ndarray) -> np.ndarray:
        """(N,) movements a minute into the zone in which each frame is; zone 1 accepts all."""
        moved = (self._backward.next(-angle_deg), self._into_2.next(angle_deg), self._into_3.next(angle_deg))
        backward, into_2, into_3 = (per_minute(one, start_s) for one in moved)
        return np.choose(np.maximum(zone(angle_deg, self.zones), 0), (backward, np.zeros(into_2.size), into_2, into_3))


def verdicts(
    angle_deg: np.ndarray, held: np.ndarray, start_s: np.ndarray, region: str, said: En1005 = EN_1005_4
) -> np.ndarray:
    """(N,) verdicts of a whole day, as ``Zoned`` gives them."""
    return Zoned(region, said).verdicts(angle_deg, held, start_s)


_HELD = {"trunk": "trunk", "left_arm": "left_arm", "right_arm": "right_arm", "neck": "head"}
"""The region whose holding makes a zone static; nobody looks at how long one is twisted."""
MOVED_DEG = 20.0
"""Trunk, and arms whichever way, have moved when they went beyond this, where EN 1005-4's and ISO 11226's zones of rest
end."""


class Still:
    """Counts for n workers, whose frames come one after the other, in stretches of one worker that do not share a
    minute of the clock; what he holds and how he moves goes on from one to the next.

    not_acceptable_s : (n, ZONED) seconds that EN 1005-4 does not accept; known_s : (n, ZONED) seconds with an angle
    moves            : (n, ZONED) movements beyond ``MOVED_DEG``
    held_s           : (n, REGIONS) seconds in static postures out of neutral
    """

    def __init__(self, n_workers: int, start_s: float = 0.0):
        self._start_s = start_s
        self._marker, self._late = StaticMarker(STATIC_WORK, REGIONS), deque[Frames]()
        self._runs = {region: RunsOf(STATIC_WORK.band_deg, STATIC_WORK.gap_s) for region in REGIONS}
        self._worker: int | None = None
        self.not_acceptable_s, self.known_s, self.moves = (np.zeros((n_workers, len(ZONED))) for _ in range(3))
        self.held_s = np.zeros((n_workers, len(REGIONS)))

    def add(self, frames: Frames, scores: Any = None) -> None:
        """The next stretch."""
        self._late.append(frames)
        for marks in self._marker.push(frames.worker, frames.start_s, frames.seconds, frames.measures):
            self._count(self._late.popleft(), marks)

    def close(self) -> dict[str, Runs]:
        """No more frames come: all holds, by region."""
        for marks in self._marker.close():
            self._count(self._late.popleft(), marks)
        return {region: runs.runs() for region, runs in self._runs.items()}

    def _count(self, frames: Frames, marks: np.ndarray) -> None:
        rank, seconds = frames.worker, frames.seconds
        if rank != self._worker:
            self._worker = rank
            self._zoned = {region: Zoned(region) for region in ZONED}
            self._moves = {region: Movements(MOVED_DEG) for region in ZONED}
        angles_deg = region_angles_deg(frames.measures, REGIONS, behind=True)
        held = dict(zip(REGIONS, marks.T))
        self.held_s[rank] += seconds @ marks
        for place, (region, runs) in enumerate(self._runs.items()):
            runs.add(rank, frames.start_s, seconds, angles_deg[:, place], held[region])
        never = np.zeros(len(frames), bool)
        clock_s = frames.start_s + self._start_s
        for place, (region, angle_deg) in enumerate(zoned_angles_deg(frames.measures).items()):
            found = self._zoned[region].verdicts(angle_deg, held.get(_HELD.get(region, ""), never), clock_s)
            self.not_acceptable_s[rank, place] += seconds[found == NOT_RECOMMENDED].sum()
            self.known_s[rank, place] += seconds[found >= 0].sum()
            raised_deg = np.abs(angle_deg) if region.endswith("_arm") else angle_deg
            self.moves[rank, place] += self._moves[region].next(raised_deg).sum()


NAME = ("worker", "task", "station", "k")
"""Whose performance it is, and which: k counts a worker's own, and at each station its attended ones. A number of the
performance does not tell: of one that somebody helps with, each part has its own."""
REPEATED = 4
"""Performances of one task a minute from which work is repeated: of 4, a cycle of 15 s or less.

Beginnings are posts and cycles the fence between: so many beginnings whose first and last are no further apart than one
cycle less. Source: McAtamney & Corlett 1993, RULA, Applied Ergonomics 24(2), 91-99: muscle use, "repeated more than 4
times/minute" and its worksheets "4 times per minute or more"; Hignett & McAtamney 2000, REBA, Applied Ergonomics 31,
201-205; that a rate is counted by cycles: design.
"""


def repeated_rows(log: EventLog, times: int = REPEATED, within_s: float = MINUTE_S) -> np.ndarray:
    """(rows,) bool: work of a worker who did the same task at a rate of at least ``times`` in ``within_s``.

    That is one of ``times`` beginnings, one after the other, whose first and last are at most within_s x (times - 1) /
    times apart: 45 s for 4 a minute, as of tasks that begin every 15 s. Pieces of a performance begin with its first;
    set-ups are tasks too; rows of nobody, or of no task, are never repeated.
    """
    rows = done_by_workers(log)
    first = _first_pieces(log, rows)
    begun = rows[first]
    marked = _crowded(log["worker"][begun], log["task"][begun], log["start_s"][begun], times, within_s)
    found = np.zeros(len(log), bool)
    found[rows] = marked[np.cumsum(first) - 1]
    return found


def begun(log: EventLog) -> np.ndarray:
    """(n,) rows with which a worker begins a performance of a task, by worker, task, station and k."""
    rows = done_by_workers(log)
    return rows[_first_pieces(log, rows)]


def done_by_workers(log: EventLog) -> np.ndarray:
    """(n,) rows in which a worker performs a task, by ``NAME`` and time."""
    rows = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] >= 0) & (log["task"] >= 0))
    return rows[np.lexsort([log[name][rows] for name in ("start_s", *reversed(NAME))])]


def _first_pieces(log: EventLog, rows: np.ndarray) -> np.ndarray:
    """(n,) bool: of rows by ``NAME`` and time, those with which a performance begins."""
    first = np.ones(rows.size, bool)
    for name in NAME:
        column = log[name][rows]
        first[1:] &= column[1:] == column[:-1]
    first[1:] = ~first[1:]
    return first


def _crowded(worker: np.ndarray, task: np.ndarray, begin_s: np.ndarray, times: int, within_s: float) -> np.ndarray:
    """(n,) bool: beginnings of which so many, of one worker and task, are so many in ``within_s`` or quicker."""
    found = np.zeros(begin_s.size, bool)
    order = np.lexsort([begin_s, task, worker])
    first, last = order[: max(order.size - times + 1, 0)], order[times - 1 :]
    alike = (worker[first] == worker[last]) & (task[first] == task[last])
    longest_s = within_s * (times - 1) / times + STEP_S / 2
    starts = np.flatnonzero(alike & (begin_s[last] - begin_s[first] <= longest_s))
    for step in range(times):
        found[order[starts + step]] = True
    return found
