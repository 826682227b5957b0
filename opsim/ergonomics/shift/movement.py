"""Movements outside a run, recorded or drawn: measured, scored, and told in figures.

What is told of scored movements: shares of the time at high scores and angles, means and extremes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from opsim.ergonomics.angles import AT
from opsim.ergonomics.options import USUAL, Options
from opsim.ergonomics.scores.scoring import Bounds, Scores, score
from opsim.ergonomics.strain.static_holds import STATIC, StaticMarker

ALIKE_DEG = 20.0
"""Postures no angle of which is further apart are told as one. Source: design."""
_LOOKED_AT = ("trunk_flexion", "trunk_side", "trunk_twist", "neck_flexion")
_OF_SIDES = ("arm_elevation", "elbow", "knee")
_BOTH = tuple(f"{side}_{name}" for name in _OF_SIDES for side in ("left", "right"))
LOOKED_AT = [AT[name] for name in (*_LOOKED_AT, *_BOTH)]


@dataclass(frozen=True, eq=False)
class Movement:
    """N postures of somebody, one after the other.

    name     : which take or draw
    seconds  : (N,) for how long each stands
    measures : (N, COLUMNS) by ``columns.py``; all nan where nothing is known of a posture
    body     : posture number -> joints (J, 3) in metres, z up
    carrying : (N,) whether the hands may hold something; None: all the time
    """

    name: str
    seconds: np.ndarray
    measures: np.ndarray
    body: Callable[[int], np.ndarray]
    carrying: np.ndarray | None = None

    def full(self, posture: int) -> bool:
        """Whether the hands may hold something in a posture."""
        return self.carrying is None or bool(self.carrying[posture])

    @cached_property
    def known(self) -> np.ndarray:
        """(N,) whether anything is known of the posture."""
        return ~np.isnan(self.measures).all(axis=1)

    @cached_property
    def start_s(self) -> np.ndarray:
        """(N,) seconds from the start of the movement."""
        return np.cumsum(self.seconds) - self.seconds

    @property
    def loaded_s(self) -> float:
        """For how long the hands may hold something."""
        return self.duration_s if self.carrying is None else float(self.seconds[self.carrying].sum())

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
    static, carrying = _held(movement), True if movement.carrying is None else movement.carrying
    scores = score(movement.measures, bounds, options, repeated, static, carrying)
    return ScoredMovement(movement, scores, static)


def _held(movement: Movement) -> np.ndarray:
    """(N,) in which postures some region is held statically."""
    marker = StaticMarker(STATIC)
    marks = [*marker.push(0, movement.start_s, movement.seconds, movement.measures), *marker.close()]
    return np.asarray(np.concatenate(marks).any(axis=1), bool)


def worst_postures(scored: Sequence[ScoredMovement], n: int = 6, apart_s: float = 1.0) -> Iterator[tuple[int, int]]:
    """(movement, posture) numbers of the n that score highest, the worst first, none within ``apart_s`` of another or
    ``alike`` another.

    By the middles of RULA, then REBA, then OWAS between their bounds: RULA ends at 7, where REBA still tells apart.
    """
    order = sorted((-rank, which, posture) for which, one in enumerate(scored) for posture, rank in _ranks(one))
    left = [np.ones(len(one.movement.seconds), bool) for one in scored]
    found = 0
    for _, which, posture in order:
        if not left[which][posture]:
            continue
        yield which, posture
        found += 1
        if found == n:
            return
        start_s = scored[which].movement.start_s
        left[which] &= np.abs(start_s - start_s[posture]) >= apart_s
        for own, same in zip(left, alike(scored, which, posture)):
            own &= ~same


def alike(scored: Sequence[ScoredMovement], which: int, posture: int) -> list[np.ndarray]:
    """Of each movement, (N,) which postures are like one: no angle of trunk, neck, upper arms, elbows and knees is
    further off than 20 degrees, and what they hold is the same; what is not known of one is not known of the other.
    """
    own = scored[which].movement
    angles_deg, full = own.measures[posture, LOOKED_AT], own.full(posture)
    return [_alike(one.movement, angles_deg, full) for one in scored]


def _alike(movement: Movement, angles_deg: np.ndarray, full: bool) -> np.ndarray:
    others = movement.measures[:, LOOKED_AT]
    off = np.where(np.isnan(others) & np.isnan(angles_deg), 0.0, np.abs(others - angles_deg))
    same = movement.carrying == full if movement.carrying is not None else full
    return np.asarray((off <= ALIKE_DEG).all(axis=1) & movement.known & same, bool)


def _ranks(one: ScoredMovement) -> list[tuple[int, float]]:
    """Posture and rank, as one number, of all known postures: the rank's digits are the sums of low and high."""
    rula, reba, owas = (getattr(one.scores, name).astype(float).sum(axis=1) for name in ("rula", "reba", "owas"))
    ranks = rula * 1e4 + reba * 1e2 + owas
    return [(posture, float(ranks[posture])) for posture in np.flatnonzero(one.movement.known).tolist()]


