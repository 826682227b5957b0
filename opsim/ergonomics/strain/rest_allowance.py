"""How much rest work asks for: after holding still (Rohmert), and after work that takes energy (Murrell, Price).

All numbers are from memory of what is commonly cited: neither the originals nor a review of them (El ahrache & Imbeau
2009, Comparison of rest allowance models for static muscular work, International Journal of Industrial Ergonomics 39,
73-80) were at hand. To be checked against them before anybody judges by them. All take averages of people; none is
meant for one person.
"""

from __future__ import annotations

import numpy as np

ENDLESS = 0.15
"""Share of strength up to which a force may be held for any time. Source: Rohmert 1960."""
RESTING_KCAL_PER_MIN = 1.5
"""Murrell 1965, Ergonomics: man in his working environment, Chapman & Hall."""
STANDARD_KCAL_PER_MIN = {"m": 5.0, "f": 4.0}
"""What may be spent all day long. Murrell 1965 for men; for women as in Wickens et al., Introduction to human factors
engineering, chapter on work physiology."""
WATTS_PER_KCAL_PER_MIN = 69.78
"""4186.8 J / 60 s."""
PRICE_ACCEPTABLE_W, PRICE_RESTING_W = 300.0, 105.0
"""Acceptable work level, and sitting at rest. Price 1990, Calculating relaxation allowances for construction
operatives, part 1: metabolic cost, Applied Ergonomics 21(4), 311-317. From memory, to be checked."""


def holding_time_min(share: np.ndarray | float) -> np.ndarray:
    """How long a share of strength, 0 to 1, can be held until exhaustion: -1.5 + 2.1/f - 0.6/f^2 + 0.1/f^3 minutes.

    inf up to ENDLESS; what is more than all strength counts as all. Source: Rohmert 1960, Ermittlung von
    Erholungspausen fuer statische Arbeit des Menschen, Int. Z. angew. Physiol. 18, 123-164.
    """
    f = np.clip(np.asarray(share, float), ENDLESS, 1.0)
    time = -1.5 + 2.1 / f - 0.6 / f**2 + 0.1 / f**3
    return np.where(np.asarray(share) <= ENDLESS, np.inf, time)


def rohmert_rest_share(held_min: np.ndarray | float, share: np.ndarray | float) -> np.ndarray:
    """Rest after holding a share of strength, as a multiple of the time held: 18 (t / T)^1.4 (f - 0.15)^0.5.

    T is the longest time it can be held; who says he held longer has t = T. 0 up to ENDLESS. Source: Rohmert 1973,
    Problems in determining rest allowances, part 1, Applied Ergonomics 4(2), 91-95.
    """
    f = np.clip(np.asarray(share, float), 0.0, 1.0)
    used = np.minimum(np.asarray(held_min, float) / holding_time_min(f), 1.0)
    return 18.0 * used**1.4 * np.sqrt(np.maximum(f - ENDLESS, 0.0))


def murrell_rest_share(kcal_per_min: np.ndarray | float, standard_kcal_per_min: float = 5.0) -> np.ndarray:
    """Share of the whole time, work and rest, that must be rest: (W - S) / (W - 1.5); 0 for work within the standard.

    W: of the work, with the body's own; at rest 1.5. Source: Murrell 1965, R = T (W - S) / (W - 1.5).
    """
    w = np.asarray(kcal_per_min, float)
    over = np.maximum(w - standard_kcal_per_min, 0.0)
    return over / np.maximum(w - RESTING_KCAL_PER_MIN, standard_kcal_per_min - RESTING_KCAL_PER_MIN)


def price_relaxation(kcal_per_min: np.ndarray | float) -> np.ndarray:
    """Rest as a multiple of the time worked: (W - 300) / (300 - 105) with W in watts; 0 within the acceptable level."""
    watts = np.asarray(kcal_per_min, float) * WATTS_PER_KCAL_PER_MIN
    return np.maximum(watts - PRICE_ACCEPTABLE_W, 0.0) / (PRICE_ACCEPTABLE_W - PRICE_RESTING_W)


def of_whole(multiple: np.ndarray | float) -> np.ndarray:
    """Rest as a share of work and rest together, from rest as a multiple of the work."""
    m = np.asarray(multiple, float)
    return m / (1.0 + m)
