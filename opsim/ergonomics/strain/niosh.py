"""Lifting, limits of postures, holds, repetition, energy and the rest they ask for.

Tables and constants of the revised NIOSH lifting equation.

Source: Waters, Putz-Anderson & Garg 1994, Applications manual for the revised NIOSH lifting equation, DHHS (NIOSH)
publication 94-110 (revised 9/2021), tables 1 to 5 and 7; public domain.

The revised NIOSH lifting equation: recommended weight limit and lifting index of one kind of lift.

Source: Waters, Putz-Anderson, Garg & Fine 1993, Ergonomics 36(7), 749-776; Waters, Putz-Anderson & Garg 1994, DHHS
(NIOSH) 94-110. Two hands, standing, smooth, no more than 8 h; not for one hand, sitting, kneeling, shovels or barrows.

The composite lifting index of a job of several kinds of lifts.

Source: Waters, Putz-Anderson & Garg 1994, DHHS (NIOSH) 94-110, section 2.4 (multi-task procedure).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opsim.problems import did_you_mean, shown


@dataclass(frozen=True, slots=True)
class Constants:
    """The equation in one system of units; lengths in its own unit, loads in its own.

    load          : the load constant LC, what nearly everybody may lift in the best of places
    near, far     : H at and below which HM is 1, beyond which it is 0
    knuckle, per_height, highest : VM = 1 - per_height |V - knuckle|, 0 beyond highest
    short, per_travel, longest   : DM = 0.82 + per_travel / D, 1 up to short, 0 beyond longest
    """

    load: float
    near: float
    far: float
    knuckle: float
    per_height: float
    highest: float
    short: float
    per_travel: float
    longest: float


METRIC = Constants(23.0, 25.0, 63.0, 75.0, 0.003, 175.0, 25.0, 4.5, 175.0)
"""Centimetres and kilograms."""
US = Constants(51.0, 10.0, 25.0, 30.0, 0.0075, 70.0, 10.0, 1.8, 70.0)
"""Inches and pounds. NOTE: not the metric one in other units: the manual rounds each by itself (51 lb are 23.1 kg)."""
PER_DEGREE, MOST_ASYMMETRY_DEG = 0.0032, 135.0
"""AM = 1 - PER_DEGREE A, 0 beyond the most."""
PER_MIN = (0.2, 0.5, *map(float, range(1, 16)))
"""Lifts a minute, the rows of FM (table 5)."""
HOURS = (1, 2, 8)
"""Durations, the columns of FM: up to so many hours of lifting, with the recovery that goes with them."""
_UNTIL_10_1H = (1.0, 0.97, 0.94, 0.91, 0.88, 0.84, 0.8, 0.75, 0.7, 0.6, 0.52, 0.45)
_UNTIL_10_2H = (0.95, 0.92, 0.88, 0.84, 0.79, 0.72, 0.6, 0.5, 0.42, 0.35, 0.3, 0.26)
_UNTIL_8_8H = (0.85, 0.81, 0.75, 0.65, 0.55, 0.45, 0.35, 0.27, 0.22, 0.18)
FM = {
    (1, True): (*_UNTIL_10_1H, 0.41, 0.37, 0.0, 0.0, 0.0),
    (1, False): (*_UNTIL_10_1H, 0.41, 0.37, 0.34, 0.31, 0.28),
    (2, True): (*_UNTIL_10_2H, 0.0, 0.0, 0.0, 0.0, 0.0),
    (2, False): (*_UNTIL_10_2H, 0.23, 0.21, 0.0, 0.0, 0.0),
    (8, True): (*_UNTIL_8_8H, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (8, False): (*_UNTIL_8_8H, 0.15, 0.13, 0.0, 0.0, 0.0, 0.0, 0.0),
}
"""(hours, whether the hands are below knuckle height) -> FM at each of PER_MIN; linear between, 0 beyond the last."""
CM = {"good": (1.0, 1.0), "fair": (0.95, 1.0), "poor": (0.9, 0.9)}
"""Grip -> CM with the hands below and above the knuckle height (table 7)."""
RECOVERY = {1: 1.2, 2: 0.3}
"""Hours -> recovery after lifting, as a multiple of the time lifted, with which its column of FM may be used."""


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
