"""The composite lifting index as an interval: over every order that kinds of lifts may have, and every duration.

The index goes through kinds of lifts by their own indices, the worst first. Where these are intervals that overlap, the
order is open, and the index does not rise with each of them: the least and the most are sought over all orders.
Source: DHHS (NIOSH) 94-110, section 2.4 (the index); the search over orders is the design's.

How often and how long somebody lifts: lifts a minute, and the duration that NIOSH's table asks for.

The duration is that of a shift, whatever part of it was simulated: what was seen of a shift repeats itself to fill it.
Who has no shifts lifts at least as long as in the run, and at most as long as the table knows (8 h).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from opsim.ergonomics.strain.niosh import FM, HOURS, METRIC, RECOVERY, frequency_multiplier
from opsim.plan import Plan

MOST_SETS = 1024
"""Sets of kinds that are followed at once; of more, those with the highest index so far."""


@dataclass(frozen=True, slots=True)
class Kind:
    """One kind of lift of somebody.

    fili : index without frequency, at least and at most; per_min : lifts a minute
    taken_cm, any_cm : heights of the hands of which FM may be asked: where it is taken, and at either end
    """

    fili: tuple[float, float]
    per_min: float
    taken_cm: tuple[float, ...]
    any_cm: tuple[float, ...]


def least_multiplier(hours: int) -> float:
    """The least FM of a duration that is not 0: it stands for what is beyond the table."""
    return min(value for below in (True, False) for value in FM[hours, below] if value > 0)


def composite_range(kinds: Sequence[Kind], columns: Sequence[int]) -> tuple[float, float]:
    """CLI at least and at most; columns : the durations of FM that it may have. 0 without a kind.

    CLI = STLI_1 + sum over j > 1 of FILI_j (1 / FM(F_1 + ... + F_j) - 1 / FM(F_1 + ... + F_(j-1))).
    """
    found = [_range(kinds, hours) for hours in columns]
    return min(low for low, _ in found), max(high for _, high in found)


def _range(kinds: Sequence[Kind], hours: int) -> tuple[float, float]:
    alone = [_steps(kind, 0.0, hours, first=True) for kind in kinds]
    states = {0: (0.0, 0.0, 0.0)}  # of each set of kinds that come first: lifts a minute, least and most so far
    for _ in kinds:
        after: dict[int, tuple[float, float, float]] = {}
        for done, (before, low, high) in states.items():
            left = [at for at in range(len(kinds)) if not done >> at & 1]
            for at in (at for at in left if alone[at][1] >= max(alone[other][0] for other in left)):
                least, most = alone[at] if not done else _steps(kinds[at], before, hours)
                _, best_low, best_high = after.get(done | 1 << at, (0.0, low + least, high + most))
                reached = before + kinds[at].per_min, min(best_low, low + least), max(best_high, high + most)
                after[done | 1 << at] = reached
        states = dict(sorted(after.items(), key=lambda item: -item[1][2])[:MOST_SETS])
    return min(state[1] for state in states.values()), max(state[2] for state in states.values())


def _steps(kind: Kind, before: float, hours: int, first: bool = False) -> tuple[float, float]:
    """What a kind adds after others of ``before`` lifts a minute, at least and at most."""
    least = min(_step(kind, before, hours, cm, first) for cm in kind.taken_cm)
    most = max(_step(kind, before, hours, cm, first) for cm in kind.any_cm)
    return kind.fili[0] * least, kind.fili[1] * most


def _step(kind: Kind, before: float, hours: int, height_cm: float, first: bool) -> float:
    height_cm = 0.0 if height_cm < METRIC.knuckle else METRIC.knuckle
    now = _over(before + kind.per_min, hours, height_cm)
    return now if first else now - _over(before, hours, height_cm)


@lru_cache(maxsize=1 << 14)
def _over(per_min: float, hours: int, height_cm: float) -> float:
    """1 / FM, which the least of the table bounds."""
    return 1.0 / max(float(frequency_multiplier(per_min, hours, height_cm)), least_multiplier(hours))


Span = tuple[float, float]

PAUSE_S = 600.0
"""A longer time without a lift is recovery. Source: DHHS (NIOSH) 94-110, section 1.3.5: at no more than 0.1 lifts a
minute recovery is usually enough for the shortest duration."""
SAMPLE_S = 900.0
"""Lifts are counted over at least 15 minutes. Source: DHHS (NIOSH) 94-110, section 1.3.5, special adjustment."""


@dataclass(frozen=True, slots=True)
class Pattern:
    """minutes : of lifting, over which lifts are counted; hours, most_hours : the columns of FM, 1, 2 or 8, at least
    and at most."""

    minutes: float
    hours: int
    most_hours: int

    @property
    def columns(self) -> tuple[int, ...]:
        """All that it may be."""
        return tuple(hours for hours in HOURS if self.hours <= hours <= self.most_hours)


def pattern_of(plan: Plan, worker: int, start_s: np.ndarray, end_s: np.ndarray) -> Pattern:
    """Of one worker's lifts (L,) in the window of a plan, by his shifts."""
    duties = plan.workers[worker].duties
    if duties is None:
        return pattern(start_s, end_s)
    shifts = [duty.whole_s or (duty.start_s, duty.end_s) for duty in duties]
    return pattern(start_s, end_s, shifts, plan.window_s)


def pattern(
    start_s: np.ndarray, end_s: np.ndarray, shifts: Sequence[Span] | None = None, seen_s: Span = (-np.inf, np.inf)
) -> Pattern:
    """Of one worker's lifts (L,), whenever they are.

    shifts : from when to when each of his is; None: he has none, and how long he goes on is not known
    seen_s : the part of the run that is looked at; a shift that it does not cover goes on as what is seen of it
    """
    if not start_s.size:
        return Pattern(SAMPLE_S / 60.0, HOURS[0], HOURS[0])
    begins, ends = _periods(start_s, end_s)
    minutes = float(np.maximum(ends - begins, SAMPLE_S).sum() / 60.0)
    if shifts is None:
        return Pattern(minutes, _hours(begins, ends), HOURS[-1])
    for shift in shifts:
        begins, ends = _gone_on(begins, ends, shift, seen_s)
    hours = _hours(*_periods(begins, ends))
    return Pattern(minutes, hours, hours)


def _hours(begins: np.ndarray, ends: np.ndarray) -> int:
    return duration_hours(ends - begins, np.r_[begins[1:] - ends[:-1], np.inf])


def _gone_on(begins: np.ndarray, ends: np.ndarray, shift: Span, seen_s: Span) -> tuple[np.ndarray, np.ndarray]:
    """Periods of lifting and, where a shift is seen in part, copies of those in it, one part after the other."""
    low, high = max(shift[0], seen_s[0]), min(shift[1], seen_s[1])
    own = (ends > low) & (begins < high)
    if low >= high or (low, high) == shift or not own.any():
        return begins, ends
    first, last = (int(np.ceil((edge - part) / (high - low))) for edge, part in ((shift[0], low), (shift[1], high)))
    away_s = (high - low) * np.r_[first - 1 : 0, 1 : last + 1][:, None]
    copied = (np.clip(np.clip(edge[own], low, high) + away_s, *shift).ravel() for edge in (begins, ends))
    both = [np.r_[edge, copy] for edge, copy in zip((begins, ends), copied)]
    lasting = both[1] > both[0]
    lasting[: begins.size] = True
    return both[0][lasting], both[1][lasting]


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
