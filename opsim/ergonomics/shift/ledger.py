"""How long workers were at which score and in which angle: seconds by worker, station, task, product and hour.

Frames and their scores are booked, stretch by stretch, into a ledger.

Which region of the body a high RULA score comes from, over a whole shift.

How the day goes for bodies: each worker's scores, minute by minute.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial
from typing import Any, NamedTuple

import numpy as np

from opsim.ergonomics.angles import AT
from opsim.ergonomics.options import Options
from opsim.ergonomics.scores.scoring import Bounds, Scores, edges_of, phases_of, places, tables_of
from opsim.ergonomics.shift.day import fold, said_of
from opsim.ergonomics.shift.frames import Frames
from opsim.log import EventLog
from opsim.plan import Plan


class Bins(NamedTuple):
    """n of them, each 1 wide: the first begins at ``first``. Scores have a bin each, angles one a degree."""

    first: int
    n: int


_SCORES = {"rula": Bins(1, 7), "reba": Bins(1, 15), "owas": Bins(1, 4)}
AT_MOST = "_at_most"
BINS = {
    **_SCORES,
    **{name + AT_MOST: bins for name, bins in _SCORES.items()},
    "trunk": Bins(-180, 360),
    "arm": Bins(0, 180),
}
"""What is counted: RULA's grand score, REBA's score and OWAS's action category, each as low and as high (``_at_most``)
as it may be; flexion of the trunk and elevation of the arm that is higher, in degrees."""
KEY = ("worker", "station", "task", "product", "hour")
"""``hour`` is that of the day, 0 to 23."""


@dataclass(frozen=True, eq=False)
class Ledger:
    """Seconds of M cells; together they are all the time of the frames.

    key  : (M, 5) by ``KEY``; ranks, -1 for none, and WALKING or WAITING in place of a task
    bins : by the names of ``BINS``: (M, 1 + n) seconds; column 0 is time for which it is not known
    """

    key: np.ndarray
    bins: dict[str, np.ndarray]

    @property
    def seconds(self) -> np.ndarray:
        """(M,) of all time."""
        return self.bins["rula"].sum(axis=1)

    @property
    def unmeasured_s(self) -> np.ndarray:
        """(M,) of time whose posture nobody knows."""
        return self.bins["rula"][:, 0]

    def known_s(self, name: str) -> np.ndarray:
        """(M,) seconds for which a score or an angle is known."""
        return self.bins[name][:, 1:].sum(axis=1)

    def from_s(self, name: str, value: int) -> np.ndarray:
        """(M,) seconds at a score of ``value`` or more; with an angle of so many whole degrees or more."""
        return self.bins[name][:, 1 + value - BINS[name].first :].sum(axis=1)

    def score_seconds(self, name: str) -> np.ndarray:
        """(M,) a score, integrated over the seconds for which it is known."""
        first, n = BINS[name]
        return self.bins[name][:, 1:] @ np.arange(first, first + n, dtype=float)

    def where(self, rows: np.ndarray | list[int]) -> Ledger:
        """Some cells, by mask or number."""
        return Ledger(self.key[rows], {name: seconds[rows] for name, seconds in self.bins.items()})

    def by(self, column: str, values: np.ndarray) -> Ledger:
        """All cells put together by one column of the key: a cell for each of some values, in their order."""
        where = {int(value): place for place, value in enumerate(values)}
        own = self.key[:, KEY.index(column)]
        place = np.array([where.get(int(value), -1) for value in own], dtype=int)
        key = np.full((len(values), len(KEY)), -1)
        key[:, KEY.index(column)] = values
        bins = {name: np.zeros((len(values), seconds.shape[1])) for name, seconds in self.bins.items()}
        for name, seconds in self.bins.items():
            np.add.at(bins[name], place[place >= 0], seconds[place >= 0])
        return Ledger(key, bins)

    def together(self) -> Ledger:
        """All cells as one."""
        bins = {name: seconds.sum(axis=0, keepdims=True) for name, seconds in self.bins.items()}
        return Ledger(np.full((1, len(KEY)), -1), bins)


HOUR_S, HOURS = 3600.0, 24
ARMS = [AT["left_arm_elevation"], AT["right_arm_elevation"]]


class Booking:
    """A fold over the frames of a day; ``close`` gives the ledger. A cell takes 5 kB, and there are few."""

    def __init__(self, start_s: float = 0.0):
        """start_s : when on the clock the run begins."""
        self._start_s = start_s
        self._cells: dict[tuple[int, ...], int] = {}
        self._bins = {name: np.zeros((0, 1 + bins.n)) for name, bins in BINS.items()}

    def add(self, frames: Frames, scores: Any) -> None:
        """Book a stretch, which lies within an hour of the clock; scores : as ``shift.scored`` gives them."""
        hour = int((self._start_s + frames.start_s[0]) // HOUR_S) % HOURS
        keys, cell = _cells(frames)
        rows = [self._cell((frames.worker, *key, hour)) for key in keys]
        for name, place in _places(frames, scores).items():
            width = 1 + BINS[name].n
            found = np.bincount(cell * width + place, frames.seconds, len(rows) * width)
            self._bins[name][rows] += found.reshape(-1, width)

    def close(self) -> Ledger:
        """All that was booked, by key."""
        keys = np.array(list(self._cells), dtype=int).reshape(-1, len(KEY))
        order = np.lexsort(keys.T[::-1])
        return Ledger(keys[order], {name: bins[: len(keys)][order] for name, bins in self._bins.items()})

    def _cell(self, key: tuple[int, ...]) -> int:
        """The row of a cell; there is room for more rows than are taken."""
        row = self._cells.setdefault(key, len(self._cells))
        if row >= len(self._bins["rula"]):
            more = max(16, row)
            self._bins = {name: np.r_[bins, np.zeros((more, bins.shape[1]))] for name, bins in self._bins.items()}
        return row


def _cells(frames: Frames) -> tuple[list[tuple[int, ...]], np.ndarray]:
    """Station, task and product of each cell of a stretch, and (N,) in which of them each frame is.

    NOTE: looked for among runs of frames of one row of the log, of which there are a hundred times fewer.
    """
    first = np.flatnonzero(np.r_[True, frames.row[1:] != frames.row[:-1]])
    named = np.stack([frames.station[first], frames.task[first], frames.product[first]], axis=1)
    keys, cell = np.unique(named, axis=0, return_inverse=True)
    return [tuple(key) for key in keys.tolist()], np.repeat(cell.ravel(), np.diff(np.r_[first, len(frames)]))


def _places(frames: Frames, scores: Any) -> dict[str, np.ndarray]:
    """By the names of ``BINS``: (N,) the column of each frame, 0 where it is not known."""
    found: dict[str, np.ndarray] = {}
    for name in ("rula", "reba", "owas"):
        both = getattr(scores, name)
        found |= {name: both[:, 0].astype(int), name + AT_MOST: both[:, 1].astype(int)}
    angles = {"trunk": frames.measures[:, AT["trunk_flexion"]], "arm": np.fmax(*frames.measures[:, ARMS].T)}
    return found | {name: _degree(name, angle) for name, angle in angles.items()}


def _degree(name: str, angle: np.ndarray) -> np.ndarray:
    first, n = BINS[name]
    place = np.clip(np.floor(np.nan_to_num(angle)).astype(int) - first, 0, n - 1)
    return np.where(np.isnan(angle), 0, 1 + place)


REGIONS = ("trunk", "neck", "arms", "wrists", "legs", "load", "time")
"""``arms`` are the upper arms and forearms; ``time`` is what repeating or holding adds."""
LEVELS = (5, 7)
EVERY = 8
"""Of frames at a high score each so-manieth is looked at, and stands for those about it."""
_WEIGHTS = np.array([factorial(n) * factorial(6 - n) / factorial(7) for n in range(7)])


class Regions:
    """A fold over the frames of a day. ``seconds``: (workers, regions, levels) of time at RULA 5 (7) or more, by the
    least that it may be, dealt out to the regions by how many points of the score each brings in.

    So those of all regions sum to the time at that score. Source of the shares: Shapley 1953, as ``explained.explain``.
    """

    def __init__(self, plan: Plan):
        self._plan = plan
        self.seconds = np.zeros((len(plan.workers), len(REGIONS), len(LEVELS)))

    def add(self, frames: Frames, scores: Scores) -> None:
        """Count a stretch."""
        for task in np.unique(frames.task[scores.rula[:, 0] >= LEVELS[0]]).tolist():
            rows = np.flatnonzero((frames.task == task) & (scores.rula[:, 0] >= LEVELS[0]))
            sample = rows[(EVERY - 1) // 2 :: EVERY] if rows.size > EVERY else rows
            share = shares(points(frames.some(sample), said_of(task, self._plan), self._plan.ergonomics))
            for column, level in enumerate(LEVELS):
                self.seconds[frames.worker, :, column] += _dealt(frames, scores, rows, sample, share, level)


def _dealt(frames: Frames, scores: Scores, rows: np.ndarray, sample: np.ndarray, share: np.ndarray, level: int):
    """(regions,) seconds of ``rows`` at a level or more, dealt out as their sample is; as all of it where none is."""
    whole_s = frames.seconds[rows[scores.rula[rows, 0] >= level]].sum()
    weight = frames.seconds[sample] * (scores.rula[sample, 0] >= level)
    weight = weight if weight.sum() > 0 else frames.seconds[sample]
    return whole_s * (weight @ share) / weight.sum()


def points(frames: Frames, bounds: Bounds, options: Options) -> np.ndarray:
    """(N, regions) points of RULA that each brings in, of frames of one task: together the middle of the least and the
    most that it may be, less 1."""
    from opsim.ergonomics.kernels import scores as kernel
    from opsim.ergonomics.kernels.scores import drive

    rows = [kernel.NECK, kernel.TRUNK, kernel.LEGS]
    rows += [kernel.ARM + side * kernel.ARM_CODES + part for side in range(2) for part in range(3)]
    phases = phases_of(bounds)
    force = kernel.FORCE if options.rula_force == "paper" else kernel.FORCE_WORKSHEET
    codes, found = np.empty((len(frames), 9, 2), np.int64), np.empty((len(frames), len(REGIONS)))
    edges, at, own = edges_of(options.thresholds), places(), np.empty((kernel.ARM + 2 * kernel.ARM_CODES, 2), np.int64)
    for n, (row, carrying) in enumerate(zip(np.asarray(frames.measures, float), frames.carrying)):
        kernel.find_codes(row, at, edges, phases[int(carrying)], bounds.walking, own)
        codes[n] = own[rows]
    time = np.stack([frames.repeated | frames.static, frames.carrying], axis=1).astype(np.int64)
    tables = tables_of(options.rula_table_a, options.owas_disputed)[:3]
    drive(codes, np.ascontiguousarray(phases[:, [kernel.FOREARM, force]]), time, _WEIGHTS, *tables, found)
    return found


def shares(found: np.ndarray) -> np.ndarray:
    """(N, regions) of points, each row made to sum to 1."""
    return found / found.sum(axis=1, keepdims=True)


MINUTE_S = 60.0


@dataclass(frozen=True)
class Timeline:
    """W workers, M minutes; every array but edges is (W, M).

    edge_s : (M + 1,) seconds of the run at which minutes begin and the last one ends
    known_s, unknown_s : seconds of work (walking, waiting) whose posture is known, and not; the rest is none of these
    rula_low, rula_high : mean over the known time, nan where there is none
    from_5_s, from_5_at_most_s : known seconds at RULA 5 or more, at least and at most
    """

    edge_s: np.ndarray
    known_s: np.ndarray
    unknown_s: np.ndarray
    rula_low: np.ndarray
    rula_high: np.ndarray
    from_5_s: np.ndarray
    from_5_at_most_s: np.ndarray


def timeline(log: EventLog, plan: Plan) -> Timeline:
    """The window of a replication, minute by minute. Raises what ``days`` raises."""
    minutes = Minutes(plan)
    fold(log, plan, [minutes])
    return minutes.close()


class Minutes:
    """A fold that sums scores by worker and minute of the run; a frame that lies in two minutes is shared out."""

    def __init__(self, plan: Plan):
        low, high = plan.window_s
        self._first, last = int(low // MINUTE_S), int(np.ceil(high / MINUTE_S))
        self._sums = np.zeros((len(plan.workers), 6, max(last - self._first, 1)))

    def add(self, frames: Frames, scores: Scores) -> None:
        """The next stretch."""
        frame, minute, seconds = _by_minute(frames)
        known = scores.rula[frame, 0] > 0
        low, high = (np.where(known, scores.rula[frame, bound], 0) for bound in (0, 1))
        for at, counted in enumerate((known, ~known, low, high, low >= 5, high >= 5)):
            n = self._sums.shape[2]
            self._sums[frames.worker, at] += np.bincount(minute - self._first, seconds * counted, n)[:n]

    def close(self) -> Timeline:
        """All that was summed."""
        known_s, unknown_s, low, high, from_5_s, at_most_s = np.moveaxis(self._sums, 1, 0)
        edge_s = MINUTE_S * (self._first + np.arange(self._sums.shape[2] + 1))
        some_s = np.where(known_s > 0, known_s, np.nan)
        return Timeline(edge_s, known_s, unknown_s, low / some_s, high / some_s, from_5_s, at_most_s)


def _by_minute(frames: Frames) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Frames cut at full minutes, (K,) each: which frame, in which minute of the run, for how many seconds."""
    first = np.floor(frames.start_s / MINUTE_S).astype(int)
    last = np.maximum(np.ceil(frames.end_s / MINUTE_S).astype(int) - 1, first)
    times = last - first + 1
    frame = np.repeat(np.arange(len(frames)), times)
    minute = first[frame] + np.arange(frame.size) - np.repeat(np.cumsum(times) - times, times)
    begin_s = np.maximum(frames.start_s[frame], MINUTE_S * minute)
    end_s = np.minimum(frames.end_s[frame], MINUTE_S * (minute + 1))
    return frame, minute, np.where(times[frame] == 1, frames.seconds[frame], np.maximum(end_s - begin_s, 0.0))
