"""Tables and constants of the revised NIOSH lifting equation.

Source: Waters, Putz-Anderson & Garg 1994, Applications manual for the revised NIOSH lifting equation, DHHS (NIOSH)
publication 94-110 (revised 9/2021), tables 1 to 5 and 7; public domain.
"""

from __future__ import annotations

from dataclasses import dataclass


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
