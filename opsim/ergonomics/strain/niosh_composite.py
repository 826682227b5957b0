"""The composite lifting index of a job of several kinds of lifts.

Source: Waters, Putz-Anderson & Garg 1994, DHHS (NIOSH) 94-110, section 2.4 (multi-task procedure).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from opsim.ergonomics.strain.niosh import Lift, frequency_multiplier, lifting_index, multipliers, ratio
from opsim.ergonomics.strain.tables_niosh import HOURS, METRIC, Constants


@dataclass(frozen=True, slots=True)
class Composite:
    """A job of several lifts: its index, and of each lift the index without its frequency (FILI) and with it (STLI).

    order : which lift comes first, second, ... (by STLI, the worst first)
    """

    index: float
    fili: tuple[float, ...]
    stli: tuple[float, ...]
    order: tuple[int, ...]


def composite(lifts: Sequence[Lift], units: Constants = METRIC) -> Composite:
    """CLI = STLI_1 + sum over j > 1 of FILI_j (1 / FM(F_1 + ... + F_j) - 1 / FM(F_1 + ... + F_(j-1))).

    Lifts of one job, each at its own frequency, all with the duration of the job. Both FM of an increment are taken at
    the height of its own lift. inf where so many lifts a minute are beyond the table. Source: manual, section 2.4.
    """
    found = [multipliers(lift, units) for lift in lifts]
    fili = [ratio(lift.load, units.load * one.without_frequency) for lift, one in zip(lifts, found)]
    stli = [lifting_index(lift, units) for lift in lifts]
    order = sorted(range(len(lifts)), key=lambda i: (-stli[i], -fili[i], i))
    heights, per_min = ([getattr(lifts[i], name) for i in order] for name in ("height", "per_min"))
    hours = lifts[0].hours if lifts else HOURS[0]
    index = composite_index([fili[i] for i in order], per_min, heights, hours, units)
    return Composite(index, tuple(fili), tuple(stli), tuple(order))


def composite_index(
    fili: Sequence[float],
    per_min: Sequence[float],
    heights: Sequence[float],
    hours: int,
    units: Constants = METRIC,
    least: float = 0.0,
) -> float:
    """CLI of lifts in their order, the worst first, from their indices without frequency; FM is no less than ``least``.

    With ``least`` above 0 it has a bound for any frequency, where the equation has none.
    """
    index, before = 0.0, 0.0
    for place, (load, often, height) in enumerate(zip(fili, per_min, heights)):
        rates = before + often, before
        now, then = (max(float(frequency_multiplier(rate, hours, height, units)), least) for rate in rates)
        index += ratio(load, now) - (ratio(load, then) if place else 0.0) if now > 0 else math.inf
        before += often
    return index
