"""Walks as bodies: each as long as the way that is drawn, from the scenario's walking emulator or the shipped one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from opsim.ergonomics.walks import drawable, drawn_walks, walk_again
from opsim.log import EventLog
from opsim.one_thread import one_blas_thread
from opsim.plan import Plan
from opsim.plan.walking import WalkingPlan
from opsim.streams import BLOCK
from opsim.viewer.played import Collected, rows_of
from opsim.viewer.skeletons import path_of
from opsim.walks import walks_of

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
            own_m[rows] = _gone_m(some)
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


def _gone_m(some: Any) -> np.ndarray:
    """(n,) how far walks lead ahead, in their own frame."""
    if hasattr(some, "distance_m"):
        return np.asarray(some.distance_m)
    return path_of(some, np.asarray(some.duration_s)[:, None])[:, 0, 0]
