"""Levels of exposure that are counted, and minutes at them, of what a ledger says."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from opsim.ergonomics.shift.ledger import AT_MOST, BINS, Ledger


class Level(NamedTuple):
    """At least ``value`` of a score or an angle of the ledger."""

    measure: str
    value: int


LEVELS = {
    "rula_from_5": Level("rula", 5),
    "rula_from_7": Level("rula", 7),
    "reba_from_8": Level("reba", 8),
    "owas_from_3": Level("owas", 3),
    "arm_beyond_60": Level("arm", 60),
    "arm_beyond_90": Level("arm", 90),
    "trunk_beyond_60": Level("trunk", 60),
    "trunk_beyond_20": Level("trunk", 20),
}
"""RULA 5 and 6: changes soon, 7: at once (McAtamney & Corlett 1993, Applied Ergonomics 24(2), 91-99). REBA 8: high risk
(Hignett & McAtamney 2000, Applied Ergonomics 31, 201-205). OWAS 3: as soon as possible (Karhu, Kansi & Kuorinka 1977,
Applied Ergonomics 8(4), 199-201). Upper arm and trunk: ISO 11226:2000, EN 1005-4:2005."""


def bounds_of_level(name: str) -> tuple[str, ...]:
    """Parts of a figure at a level: "" for at least, and AT_MOST where the score is an interval."""
    return ("", AT_MOST) if LEVELS[name].measure + AT_MOST in BINS else ("",)


def minutes(ledger: Ledger, name: str, bound: str = "") -> np.ndarray:
    """(M,) measured minutes of each cell at a level; nan where there is time, and none of it measured."""
    measure, value = LEVELS[name]
    spent_s, known_s = ledger.from_s(measure + bound, value), ledger.known_s(measure + bound)
    return np.where((known_s <= 0) & (ledger.seconds > 0), np.nan, spent_s / 60.0)


def quantile(ledger: Ledger, measure: str, q: float) -> np.ndarray:
    """(M,) the score at or below which a share q of the known time is; q 1: the highest; nan where none is known."""
    first = BINS[measure].first
    until_s = np.cumsum(ledger.bins[measure][:, 1:], axis=1)
    whole_s = until_s[:, -1:]
    reached = until_s >= q * whole_s * (1 - 1e-12)
    return np.where(whole_s[:, 0] > 0, first + np.argmax(reached, axis=1), np.nan)


def mean_score(ledger: Ledger, measure: str) -> np.ndarray:
    """(M,) over the known time; nan where there is none."""
    known_s = ledger.known_s(measure)
    return np.where(known_s > 0, ledger.score_seconds(measure) / np.where(known_s > 0, known_s, 1.0), np.nan)
