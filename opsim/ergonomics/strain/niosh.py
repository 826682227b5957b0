"""The revised NIOSH lifting equation: recommended weight limit and lifting index of one kind of lift.

Source: Waters, Putz-Anderson, Garg & Fine 1993, Ergonomics 36(7), 749-776; Waters, Putz-Anderson & Garg 1994, DHHS
(NIOSH) 94-110. Two hands, standing, smooth, no more than 8 h; not for one hand, sitting, kneeling, shovels or barrows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from opsim.ergonomics.strain.tables_niosh import (
    CM,
    FM,
    HOURS,
    METRIC,
    MOST_ASYMMETRY_DEG,
    PER_DEGREE,
    PER_MIN,
    Constants,
)
from opsim.problems import did_you_mean, shown


@dataclass(frozen=True, slots=True)
class Lift:
    """One kind of lift, at its origin or its destination; lengths and load in the units of the constants used.

    horizontal : H, level, from the middle between the ankles to the middle of the hands
    height     : V, of the hands above the floor; travel: D, how far up or down they go
    asymmetry_deg : A, how far to a side of straight ahead the hands are
    per_min    : F, lifts a minute; hours: 1, 2 or 8, the column of FM; grip: good, fair or poor
    """

    load: float
    horizontal: float
    height: float
    travel: float
    asymmetry_deg: float = 0.0
    per_min: float = 0.2
    hours: int = 1
    grip: str = "good"


@dataclass(frozen=True, slots=True)
class Multipliers:
    """What each condition leaves of the load constant, from 1 to 0: H, V, D, A, frequency, grip."""

    hm: float
    vm: float
    dm: float
    am: float
    fm: float
    cm: float

    @property
    def without_frequency(self) -> float:
        """The product of all but FM, by which the load constant becomes FIRWL."""
        return self.hm * self.vm * self.dm * self.am * self.cm


def horizontal_multiplier(horizontal: np.ndarray | float, units: Constants = METRIC) -> np.ndarray:
    """HM = near / H; 1 nearer, 0 farther than one can reach."""
    h = np.asarray(horizontal, float)
    return np.where(h > units.far, 0.0, units.near / np.maximum(h, units.near))


def vertical_multiplier(height: np.ndarray | float, units: Constants = METRIC) -> np.ndarray:
    """VM = 1 - per_height |V - knuckle|; 0 beyond the highest."""
    v = np.maximum(np.asarray(height, float), 0.0)
    return np.where(v > units.highest, 0.0, 1.0 - units.per_height * np.abs(v - units.knuckle))


def distance_multiplier(travel: np.ndarray | float, units: Constants = METRIC) -> np.ndarray:
    """DM = 0.82 + per_travel / D; 1 up to the short way, 0 beyond the longest."""
    d = np.asarray(travel, float)
    between = 0.82 + units.per_travel / np.maximum(d, units.short)
    return np.where(d > units.longest, 0.0, np.where(d <= units.short, 1.0, between))


def asymmetry_multiplier(asymmetry_deg: np.ndarray | float) -> np.ndarray:
    """AM = 1 - 0.0032 |A|; 0 beyond 135 degrees."""
    a = np.abs(np.asarray(asymmetry_deg, float))
    return np.where(a > MOST_ASYMMETRY_DEG, 0.0, 1.0 - PER_DEGREE * a)


def frequency_multiplier(
    per_min: np.ndarray | float, hours: int, height: np.ndarray | float, units: Constants = METRIC
) -> np.ndarray:
    """FM, linear between the rows of its table; that of 0.2 lifts a minute below it, 0 beyond 15.

    Raises ValueError for hours that are no column of the table.
    """
    if hours not in HOURS:
        raise ValueError(f"hours of lifting: found {shown(hours)}, expected one of {', '.join(map(str, HOURS))}")
    low, high = (np.interp(per_min, PER_MIN, FM[hours, below], right=0.0) for below in (True, False))
    return np.where(np.asarray(height, float) < units.knuckle, low, high)


def grip_multiplier(grip: str, height: np.ndarray | float, units: Constants = METRIC) -> np.ndarray:
    """CM of a grip; REBA's ``unacceptable`` counts as poor, as the equation knows no worse.

    Raises ValueError for another word.
    """
    grip = "poor" if grip == "unacceptable" else grip
    if grip not in CM:
        raise ValueError(f"grip: no {shown(grip)}; {did_you_mean(grip, CM)}")
    low, high = CM[grip]
    return np.where(np.asarray(height, float) < units.knuckle, low, high)


def multipliers(lift: Lift, units: Constants = METRIC) -> Multipliers:
    """All six of a lift."""
    found = (
        horizontal_multiplier(lift.horizontal, units),
        vertical_multiplier(lift.height, units),
        distance_multiplier(lift.travel, units),
        asymmetry_multiplier(lift.asymmetry_deg),
        frequency_multiplier(lift.per_min, lift.hours, lift.height, units),
        grip_multiplier(lift.grip, lift.height, units),
    )
    return Multipliers(*map(float, found))


def recommended_weight_limit(lift: Lift, units: Constants = METRIC) -> float:
    """RWL = LC HM VM DM AM FM CM, in the unit of the load; 0 where it should not be lifted at all."""
    found = multipliers(lift, units)
    return units.load * found.without_frequency * found.fm


def lifting_index(lift: Lift, units: Constants = METRIC) -> float:
    """LI = load / RWL; inf where the limit is 0. Up to 1 nearly everybody may, beyond 3 many are hurt."""
    return ratio(lift.load, recommended_weight_limit(lift, units))


def ratio(load: float, limit: float) -> float:
    """How many times its limit a load is."""
    return load / limit if limit > 0 else (math.inf if load > 0 else 0.0)
