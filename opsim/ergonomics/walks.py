"""Every walk of an EventLog, drawn from the walking emulator of the plan.

Walk k of a worker is row k mod 64 of block k // 64 of the stream ("walk", worker), drawn with the lengths that the
walks of that block have and with the worker's own speed. What is random in a row does not depend on the lengths of
the others, so any walk can be had again alone (``walk_again``). How long a walk takes is the engine's affair, distance
/ speed: a drawn walk covers the same way, and is stretched to that time.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from opsim.effects import worker_effect
from opsim.ergonomics.pieces import alike
from opsim.one_thread import one_blas_thread
from opsim.performance import Drawn
from opsim.plan import Plan
from opsim.streams import BLOCK, stream
from opsim.walks import Walks

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
