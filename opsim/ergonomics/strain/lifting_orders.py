"""The composite lifting index as an interval: over every order that kinds of lifts may have, and every duration.

The index goes through kinds of lifts by their own indices, the worst first. Where these are intervals that overlap, the
order is open, and the index does not rise with each of them: the least and the most are sought over all orders.
Source: DHHS (NIOSH) 94-110, section 2.4 (the index); the search over orders is the design's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

from opsim.ergonomics.strain.niosh import frequency_multiplier
from opsim.ergonomics.strain.tables_niosh import FM, METRIC

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
