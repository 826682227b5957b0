"""What a scenario says of a task, as the least and most that each score may take from it.

RULA, REBA and OWAS of many postures at once, each as the least and the most that it may be.

What the scoring functions are asked, checked: every mistake at once.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from math import isfinite
from numbers import Real
from typing import Any

import numpy as np

from opsim.ergonomics.angles import AT, COLUMNS
from opsim.ergonomics.options import USUAL, Options, Thresholds, checked
from opsim.ergonomics.scores.tables import (
    REBA_A,
    REBA_B,
    REBA_C,
    RULA_A,
    RULA_B,
    RULA_C,
    owas_load,
    owas_table,
    reba_load,
    rula_force,
)
from opsim.problems import did_you_mean, shown
from opsim.subjects.exposure.plan import FORCES, GRIPS, NOT_SAID, Handling

Pair = tuple[int, int]
EITHER: Pair = (0, 1)
LOADS_KG = (0.0, 2.0, 5.0, 10.0, 10.5, 20.5)
"""A load of each class of each method: none, RULA's and REBA's edges, over 10 kg, over 20 kg."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """Pairs (low, high): the same number twice where the scenario says it, all that it may be where it does not.

    rula_force : 0-3, rula_force_worksheet : by the worksheet's rule;  reba_load : 0-3, with shock;  owas_load : 1-3;
                 coupling : 0-3: these four of what the hands hold
    rapid      : 0-1, REBA's activity of quick large changes or an unstable base
    wrist_twist: 1-2;  supported : 0-1, of the arms
    one_legged : 0-1, whether the legs are not both carrying (RULA's legs 2, REBA's legs 2, OWAS 3 and 5)
    sitting    : 0-1;  walking : whether these are steps of somebody who walks (OWAS legs 7)
    """

    rula_force: Pair = (0, 0)
    rula_force_worksheet: Pair = (0, 0)
    reba_load: Pair = (0, 0)
    owas_load: Pair = (1, 1)
    coupling: Pair = (0, 0)
    rapid: Pair = (0, 0)
    wrist_twist: Pair = (1, 1)
    supported: Pair = (0, 0)
    one_legged: Pair = (0, 0)
    sitting: Pair = (0, 0)
    walking: bool = False

    def empty_handed(self) -> Bounds:
        """The same task in the moments in which it carries nothing."""
        none = (0, 0)
        return replace(
            self, rula_force=none, rula_force_worksheet=none, reba_load=none, owas_load=(1, 1), coupling=none
        )


NOTHING_OPEN = Bounds()
"""A task of which all is said: nothing carried, forearm in mid range, standing on both feet, arms not supported."""


def bounds_of(handling: Handling = NOT_SAID, *, walking: bool = False) -> Bounds:
    """What is not said (None) may be anything that the method knows.

    A load of 0 kg with a force or grip that nobody named has none of either. Somebody who walks does not sit, nothing
    supports his arms, and his feet carry in turn, which RULA and REBA count as balanced.
    """
    loads = LOADS_KG if handling.load_kg is None else (handling.load_kg,)
    forces = (handling.force,) if handling.force else ("intermittent",) if handling.load_kg == 0 else FORCES
    pushed = [(load, force) for load in loads for force in forces]
    grips = (handling.grip,) if handling.grip else ("good",) if handling.load_kg == 0 else GRIPS
    return Bounds(
        rula_force=_span(rula_force(load, force) for load, force in pushed),
        rula_force_worksheet=_span(rula_force(load, force, "worksheet") for load, force in pushed),
        reba_load=_span(reba_load(load, shock=force == "shock") for load, force in pushed),
        owas_load=_span(owas_load(load) for load in loads),
        coupling=_span(GRIPS.index(grip) for grip in grips),
        rapid=_said(handling.rapid),
        wrist_twist=(1, 2) if handling.forearm is None else _twice(2 if handling.forearm == "end" else 1),
        supported=(0, 0) if walking else _said(handling.arms_supported),
        one_legged=(0, 0) if walking else _said(None if handling.legs is None else handling.legs == "unbalanced"),
        sitting=(0, 0) if walking else _said(handling.sitting),
        walking=walking,
    )


def _said(flag: bool | None) -> Pair:
    return EITHER if flag is None else _twice(int(flag))


def _twice(code: int) -> Pair:
    return code, code


def _span(codes: Iterable[int]) -> Pair:
    known = list(codes)
    return min(known), max(known)


WALKING = bounds_of(walking=True)
"""Somebody who walks with something in his hands of which nobody said how heavy; with empty hands, ``empty_handed``."""


SPREAD_DEG = (5.0, 20.0)
"""Where ``Thresholds.spread`` asks for it, twist and side count from some angle between these."""
_BODY = ("trunk_flexion", "trunk_side", "trunk_twist", "neck_flexion", "neck_side", "left_knee", "right_knee")
_UP = ("left_elbow_above_m", "right_elbow_above_m")
_ARM = ("arm_flexion", "arm_abduction", "elbow", "wrist", "across_m", "outside_m")
ASKED = (*_BODY, *_UP, *(f"{side}_{name}" for side in ("left", "right") for name in _ARM))
"""The measures that scores are made of, in the order in which the kernel asks for them."""
SAID = (
    *("rula_force", "rula_force_worksheet", "reba_load", "owas_load", "coupling"),
    *("rapid", "wrist_twist", "supported", "one_legged", "sitting"),
)
"""The pairs of ``Bounds``, in the order in which the kernel asks for them."""


@dataclass(frozen=True)
class Scores:
    """Of N postures, int8 (N, 2), low and high: ``rula`` 1-7 and ``reba`` 1-15 of the worse arm, ``owas`` 1-4.

    worse : int8 (N,), the worse arm: 0 left, 1 right; left where they are alike
    """

    rula: np.ndarray
    reba: np.ndarray
    owas: np.ndarray
    worse: np.ndarray

    def some(self, rows: np.ndarray | slice) -> Scores:
        """A few of them."""
        return Scores(*(getattr(self, one.name)[rows] for one in fields(self)))


def score(
    measures: np.ndarray,
    bounds: Bounds,
    options: Options = USUAL,
    repeated: np.ndarray | bool = False,
    static: np.ndarray | bool = False,
    carrying: np.ndarray | bool = True,
) -> Scores:
    """Score postures of one task.

    measures : (N, COLUMNS) as ``columns.py``; a nan leaves open what it would decide
    bounds   : what the scenario says of the task, ``bounds_of(handling)``
    repeated, static : (N,) bool, or one for all: RULA's muscle use, REBA's activity
    carrying : (N,) bool, or one for all: False where the hands surely hold nothing
    Raises ValueError where shapes do not fit, and for options that are wrong (``checked``).
    Source: the papers of ``tables.py``.
    """
    from opsim.ergonomics.kernels.scores import FORCE, FORCE_WORKSHEET, score_all

    checked(options)
    measures = postures_checked(measures)
    n = len(measures)
    flags = {"repeated": repeated, "static": static, "carrying": carrying}
    rula, reba, owas = (np.empty((n, 2), np.int8) for _ in range(3))
    found = Scores(rula, reba, owas, np.empty(n, np.int8))
    force = FORCE if options.rula_force == "paper" else FORCE_WORKSHEET
    at, tables = places(), tables_of(options.rula_table_a, tuple(options.owas_disputed))
    edges, phases = edges_of(options.thresholds), phases_of(bounds)
    filled = [_flags(name, flag, n) for name, flag in flags.items()]
    score_all(measures, at, edges, phases, bounds.walking, force, *filled, tables, rula, reba, owas, found.worse)
    return found


def postures_checked(measures: Any) -> np.ndarray:
    """(N, COLUMNS) in double precision, row by row. Raises ValueError for another shape."""
    measures = np.ascontiguousarray(measures)
    if measures.ndim != 2 or measures.shape[1] != len(COLUMNS):
        raise ValueError(f"measures must be (N, {len(COLUMNS)}), found {measures.shape}")
    return measures.astype(np.float64, copy=False)


def _flags(name: str, flag: Any, n: int) -> np.ndarray:
    found = np.asarray(flag, bool)
    if found.shape not in ((), (n,)):
        raise ValueError(f"{name} must be ({n},) or one for all, found {found.shape}")
    return np.broadcast_to(found, n).copy()  # no view: that is another type, and compiled for apart


def edges_of(thresholds: Thresholds) -> np.ndarray:
    """(14,) as the kernel asks for them; the edges of twist and side are two each."""
    t = thresholds
    twist, side = (SPREAD_DEG, SPREAD_DEG) if t.spread else ((t.twist, t.twist), (t.side, t.side))
    plain = (t.abducted, t.trunk_upright, t.wrist_straight, t.neck_extended, t.across_m, t.outside_m)
    return np.array([*twist, *side, *plain, t.owas_back, t.owas_twist, t.owas_knee, t.arm_sideways], float)


@lru_cache(maxsize=256)
def phases_of(bounds: Bounds) -> np.ndarray:
    """(2, 10, 2) of a task's empty hands, and of its loaded ones."""
    return np.array([[getattr(one, name) for name in SAID] for one in (bounds.empty_handed(), bounds)], np.int64)


