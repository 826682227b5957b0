"""What walking asks of bodies: how long, how many steps, and how far trunks were flexed meanwhile."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.ergonomics.exposure import DEGREES, Exposure, add_flexion
from opsim.ergonomics.pieces import Pieces
from opsim.ergonomics.walks import drawable, drawn_walks
from opsim.log import EventLog
from opsim.one_thread import one_blas_thread
from opsim.plan import Plan
from opsim.streams import BLOCK
from opsim.walks import Walks, walks_of

LOOKED_AT = 16
"""Walks of a worker and replication whose postures are looked at; of more, these stand for all, each for as long.

Making a walk's postures takes a hundred times as long as drawing it. One walk of somebody is like the next: of made
walks 8, 16, 32 and 64 gave mean and quantiles within 0.01 degrees of each other, and where the mean of a walk scatters
by a degree 16 leave a quarter of one in a replication.
"""
STRETCH = 1.5
"""Walks looked at together differ in length by at most this factor: each is as often as the longest."""


@dataclass(frozen=True)
class Walked:
    """What walking asked of W workers in the window.

    exposure : of their trunks while they walked; ``unmeasured_s`` are walks that the emulator cannot draw
    metres, steps : (W,) of the walks that it can
    """

    exposure: Exposure
    metres: np.ndarray
    steps: np.ndarray

    def together(self) -> Walked:
        """All workers as one."""
        metres, steps = (values.sum(keepdims=True) for values in (self.metres, self.steps))
        return Walked(self.exposure.together(), metres, steps)


def walking_exposure(log: EventLog, plan: Plan) -> Walked:
    """The walking of each worker of a plan that names a walking emulator, from the rows of one replication of it.

    Raises ValueError where the emulator gives postures of a shape it should not.
    """
    assert plan.walking is not None
    n, walks = len(plan.workers), walks_of(log, plan)
    pieces = _pieces(walks, *plan.window_s)
    can = drawable(plan.walking.model, walks.distance_m)
    unmeasured_s = np.bincount(walks.worker[~can], pieces.seconds[~can], n)
    found = Walked(Exposure(np.zeros((n, DEGREES.size - 1)), np.zeros(n), unmeasured_s), np.zeros(n), np.zeros(n))
    wanted = can & (pieces.seconds > 0)
    looked = pieces._replace(seconds=stood_for(walks, np.where(wanted, pieces.seconds, 0.0)))
    with one_blas_thread(), said_by(plan.walking.name):
        for rows, block in drawn_walks(walks, plan, log.replication, wanted):
            _count(found, walks, rows[wanted[rows]], block, pieces)
            _look(found, walks, rows[looked.seconds[rows] > 0], block, looked)
    return found


def _pieces(walks: Walks, low: float, high: float) -> Pieces:
    """Walks as pieces of work that has no task, from and to where they are at the edges of the window."""
    begin_s, end_s = np.clip(walks.start_s, low, high), np.clip(walks.end_s, low, high)
    first, last = ((at_s - walks.start_s) / walks.whole_s for at_s in (begin_s, end_s))
    return Pieces(walks.worker, np.full(walks.k.size, -1), walks.k, first, last, end_s - begin_s)


def stood_for(walks: Walks, seconds: np.ndarray) -> np.ndarray:
    """(R,) seconds of walking that each walk stands for, 0 where it is not looked at; those of a worker sum to his.

    Of many walks, every so many seconds of them put in a row by length, one is taken: a systematic sample with
    probabilities in proportion to time, as every length has its share in it.
    Source: Madow 1949, On the theory of systematic sampling II, Annals of Mathematical Statistics 20(3).
    """
    stands = np.zeros(seconds.size)
    for rank in np.unique(walks.worker):
        own = np.flatnonzero((walks.worker == rank) & (seconds > 0))
        if own.size <= LOOKED_AT:
            stands[own] = seconds[own]
            continue
        own = own[np.argsort(walks.distance_m[own], kind="stable")]
        until_s = np.cumsum(seconds[own])
        points = (np.arange(LOOKED_AT) + 0.5) / LOOKED_AT * until_s[-1]
        times = np.bincount(np.searchsorted(until_s, points), minlength=own.size)
        stands[own] = times * until_s[-1] / LOOKED_AT
    return stands


def _count(found: Walked, walks: Walks, rows: np.ndarray, block: Any, pieces: Pieces) -> None:
    """Add metres and steps of some walks of one block."""
    share = (pieces.progress_to - pieces.progress_from)[rows]
    if rows.size:
        found.metres[walks.worker[rows[0]]] += walks.distance_m[rows] @ share
        found.steps[walks.worker[rows[0]]] += n_steps(block)[walks.k[rows] % BLOCK] @ share


def n_steps(block: Any) -> np.ndarray:
    """(n,) steps that walks take: what they say themselves, else how often a foot comes down (``beat_s``, nan none)."""
    said = getattr(block, "n_steps", None)
    return np.asarray(np.isfinite(block.beat_s).sum(axis=1) if said is None else said, float)


def _look(found: Walked, walks: Walks, rows: np.ndarray, block: Any, looked: Pieces) -> None:
    """Add what trunks go through in some walks of one block."""
    for some in _of_like_length(walks.distance_m[rows]):
        add_flexion(found.exposure, *_apart(block, looked.some(rows[some])))


def _apart(block: Any, pieces: Pieces) -> tuple[Any, Pieces]:
    """Some walks of a block by themselves, where they can be taken out: then long ones beside them cost nothing."""
    if not hasattr(type(block), "__getitem__"):
        return block, pieces
    return block[pieces.k % BLOCK], pieces._replace(k=np.arange(pieces.k.size))


@contextmanager
def said_by(name: str) -> Iterator[None]:
    """What goes wrong in here is said with the emulator's name."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"walking ({name}): {error}") from error


def _of_like_length(distance_m: np.ndarray) -> Iterator[np.ndarray]:
    """Rows in groups within which no walk is longer than another by more than ``STRETCH``."""
    order = np.argsort(distance_m, kind="stable")
    while order.size:
        n = int(np.searchsorted(distance_m[order], STRETCH * distance_m[order[0]], side="right"))
        yield np.sort(order[:n])
        order = order[n:]
