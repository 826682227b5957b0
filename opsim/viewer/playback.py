"""The performances behind the rows of a window, drawn again, and which of them each row shows, from when to when.

Walks as bodies: each as long as the way that is drawn, from the scenario's walking emulator or the shipped one.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from opsim.ergonomics.measures import has_body
from opsim.ergonomics.redraw import Pieces, drawn_again, pieces_of, worked_rows
from opsim.ergonomics.walking import drawable, drawn_walks, walk_again
from opsim.history import walks_of
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.streams import BLOCK
from opsim.subjects.people.plan import WalkingPlan
from opsim.threads import one_blas_thread
from opsim.viewer.scene import Drawn, Performed
from opsim.viewer.skeletons import path_of

FAR_M = 0.5
"""Who goes further than this in a task is placed so that he ends before the bench."""
LOOKED_AT = 16


@dataclass(frozen=True, eq=False)
class Played:
    """By log row (rows,): the performance it shows, or -1, and the own seconds of that at its start and end."""

    performance: np.ndarray
    from_s: np.ndarray
    to_s: np.ndarray


class Collected:
    """Performances by what draws them, as they are found."""

    def __init__(self) -> None:
        self._sets: dict[Any, _Set] = {}
        self._model: list[np.ndarray] = []
        self._row: list[np.ndarray] = []
        self.n = 0

    def add(self, key: Any, name: str, some: Any) -> int:
        """More performances of one model; the number of the first."""
        own = self._sets.setdefault(key, _Set(len(self._sets), name, some.skeleton))
        n = len(some.duration_s)
        self._model.append(np.full(n, own.number))
        self._row.append(own.first[-1] + np.arange(n))
        own.blocks.append(some)
        own.first.append(own.first[-1] + n)
        self.n += n
        return self.n - n

    def close(self) -> Performed:
        """All of them."""
        drawn = tuple(Drawn(s.name, s.skeleton, tuple(s.blocks), tuple(s.first)) for s in self._sets.values())
        model, row = (np.concatenate([np.zeros(0, int), *parts]) for parts in (self._model, self._row))
        return Performed(drawn, model, row)


@dataclass
class _Set:
    number: int
    name: str
    skeleton: Any
    blocks: list[Any] = field(default_factory=list)
    first: list[int] = field(default_factory=lambda: [0])


def played(log: EventLog, plan: Plan, low_s: float, high_s: float, found: Collected) -> Played:
    """Every piece of work that lies between two times; bodies are added to ``found``.

    Raises ValueError where a task's model draws what is no time.
    """
    rows = worked_rows(log, low_s, high_s)
    rows = rows[(log["end_s"][rows] > log["start_s"][rows]) & (log["k"][rows] >= 0)]
    rows = rows[np.lexsort([log[name][rows] for name in ("start_s", "k", "task", "worker")])]
    shown = Played(np.full(len(log), -1), np.zeros(len(log)), np.zeros(len(log)))
    begin = 0
    with one_blas_thread():
        for block, pieces in drawn_again(pieces_of(log, rows, -np.inf, np.inf), log.replication, plan):
            here = rows[begin : begin + pieces.k.size]
            begin += pieces.k.size
            if has_body(block):
                _add(found, block, pieces, plan.tasks[int(pieces.task[0])].name, here, shown)
    return shown


def _add(found: Collected, block: Any, pieces: Pieces, task: str, rows: np.ndarray, shown: Played) -> None:
    """The performances of a block that have pieces, each once."""
    k, which = np.unique(pieces.k, return_inverse=True)
    some = rows_of(block, k % BLOCK)
    first = found.add(id(some.model) if is_of_coefficients(some) else ("task", task), task, some)
    duration_s = np.asarray(some.duration_s, dtype=float)[which]
    shown.performance[rows] = first + which
    shown.from_s[rows] = pieces.progress_from * duration_s
    shown.to_s[rows] = pieces.progress_to * duration_s


def is_of_coefficients(block: Any) -> bool:
    """Whether performances are a ``MotionEmulator``'s, by duck typing: a path is quickly made."""
    return hasattr(getattr(block, "model", None), "rides")