@lru_cache(maxsize=1)
def places() -> np.ndarray:
    return np.array([AT[name] for name in ASKED])


@lru_cache(maxsize=8)
def tables_of(table_a: str, disputed: tuple[str, ...]) -> tuple[np.ndarray, ...]:
    found = (RULA_A[table_a], RULA_B, RULA_C, REBA_A, REBA_B, REBA_C, owas_table(disputed))
    return tuple(np.ascontiguousarray(table, np.int64) for table in found)


def angles_checked(words: Iterable[str] = (), **numbers: float) -> dict[str, float]:
    """The numbers. Raises one ValueError with a line for each that is none, and for each mistake among ``words``."""
    mistakes = [
        f"{name}: found {shown(value)}, expected a number" for name, value in numbers.items() if not _number(value)
    ]
    mistakes += [
        f"{name}: found {value:g}, expected 0 or more"
        for name, value in numbers.items()
        if name.endswith("_kg") and _number(value) and value < 0
    ]
    mistakes += words
    if mistakes:
        raise ValueError("\n".join(mistakes))
    return numbers


def choice_checked(name: str, value: object, known: Sequence) -> list[str]:
    """Nothing, or what is wrong with a word."""
    if value in known:
        return []
    if not isinstance(known[0], str):
        return [f"{name}: found {shown(value)}, expected one of {', '.join(map(str, known))}"]
    return [f"{name}: no {shown(value)}; {did_you_mean(value, known)}"]


def _number(value: object) -> bool:
    return isinstance(value, Real) and isfinite(value)