SHARES = (("rula", 5), ("rula", 7), ("reba", 8), ("owas", 3))
BEYOND_DEG = (("trunk", 20), ("trunk", 60), ("arm", 60), ("arm", 90))
WORDS = {"rula": "RULA", "reba": "REBA", "owas": "OWAS", "trunk": "trunk flexed", "arm": "an upper arm raised"}
QUANTILE = 0.9


class Told(NamedTuple):
    """A figure, at least and at most; of a share, of the time for which it is known. nan where nothing is known."""

    name: str
    said: str
    unit: str
    low: float
    high: float

    @property
    def row(self) -> tuple[str, str, str]:
        """What it is, at least, at most as people read them; the last is empty where both are one."""
        low, high = in_words(self.low, self.unit), in_words(self.high, self.unit)
        return self.said, low, "" if low == high else high


def in_words(value: float, unit: str) -> str:
    """A share in per cent, a score to two decimals."""
    if np.isnan(value):
        return "not known"
    return f"{100 * value:.1f} %" if unit == "share" else f"{value:.2f}".rstrip("0").rstrip(".")


def movement_figures(scored: Sequence[ScoredMovement]) -> Iterator[Told]:
    """Figures over all movements together, each posture by its seconds.

    Shares of the time at RULA 5 and 7, REBA 8, OWAS 3 or more; with the trunk flexed and with the higher upper arm
    raised against gravity by so many degrees or more; mean, 90 % quantile and most of RULA and REBA.
    """
    seconds = np.concatenate([one.movement.seconds for one in scored])
    known = np.concatenate([one.movement.known for one in scored])
    both = {name: np.concatenate([getattr(one.scores, name) for one in scored]) for name in ("rula", "reba", "owas")}
    for name, least in SHARES:
        low, high = (_share(both[name][:, end] >= least, known, seconds) for end in range(2))
        yield Told(f"{name}_from_{least}_share", f"{WORDS[name]} {least} or more", "share", low, high)
    measures = np.concatenate([one.movement.measures for one in scored])
    for name, degrees in BEYOND_DEG:
        angle = measures[:, AT["trunk_flexion"]] if name == "trunk" else higher_arm_deg(measures)
        share = _share(angle >= degrees, ~np.isnan(angle), seconds)
        yield Told(f"{name}_beyond_{degrees}_share", f"{WORDS[name]} {degrees}° or more", "share", share, share)
    for name in ("rula", "reba"):
        for end_of, words in ((_mean, "mean"), (_quantile, "p90"), (_most, "most")):
            low, high = (end_of(both[name][:, end], known, seconds) for end in range(2))
            yield Told(f"{name}_{words}", f"{WORDS[name]}, {words}", "1", low, high)


def higher_arm_deg(measures: np.ndarray) -> np.ndarray:
    """(N,) elevation of the higher upper arm against gravity; of the one that is known, where one is."""
    return np.asarray(np.fmax(measures[:, AT["left_arm_elevation"]], measures[:, AT["right_arm_elevation"]]))


def unknown_share(scored: Sequence[ScoredMovement]) -> float:
    """Of the time, how much has no known posture."""
    total_s = sum(one.movement.duration_s for one in scored)
    unknown_s = sum(float(one.movement.seconds[~one.movement.known].sum()) for one in scored)
    return unknown_s / total_s if total_s > 0 else 0.0


def loaded_share(scored: Sequence[ScoredMovement]) -> float:
    """Of the time, in how much the hands may hold something."""
    total_s = sum(one.movement.duration_s for one in scored)
    loaded_s = sum(one.movement.loaded_s for one in scored)
    return loaded_s / total_s if total_s > 0 else 0.0


def _share(there: np.ndarray, known: np.ndarray, seconds: np.ndarray) -> float:
    all_s = float(seconds[known].sum())
    return float(seconds[known & there].sum()) / all_s if all_s > 0 else float("nan")


def _mean(values: np.ndarray, known: np.ndarray, seconds: np.ndarray) -> float:
    all_s = float(seconds[known].sum())
    return float(values[known] @ seconds[known]) / all_s if all_s > 0 else float("nan")


def _quantile(values: np.ndarray, known: np.ndarray, seconds: np.ndarray) -> float:
    """The score at or below which nine tenths of the time are."""
    if not known.any():
        return float("nan")
    order = np.argsort(values[known], kind="stable")
    passed_s = np.cumsum(seconds[known][order])
    place = int(np.searchsorted(passed_s, QUANTILE * passed_s[-1] * (1 - 1e-12)))
    return float(values[known][order][min(place, order.size - 1)])


def _most(values: np.ndarray, known: np.ndarray, _seconds: np.ndarray) -> float:
    return float(values[known].max()) if known.any() else float("nan")