def rows_of(block: Any, rows: np.ndarray) -> Any:
    """Some performances of a block: itself taken apart, or, where it cannot be, a view of those rows."""
    return block[rows] if hasattr(type(block), "__getitem__") else _Rows(block, rows)


class _Rows:
    """A few rows of a block of somebody's emulator that cannot be taken apart: decoded whole, then indexed."""

    def __init__(self, block: Any, rows: np.ndarray):
        self._block, self._rows = block, np.asarray(rows)
        self.skeleton = block.skeleton
        self.duration_s = np.asarray(block.duration_s)[self._rows]
        for name in ("directions", "path", "root_m"):
            if hasattr(block, name):
                setattr(self, name, self._asked(name))

    def __len__(self) -> int:
        return self._rows.size

    def __getitem__(self, index: Any) -> _Rows:
        return _Rows(self._block, np.atleast_1d(self._rows[index]))

    @property
    def bone_length_m(self) -> np.ndarray:
        """(n, B) metres, where the block tells."""
        return np.asarray(self._block.bone_length_m)[self._rows]

    def positions_m(self, times_s: np.ndarray) -> np.ndarray:
        """(n, T, J, 3) at times (n, T) or (T,)."""
        return np.asarray(self._asked("positions_m")(times_s))

    def _asked(self, name: str) -> Any:
        def asked(times_s: np.ndarray) -> np.ndarray:
            whole = np.zeros((len(self._block.duration_s), np.shape(times_s)[-1]))
            whole[self._rows] = times_s
            return np.asarray(getattr(self._block, name)(times_s=whole))[self._rows]

        return asked


def travels_m(performed: Performed) -> np.ndarray:
    """(N, 2) how far performances lead from where they begin, in their own frame; 0 of those whose model leads nowhere.

    NOTE: but for a ``MotionEmulator``'s the median of a few stands for all: making a composite's path takes 20 ms.
    """
    far = np.zeros((performed.model.size, 2))
    for number, drawn in enumerate(performed.drawn):
        usual = np.median(_gone_m(drawn.blocks[0][np.arange(min(len(drawn.blocks[0].duration_s), LOOKED_AT))]), axis=0)
        if np.hypot(*usual) > FAR_M:
            each = is_of_coefficients(drawn.blocks[0])
            gone = np.concatenate([_gone_m(block) for block in drawn.blocks]) if each else usual[None]
            mine = performed.model == number
            far[mine] = gone[performed.row[mine] if each else np.zeros(mine.sum(), int)]
    return far


def _gone_m(some: Any) -> np.ndarray:
    """(n, 2) from the first to the last place of the root."""
    path = path_of(some, np.asarray(some.duration_s)[:, None] * np.array([0.0, 1.0]))
    return np.asarray(path[:, 1, :2] - path[:, 0, :2])


LIBRARY, TASK = "libraries/walking.npz", "walk"
DRAWN_S = 1200.0
"""Seconds of walking that are drawn, at most: more makes the page large, and every walk costs 4 ms."""
ALIKE = ((1e-6, 10**9), *((0.01, most) for most in (64, 32, 16, 8, 4, 2, 1)), (0.03, 1), (0.1, 1), (0.3, 1))
"""(how far lengths may be apart, as a share, and how many) of walks of one worker that are drawn, tried in this order;
further ones repeat them in turn."""
STAND_M = 3.0
"""The walk by which it is known how long the bones of who never walks are."""


@dataclass(frozen=True, eq=False)
class Walked:
    """Some walks, (R,) each: the performance that shows it, how long that is on the floor, and how long it lasts.

    drawn : how many different walks there are
    """

    performance: np.ndarray
    own_m: np.ndarray
    duration_s: np.ndarray
    drawn: int


