"""How often and how long somebody lifts: lifts a minute, and the duration that NIOSH's table asks for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opsim.ergonomics.tables_niosh import HOURS, RECOVERY

PAUSE_S = 600.0
"""A longer time without a lift is recovery. Source: DHHS (NIOSH) 94-110, section 1.3.5: at no more than 0.1 lifts a
minute recovery is usually enough for the shortest duration."""
SAMPLE_S = 900.0
"""Lifts are counted over at least 15 minutes. Source: DHHS (NIOSH) 94-110, section 1.3.5, special adjustment."""


@dataclass(frozen=True, slots=True)
class Pattern:
    """minutes : of lifting, over which lifts are counted; hours : 1, 2 or 8, the column of FM."""

    minutes: float
    hours: int


def pattern(start_s: np.ndarray, end_s: np.ndarray) -> Pattern:
    """Of one worker's lifts (L,), whenever they are."""
    if not start_s.size:
        return Pattern(SAMPLE_S / 60.0, HOURS[0])
    begins, ends = _periods(start_s, end_s)
    minutes = float(np.maximum(ends - begins, SAMPLE_S).sum() / 60.0)
    return Pattern(minutes, duration_hours(ends - begins, np.r_[begins[1:] - ends[:-1], np.inf]))


def duration_hours(lifting_s: np.ndarray, recovery_s: np.ndarray) -> int:
    """1, 2 or 8: the shortest duration that allows these periods of lifting, each followed by its recovery.

    Without recovery enough (1.2 times the lifting for 1 h, 0.3 times for 2 h) the next period adds to the one before.
    Source: DHHS (NIOSH) 94-110, section 1.3.5. More than 8 hours count as 8: the table knows no more.
    """
    for hours, times in RECOVERY.items():
        together_s, longest_s = 0.0, 0.0
        for lifting, recovery in zip(lifting_s.tolist(), recovery_s.tolist()):
            together_s += lifting
            longest_s = max(longest_s, together_s)
            if recovery >= times * together_s:
                together_s = 0.0
        if longest_s <= hours * 3600.0:
            return hours
    return HOURS[-1]


def _periods(start_s: np.ndarray, end_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Begin and end of each period of lifting."""
    order = np.argsort(start_s, kind="stable")
    begins, ends = start_s[order], np.maximum.accumulate(end_s[order])
    breaks = np.flatnonzero(begins[1:] - ends[:-1] > PAUSE_S)
    return begins[np.r_[0, breaks + 1]], ends[np.r_[breaks, begins.size - 1]]
