"""Decisions of a fully sequential procedure at one replication: who beats whom, who keeps the limits, who is out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opsim.study.select.selection import CHOSEN, NONE_WITHIN, RAN_OUT, TIED, Asked, Out

ROUNDING = 1e-9
"""Differences below this share of the sums are of the order in which numbers were added, not of the systems."""


@dataclass(slots=True)
class Race:
    """What is decided so far. beats : (k, k), 1 where row beat column; within : (k, L), 1 kept, -1 broken, 0 open."""

    alive: np.ndarray
    beats: np.ndarray
    within: np.ndarray
    n: np.ndarray


def decide(
    race: Race, sums: np.ndarray, pair_room: np.ndarray, limit_room: np.ndarray, asked: Asked, r: int
) -> list[Out]:
    """Every decision that can be taken at the r-th replication, each once and for all; who is thrown out by them."""
    over = np.where(np.abs(sums[:, 1:]) <= ROUNDING * r * _bounds(asked), 0.0, sums[:, 1:])
    race.within[(race.within == 0) & (over <= -limit_room)] = 1
    race.within[(race.within == 0) & (over > limit_room)] = -1
    apart = sums[:, None, 0] - sums[None, :, 0]
    apart[np.abs(apart) <= ROUNDING * np.abs(sums[:, 0]).max()] = 0.0
    race.beats[open_pairs(race) & (apart > pair_room)] = 1
    beyond = race.alive & (race.within < 0).any(axis=1)
    judges = race.alive & (race.within > 0).all(axis=1)
    beaten = race.alive & ~beyond & (race.beats[judges] > 0).any(axis=0)
    race.alive &= ~(beyond | beaten)
    found = []
    for i in np.flatnonzero(beyond | beaten):
        if beyond[i]:
            limit = asked.limits[int(np.argmax(race.within[i] < 0))].name
            found.append(Out(asked.systems[i], r, limit=limit))
        else:
            by = max(np.flatnonzero(judges & (race.beats[:, i] > 0)), key=lambda j: (race.alive[j], sums[j, 0], -j))
            found.append(Out(asked.systems[i], r, by=asked.systems[by]))
    return found


def _bounds(asked: Asked) -> np.ndarray:
    return np.array([abs(limit.bound) for limit in asked.limits])


def open_pairs(race: Race) -> np.ndarray:
    """(k, k) which two of those left nobody has told apart."""
    open_yet = race.alive[:, None] & race.alive[None] & (race.beats == 0) & (race.beats.T == 0)
    np.fill_diagonal(open_yet, False)
    return open_yet


def open_limits(race: Race) -> np.ndarray:
    """(k, L) of which limits nobody knows whether those left keep them."""
    return np.asarray(race.alive[:, None] & (race.within == 0))


def ended_how(race: Race, begun: np.ndarray, r: int, most: int) -> str:
    """How it ended; "" where it goes on. begun : (k, k) where triangles begin, 0 of two that never differed"""
    left = np.flatnonzero(race.alive)
    if not left.size:
        return NONE_WITHIN
    if (race.within[left] > 0).all():
        if left.size == 1:
            return CHOSEN
        if not begun[np.ix_(left, left)].any():
            return TIED
    return RAN_OUT if r >= most else ""


def names_of(asked: Asked, alive: np.ndarray) -> tuple[str, ...]:
    """The systems that are left. alive : (k,)"""
    return tuple(name for name, here in zip(asked.systems, alive) if here)