def with_walking(plan: Plan) -> tuple[Plan, str | None]:
    """The plan with an emulator of walking, and its name where it is the shipped one, in place of none.

    Streams are those of the plan with ``walking:`` so given: nothing else draws from them.
    """
    from opsim.libraries import load_library
    from opsim.shipped import shipped_folder

    if plan.walking is not None:
        return plan, None
    name = f"{LIBRARY.rpartition('/')[2].removesuffix('.npz')}/{TASK}"
    model = load_library(shipped_folder() / LIBRARY)[TASK]
    return replace(plan, walking=WalkingPlan(name, model)), name


def walked(log: EventLog, plan: Plan, which: np.ndarray, way_m: np.ndarray, found: Collected) -> Walked:
    """Walks ``which`` (R,) of all walks of a log, over ways of these lengths (R,); bodies are added to ``found``.

    Lengths that the emulator cannot draw are taken as the nearest that it can, and stretched to the way.
    """
    assert plan.walking is not None
    everything = walks_of(log, plan)
    long_m = np.clip(way_m, *_can_m(plan.walking.model))
    alike = stand_ins(everything.worker[which], long_m, everything.whole_s[which])
    lengths_m = everything.distance_m.copy()
    lengths_m[which] = long_m
    wanted = np.zeros(lengths_m.size, bool)
    wanted[which[alike]] = True
    first, own_m, own_s = (np.zeros(lengths_m.size, dtype) for dtype in (int, float, float))
    first[:] = -1
    with one_blas_thread():
        for rows, block in drawn_walks(replace(everything, distance_m=lengths_m), plan, log.replication, wanted):
            rows = rows[wanted[rows]]
            some = rows_of(block, everything.k[rows] % BLOCK)
            first[rows] = found.add("walk", plan.walking.name, some) + np.arange(rows.size)
            own_s[rows] = some.duration_s
            own_m[rows] = _way_m(some)
    shown = which[alike]
    return Walked(first[shown], own_m[shown], own_s[shown], int(wanted.sum()))


def stand_ins(worker: np.ndarray, long_m: np.ndarray, whole_s: np.ndarray) -> np.ndarray:
    """(R,) which walk each one is shown by: itself, or of one of its worker's about as long, those by turns."""
    for apart, most in ALIKE:
        length = np.rint(np.log(np.maximum(long_m, 1e-3)) / np.log1p(apart)).astype(np.int64)
        order = np.lexsort([np.arange(worker.size), length, worker])
        new = np.r_[True, (np.diff(length[order]) != 0) | (np.diff(worker[order]) != 0)][: order.size]
        begins = np.flatnonzero(new)
        n = np.diff(np.r_[begins, order.size])
        nth = np.arange(order.size) - np.repeat(begins, n)
        shown = np.empty(order.size, int)
        shown[order] = order[np.repeat(begins, n) + nth % most]
        if whole_s[np.unique(shown)].sum() <= DRAWN_S:
            return shown
    return shown


def bones_m(plan: Plan, replication: int, rank: int) -> tuple[Any, np.ndarray]:
    """(skeleton, lengths (B,)) of a worker as he walks."""
    from opsim.viewer.skeletons import tree_of, vectors_of

    drawn = walk_again(plan, replication, rank, 0, STAND_M)
    block = drawn.block
    if hasattr(block, "bone_length_m"):
        return block.skeleton, np.asarray(block.bone_length_m)[drawn.row]
    joints = drawn.decoded("positions_m", times_s=np.zeros(1))
    return block.skeleton, vectors_of(joints[0], tree_of(block.skeleton)[1])[1]


def _can_m(model: Any) -> tuple[float, float]:
    """The shortest and the longest walk that is drawn."""
    lengths_m = np.geomspace(0.01, 1000.0, 2000)
    can = lengths_m[drawable(model, lengths_m)]
    return float(can[0]), float(can[-1])


def _way_m(some: Any) -> np.ndarray:
    """(n,) how far walks lead ahead, in their own frame."""
    if hasattr(some, "distance_m"):
        return np.asarray(some.distance_m)
    return path_of(some, np.asarray(some.duration_s)[:, None])[:, 0, 0]
