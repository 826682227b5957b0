"""How many points of a score each part of the body brings in.

Why a posture scores what it does: every sub-score, and the parts of the body that drive the score.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import factorial
from typing import Any

import numpy as np

from opsim.ergonomics.options import USUAL, Options, checked
from opsim.ergonomics.scores.scoring import Bounds, edges_of, phases_of, places, postures_checked, tables_of
from opsim.ergonomics.scores.tables import owas_level, reba_level, rula_level

SAID_LEAST = {"FOREARM": 1, "OWAS_LOAD": 1}
"""Least of what the scenario says, where it is not 0."""


@dataclass(frozen=True)
class State:
    """Sub-scores (22, 2), what is said (10, 2), and how much time adds: muscle use, activity."""

    codes: np.ndarray
    said: np.ndarray
    time: int

    def less(self, codes: dict[int, int], said: dict[int, int], *, time: bool) -> State:
        """With some of them at their least."""
        less = replace(self, codes=self.codes.copy(), said=self.said.copy(), time=0 if time else self.time)
        for array, rows in ((less.codes, codes), (less.said, said)):
            for row, least in rows.items():
                array[row] = least
        return less


def drives_of(
    kernel: Any, state: State, arms: Callable, rows: dict[str, dict[int, int]], said: Mapping[str, tuple[str, ...]]
) -> dict[str, float]:
    """How many points of the score (the middle of low and high) each part brings in, the most first.

    Source: Shapley 1953, A value for n-person games: what a part adds, on average over all orders in which the parts
    can go from their least to what they are. One part alone often changes nothing, as the tables saturate.
    """
    parts = tuple(dict.fromkeys((*rows, *said, *(("time",) if state.time else ()))))
    states = {part: ({getattr(kernel, name): SAID_LEAST.get(name, 0) for name in said.get(part, ())}) for part in parts}
    worth = np.empty(2 ** len(parts))
    for there in range(worth.size):
        away = [part for bit, part in enumerate(parts) if not there >> bit & 1]
        least = {row: code for part in away for row, code in rows.get(part, {}).items()}
        unsaid = {row: code for part in away for row, code in states[part].items()}
        worth[there] = arms(state.less(least, unsaid, time="time" in away)).max(axis=1).mean()
    found = {part: _share(worth, bit, len(parts)) for bit, part in enumerate(parts)}
    return dict(sorted(((part, more) for part, more in found.items() if abs(more) > 1e-9), key=lambda one: -one[1]))


def _share(worth: np.ndarray, bit: int, n: int) -> float:
    """The Shapley value of a part out of n, from what each set of them (a bit each) is worth."""
    sets = np.arange(worth.size)
    without = sets[sets >> bit & 1 == 0]
    sizes = [int(one).bit_count() for one in without.tolist()]
    weights = np.array([factorial(size) * factorial(n - 1 - size) for size in sizes]) / factorial(n)
    return float(weights @ (worth[without | 1 << bit] - worth[without]))


Pair = tuple[int, int]
SIDES = ("left", "right")
ARM_PARTS = ("upper_arm", "lower_arm", "wrist")
RULA_PARTS = {"neck": "NECK", "trunk": "TRUNK", "legs": "LEGS"}
REBA_PARTS = {"neck": "REBA_NECK", "trunk": "REBA_TRUNK", "legs": "REBA_LEGS"}
OWAS_PARTS = {"back": ("BENT", "TWISTED"), "arms": ("ARMS_UP",), "legs": ("OWAS_LEGS",)}
LEAST = {"BENT": 0, "TWISTED": 0, "ARMS_UP": 0, "OWAS_LEGS": 0b10}
"""Least of a sub-score, where it is not 1; of OWAS's legs, both straight."""


def explain(
    measures: np.ndarray,
    bounds: Bounds,
    options: Options = USUAL,
    *,
    repeated: bool = False,
    static: bool = False,
    carrying: bool = True,
) -> dict[str, dict[str, Any]]:
    """Of one posture (COLUMNS,): {"rula": ..., "reba": ..., "owas": ...}; every figure is a pair (low, high).

    rula, reba : ``score``, ``level`` and ``text`` (of the high score), ``side`` (the worse arm), ``drives``, ``parts``:
                 sub-scores by name, the arm's of the worse arm, with ``force`` or ``load``, ``coupling``, and ``time``
    owas       : ``score``, ``level``, ``text``, ``drives`` and ``parts``: back, arms, legs and load, all digits that
                 each may be
    ``drives`` : {part of the body, load or time: points of the score that it brings in}, the most first: together they
    are the middle of low and high, less what a neutral posture scores.
    Raises ValueError where ``measures`` is of another shape, and for options that are wrong.
    """
    from opsim.ergonomics.kernels import scores as kernel

    codes = np.zeros((kernel.ARM + 2 * kernel.ARM_CODES, 2), np.int64)
    said = phases_of(bounds)[int(carrying)]
    row, edges = postures_checked([measures])[0], edges_of(checked(options).thresholds)
    kernel.find_codes(row, places(), edges, said, bounds.walking, codes)
    tables = tables_of(options.rula_table_a, tuple(options.owas_disputed))
    force = "FORCE" if options.rula_force == "paper" else "FORCE_WORKSHEET"
    rula, reba = State(codes, said, int(repeated or static)), State(codes, said, int(repeated) + int(static))
    return {"rula": _rula(kernel, rula, force, tables), "reba": _reba(kernel, reba, tables),
            "owas": _owas(kernel, State(codes, said, 0), tables)}  # fmt: skip


