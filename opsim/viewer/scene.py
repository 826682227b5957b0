"""A replication as a scene: where everything stands, and where everybody is, in which posture, at any time."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

NONE = -1
"""In place of a rank or a row: there is none."""


@dataclass(frozen=True)
class Bench:
    """A station as it stands on the floor.

    x_m, y_m : the middle of the bench; facing_rad : from who stands there towards it; capacity : of the buffer
    buffer_m : where jobs wait in front of it; levels_m : heights of the boards of a rack, none of a bench
    """

    name: str
    place: int
    x_m: float
    y_m: float
    facing_rad: float
    width_m: float
    depth_m: float
    height_m: float
    automatic: bool
    buffer_m: tuple[float, float]
    capacity: int | None
    levels_m: tuple[float, ...] = ()


@dataclass(frozen=True)
class Pile:
    """A store: where it stands, and how much it holds."""

    name: str
    x_m: float
    y_m: float
    capacity: int | None


@dataclass(frozen=True)
class Belt:
    """A conveyor, from point to point."""

    name: str
    points_m: tuple[tuple[float, float], ...]


@dataclass(frozen=True, eq=False)
class Segments:
    """What each worker does, by worker and time, (R,) each; those of worker ``w`` are rows first[w] to first[w + 1].

    state, task, product, job : ranks, NONE where there is none; station : number among benches, then piles, then belts
    performance : row of ``Performed``, or NONE; from_s, to_s : own seconds of it at the start and at the end
    x_m, y_m, yaw_rad : where its own frame begins and which way it looks, or where he stands
    dx_m, dy_m : how far he is carried until the end; way : row of ``Ways``, or NONE
    """

    first: np.ndarray
    start_s: np.ndarray
    end_s: np.ndarray
    state: np.ndarray
    station: np.ndarray
    task: np.ndarray
    product: np.ndarray
    job: np.ndarray
    performance: np.ndarray
    from_s: np.ndarray
    to_s: np.ndarray
    x_m: np.ndarray
    y_m: np.ndarray
    yaw_rad: np.ndarray
    dx_m: np.ndarray
    dy_m: np.ndarray
    way: np.ndarray

    def row(self, worker: int, time_s: float) -> int:
        """The segment of a worker at a time; an instant between two is of the later."""
        begin, end = int(self.first[worker]), int(self.first[worker + 1])
        at = begin + int(np.searchsorted(self.start_s[begin:end], time_s, side="right")) - 1
        return min(max(at, begin), end - 1)


@dataclass(frozen=True, eq=False)
class Ways:
    """Drawn ways: the points of way ``i`` are rows first[i] to first[i + 1] of x_m, y_m.

    own_m : how long the walk that goes it is in its own frame, 0 of what does not walk
    yaw_from, yaw_to : which way he looks before and after, nan where that is not known
    """

    first: np.ndarray
    x_m: np.ndarray
    y_m: np.ndarray
    own_m: np.ndarray
    yaw_from: np.ndarray
    yaw_to: np.ndarray

    def points_m(self, way: int) -> np.ndarray:
        """(P, 2) of one way."""
        rows = slice(int(self.first[way]), int(self.first[way + 1]))
        return np.column_stack([self.x_m[rows], self.y_m[rows]])


@dataclass(frozen=True, eq=False)
class Drawn:
    """Performances of one model, block by block, in the order of their rows.

    first : (blocks + 1,) the row with which each block begins
    """

    name: str
    skeleton: Any
    blocks: Sequence[Any]
    first: tuple[int, ...]

    def one(self, row: int) -> tuple[Any, int]:
        """The block of a row, and its place there."""
        at = bisect_right(self.first, row) - 1
        return self.blocks[at], row - self.first[at]

    def __len__(self) -> int:
        return self.first[-1]


@dataclass(frozen=True, eq=False)
class Performed:
    """All performances that are shown: of which of ``drawn`` each is, and which row there, (N,) each."""

    drawn: tuple[Drawn, ...]
    model: np.ndarray
    row: np.ndarray

    def one(self, performance: int) -> tuple[Any, int]:
        """Its block, and its row there."""
        return self.drawn[int(self.model[performance])].one(int(self.row[performance]))


@dataclass(frozen=True, eq=False)
class Standing:
    """How each worker stands: directions (B, 3) of a skeleton's bones, and lengths (W, B) of his own."""

    skeleton: Any
    directions: np.ndarray
    bone_m: np.ndarray


@dataclass(frozen=True, eq=False)
class Courses:
    """Numbers that change in steps, of some subjects: subject ``i`` has rows first[i] to first[i + 1].

    columns : by name, (R,) each, from ``at_s`` on
    """

    first: np.ndarray
    at_s: np.ndarray
    columns: dict[str, np.ndarray]


@dataclass(frozen=True, eq=False)
class Moves:
    """Parts under way, (R,) each; kind : 0 on a belt, 1 on a vehicle, 2 in somebody's hands; worker, way : or NONE."""

    start_s: np.ndarray
    end_s: np.ndarray
    kind: np.ndarray
    worker: np.ndarray
    product: np.ndarray
    way: np.ndarray


@dataclass(frozen=True, eq=False)
class Scene:
    """A window of one replication of one variant.

    start_s : the clock when the run begins, seconds after Monday 00:00; low_s, high_s : the window, on the run's clock
    states, station_states : names, as numbers of ``Segments.state`` and the courses of stations stand for them
    rula : (W, Q) four a second, least score in the low half of each byte and most in the high one; None: not measured
    reach_m : west, south, east and north end of where people come, None where nobody is there
    notes : (topic, words) of what is shown otherwise than it was
    """

    name: str
    title: str
    replication: int
    start_s: float
    low_s: float
    high_s: float
    states: tuple[str, ...]
    station_states: tuple[str, ...]
    places: tuple[tuple[str, float, float], ...]
    roads: tuple[tuple[float, float, float, float], ...]
    benches: tuple[Bench, ...]
    piles: tuple[Pile, ...]
    belts: tuple[Belt, ...]
    products: tuple[str, ...]
    tasks: tuple[tuple[str, bool], ...]
    workers: tuple[tuple[str, float | None], ...]
    segments: Segments
    ways: Ways
    performed: Performed
    standing: Standing
    stations: Courses
    stores: Courses
    moves: Moves
    rula: np.ndarray | None
    reach_m: tuple[float, float, float, float] | None
    notes: tuple[tuple[str, str], ...]


def taken(part: Any, rows: np.ndarray) -> Any:
    """The same with some rows of every array."""
    return type(part)(*(getattr(part, one.name)[rows] for one in fields(part)))
