"""RULA, REBA and OWAS of many postures at once, each as the least and the most that it may be."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import lru_cache
from typing import Any

import numpy as np

from opsim.ergonomics.columns import AT, COLUMNS
from opsim.ergonomics.options import USUAL, Options, Thresholds, checked
from opsim.ergonomics.scores.bounds import Bounds
from opsim.ergonomics.scores.tables import REBA_A, REBA_B, REBA_C, RULA_A, RULA_B, RULA_C, owas_table

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
    return np.ascontiguousarray(np.broadcast_to(found, n))


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
