"""Every walk of an EventLog, drawn from the walking emulator of the plan.

Walk k of a worker is row k mod 64 of block k // 64 of the stream ("walk", worker), drawn with the lengths that the
walks of that block have and with the worker's own speed. What is random in a row does not depend on the lengths of
the others, so any walk can be had again alone (``walk_again``). How long a walk takes is the engine's affair, distance
/ speed: a drawn walk covers the same way, and is stretched to that time.

What walking asks of bodies: how long, how many steps, and how far trunks were flexed meanwhile.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from opsim.ergonomics.redraw import Pieces, alike
from opsim.ergonomics.trunk import DEGREES, Exposure, add_flexion
from opsim.history import Walks, walks_of
from opsim.log import EventLog
from opsim.performance import Drawn
from opsim.plan import Plan
from opsim.streams import BLOCK, stream
from opsim.threads import one_blas_thread
from opsim.worker_effects import worker_effect

NAME = "walk"
"""Streams: ``walk, worker`` for his walks, ``effect, worker, walk`` for how he walks."""
SHORTEST_M, LONGEST_M = 0.05, 1000.0
"""Walks that are drawn, where the emulator does not say its own shortest; others are not measured."""


def drawn_walks(
    walks: Walks, plan: Plan, replication: int, wanted: np.ndarray | None = None
) -> Iterator[tuple[np.ndarray, Any]]:
    """(rows of ``walks``, their block of performances), block by block; walk k is row k mod 64 of its block.

    wanted : (R,) blocks without a wanted walk are left out, and so are those none of whose walks can be drawn
    """
    wanted = np.ones(walks.k.size, bool) if wanted is None else wanted
    for rank in np.unique(walks.worker[wanted]).tolist():
        own = np.flatnonzero(walks.worker == rank)
        effect = walker(plan, rank, replication)
        for some in alike(walks.k[own] // BLOCK):
            rows = own[some]
            if wanted[rows].any():
                k, lengths_m = walks.k[rows], walks.distance_m[rows]
                block = _block(plan, rank, replication, int(k[0]) // BLOCK, effect, k % BLOCK, lengths_m)
                if block is not None:
                    yield rows, block


def walk_again(plan: Plan, replication: int, rank: int, k: int, distance_m: float) -> Drawn:
    """The k-th walk of a worker in a replication, over its way: the same body as in the block of all his walks."""
    with one_blas_thread():
        effect = walker(plan, rank, replication)
        row = np.array([k % BLOCK])
        block = _block(plan, rank, replication, k // BLOCK, effect, row, np.array([distance_m]))
    if block is None:
        assert plan.walking is not None
        raise ValueError(f"{plan.walking.name}: no walk of {distance_m:g} m can be drawn")
    return Drawn(block, k % BLOCK)


def walker(plan: Plan, rank: int, replication: int) -> Any:
    """How a worker walks: his own effect in the walking emulator; how fast is the plan's to say, not his pace."""
    assert plan.walking is not None
    person, workforce = plan.workers[rank], plan.workforce_of(replication)
    body = replace(person.body, pace=None)
    return worker_effect(plan.walking.model, NAME, person.name, plan.seed, workforce, body, plan.across_tasks)


def drawable(model: Any, distance_m: np.ndarray) -> np.ndarray:
    """(n,) whether the emulator can draw walks of some lengths: no shorter than its shortest, none beyond LONGEST_M."""
    return (distance_m >= getattr(model, "shortest_m", SHORTEST_M)) & (distance_m <= LONGEST_M)


def _block(
    plan: Plan, rank: int, replication: int, number: int, effect: Any, rows: np.ndarray, lengths_m: np.ndarray
) -> Any:
    """A block of 64 walks, some rows with their lengths; the others, which nobody asks for, with the least of these."""
    assert plan.walking is not None
    model, person = plan.walking.model, plan.workers[rank]
    can = drawable(model, lengths_m)
    if not can.any():
        return None
    distance_m = np.full(BLOCK, lengths_m[can].min())
    distance_m[rows[can]] = lengths_m[can]
    rng = stream(plan.seed, replication, NAME, person.name, number)
    condition = {"distance_m": distance_m, "speed_m_per_s": np.full(BLOCK, person.walk_m_per_s)}
    return model.sample(BLOCK, rng, worker=effect, condition=condition)


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