def _rula(kernel: Any, state: State, force: str, tables: tuple) -> dict[str, Any]:
    def arms(one: State) -> np.ndarray:
        row = getattr(kernel, force)
        return np.array([kernel.rula_of(one.codes, one.said, row, one.time, end, tables) for end in range(2)])

    rows = {name: {getattr(kernel, code): 1} for name, code in RULA_PARTS.items()} | _arm_rows(kernel, 0)
    said = {"wrists": ("FOREARM",), "load": (force,)}
    found = _summary(arms(state), rula_level) | {"drives": drives_of(kernel, state, arms, rows, said)}
    parts = _parts(kernel, state, RULA_PARTS, 0, found["side"])
    parts |= {"wrist_twist": _pair(state.said[kernel.FOREARM]), "force": _pair(state.said[getattr(kernel, force)])}
    return found | {"parts": parts | {"time": (state.time, state.time)}}


def _reba(kernel: Any, state: State, tables: tuple) -> dict[str, Any]:
    def arms(one: State) -> np.ndarray:
        return np.array([kernel.reba_of(one.codes, one.said, one.time, end, tables) for end in range(2)])

    rows = {name: {getattr(kernel, code): 1} for name, code in REBA_PARTS.items()} | _arm_rows(kernel, 3)
    said = {"load": ("LOAD", "COUPLING"), "time": ("RAPID",)}
    found = _summary(arms(state), reba_level) | {"drives": drives_of(kernel, state, arms, rows, said)}
    parts = _parts(kernel, state, REBA_PARTS, 3, found["side"])
    parts |= {"load": _pair(state.said[kernel.LOAD]), "coupling": _pair(state.said[kernel.COUPLING])}
    return found | {"parts": parts | {"time": _pair(state.time + state.said[kernel.RAPID])}}


def _owas(kernel: Any, state: State, tables: tuple) -> dict[str, Any]:
    def category(one: State) -> np.ndarray:
        return np.array(kernel.owas_of(one.codes, one.said, tables[6]))[:, None]

    rows = {part: {getattr(kernel, name): LEAST[name] for name in names} for part, names in OWAS_PARTS.items()}
    drives = drives_of(kernel, state, category, rows, {"load": ("OWAS_LOAD",)})
    found = _summary(category(state), owas_level)
    del found["side"]
    return found | {"drives": drives, "parts": _digits(kernel, state)}


def _summary(arms: np.ndarray, level: Callable) -> dict[str, Any]:
    """Of scores (low and high, arms): the worse arm's, with its action level."""
    low, high = arms.max(axis=1).tolist()
    worst = level(high)
    side = SIDES[int(np.argmax(arms.sum(axis=0)))]
    return {"score": (low, high), "level": (level(low).number, worst.number), "text": worst.text, "side": side}


def _arm_rows(kernel: Any, first: int) -> dict[str, dict[int, int]]:
    starts = [kernel.ARM + side * kernel.ARM_CODES + first for side in range(2)]
    return {"arms": {start + i: 1 for start in starts for i in (0, 1)}, "wrists": {start + 2: 1 for start in starts}}


def _parts(kernel: Any, state: State, body: dict[str, str], first: int, side: str) -> dict[str, Pair]:
    start = kernel.ARM + SIDES.index(side) * kernel.ARM_CODES + first
    found = {name: _pair(state.codes[getattr(kernel, code)]) for name, code in body.items()}
    return found | {name: _pair(state.codes[start + i]) for i, name in enumerate(ARM_PARTS)}


def _digits(kernel: Any, state: State) -> dict[str, tuple[int, ...]]:
    """All that each digit of an OWAS code may be."""
    codes, load = state.codes, state.said[kernel.OWAS_LOAD]
    backs = {1 + bent + 2 * twisted for bent in _all(codes[kernel.BENT]) for twisted in _all(codes[kernel.TWISTED])}
    legs = tuple(digit for digit in range(1, 8) if codes[kernel.OWAS_LEGS, 0] >> (digit - 1) & 1)
    arms = tuple(1 + up for up in _all(codes[kernel.ARMS_UP]))
    return {"back": tuple(sorted(backs)), "arms": arms, "legs": legs, "load": tuple(_all(load))}


def _all(pair: np.ndarray) -> range:
    return range(int(pair[0]), int(pair[1]) + 1)


def _pair(pair: np.ndarray) -> Pair:
    return int(pair[0]), int(pair[1])
