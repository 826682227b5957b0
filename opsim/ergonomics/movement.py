"""Movements outside a run, recorded or drawn: measured, scored, and told in figures."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from opsim.ergonomics.bounds import Bounds
from opsim.ergonomics.holds import STATIC, StaticMarker
from opsim.ergonomics.options import USUAL, Options
from opsim.ergonomics.scoring import Scores, score


@dataclass(frozen=True, eq=False)
class Movement:
    """N postures of somebody, one after the other.

    name     : which take or draw
    seconds  : (N,) for how long each stands
    measures : (N, COLUMNS) by ``columns.py``; all nan where nothing is known of a posture
    body     : posture number -> joints (J, 3) in metres, z up
    """

    name: str
    seconds: np.ndarray
    measures: np.ndarray
    body: Callable[[int], np.ndarray]

    @cached_property
    def known(self) -> np.ndarray:
        """(N,) whether anything is known of the posture."""
        return ~np.isnan(self.measures).all(axis=1)

    @cached_property
    def start_s(self) -> np.ndarray:
        """(N,) seconds from the start of the movement."""
        return np.cumsum(self.seconds) - self.seconds

    @property
    def duration_s(self) -> float:
        return float(self.seconds.sum())


@dataclass(frozen=True, eq=False)
class ScoredMovement:
    """A movement with the scores of its N postures, and which of them are held for more than a minute (N,)."""

    movement: Movement
    scores: Scores
    static: np.ndarray


def scored_movements(
    movements: Sequence[Movement], bounds: Bounds, options: Options = USUAL, *, repeated: bool = False
) -> list[ScoredMovement]:
    """Each movement scored; ``repeated`` says of all whether they are done again and again, as no movement tells."""
    return [_scored(movement, bounds, options, repeated) for movement in movements]


def _scored(movement: Movement, bounds: Bounds, options: Options, repeated: bool) -> ScoredMovement:
    static = _held(movement)
    return ScoredMovement(movement, score(movement.measures, bounds, options, repeated, static), static)


def _held(movement: Movement) -> np.ndarray:
    """(N,) in which postures some region is held statically."""
    marker = StaticMarker(STATIC)
    marks = [*marker.push(0, movement.start_s, movement.seconds, movement.measures), *marker.close()]
    return np.asarray(np.concatenate(marks).any(axis=1), bool)


def worst_postures(scored: Sequence[ScoredMovement], n: int = 6, apart_s: float = 1.0) -> Iterator[tuple[int, int]]:
    """(movement, posture) numbers of the n that score highest, the worst first, none within ``apart_s`` of another.

    By the middles of RULA, then REBA, then OWAS between their bounds: RULA ends at 7, where REBA still tells apart.
    """
    order = [(-rank, which, posture) for which, one in enumerate(scored) for posture, rank in _ranks(one)]
    taken: list[tuple[int, float]] = []
    for _, which, posture in sorted(order):
        movement = scored[which].movement
        at_s = float(movement.start_s[posture])
        if all(which != other or abs(at_s - when_s) >= apart_s for other, when_s in taken):
            taken.append((which, at_s))
            yield which, posture
            if len(taken) == n:
                return


def _ranks(one: ScoredMovement) -> list[tuple[int, float]]:
    """Posture and rank, as one number, of all known postures: the rank's digits are the sums of low and high."""
    rula, reba, owas = (getattr(one.scores, name).astype(float).sum(axis=1) for name in ("rula", "reba", "owas"))
    ranks = rula * 1e4 + reba * 1e2 + owas
    return [(posture, float(ranks[posture])) for posture in np.flatnonzero(one.movement.known).tolist()]
