"""Metabolic energy of postures, lifts, lowers, walking, carrying and holding.

Source: Garg, Chaffin & Herrin 1978, Prediction of metabolic rates for manual materials handling jobs, American
Industrial Hygiene Association Journal 39(8), 661-674. Net kilocalories of an activity are added to those of the posture
in which it is done. Body mass and load in kilograms, heights in metres, speed in m/s; sex is 1 for men, 0 for women.
"""

from __future__ import annotations

import numpy as np

POSTURES = {"sitting": 0.023, "standing": 0.024, "bent": 0.028}
"""kcal a minute for each kilogram of body mass."""
BENCH_M = 0.81
"""Height of the hands (32 inches) up to which one bends to a load, and from which the arms alone lift it."""
Number = np.ndarray | float


def posture_kcal_per_min(posture: str, body_kg: Number) -> Number:
    """Of sitting, standing or standing bent, without any activity."""
    return POSTURES[posture] * body_kg


def stoop_lift_kcal(body_kg: Number, load_kg: Number, low_m: Number, high_m: Number, sex: Number) -> Number:
    """Of one lift with a bent back, from low to high, both at most BENCH_M."""
    return 0.01 * (0.325 * body_kg * (BENCH_M - low_m) + (1.41 + 0.76 * sex) * load_kg * (high_m - low_m))


def squat_lift_kcal(body_kg: Number, load_kg: Number, low_m: Number, high_m: Number, sex: Number) -> Number:
    """Of one lift with bent knees, from low to high, both at most BENCH_M."""
    return 0.01 * (0.514 * body_kg * (BENCH_M - low_m) + (2.19 + 0.62 * sex) * load_kg * (high_m - low_m))


def arm_lift_kcal(body_kg: Number, load_kg: Number, low_m: Number, high_m: Number, sex: Number) -> Number:
    """Of one lift with the arms, from low to high, both at least BENCH_M."""
    return 0.01 * (0.062 * body_kg * (high_m - BENCH_M) + (3.19 - 0.52 * sex) * load_kg * (high_m - low_m))


def stoop_lower_kcal(body_kg: Number, load_kg: Number, low_m: Number, high_m: Number, sex: Number) -> Number:
    """Of putting down with a bent back, from high to low, both at most BENCH_M."""
    bent = 0.268 * body_kg + 5.22 * sex
    return 0.01 * (bent * (BENCH_M - low_m) + 0.675 * load_kg * (high_m - low_m))


def squat_lower_kcal(body_kg: Number, load_kg: Number, low_m: Number, high_m: Number, sex: Number) -> Number:
    """Of putting down with bent knees, from high to low, both at most BENCH_M; the same for both sexes."""
    del sex
    return 0.01 * (0.511 * body_kg * (BENCH_M - low_m) + 0.701 * load_kg * (high_m - low_m))


def arm_lower_kcal(body_kg: Number, load_kg: Number, low_m: Number, high_m: Number, sex: Number) -> Number:
    """Of putting down with the arms, from high to low, both at least BENCH_M."""
    return 0.01 * (0.093 * body_kg * (high_m - BENCH_M) + (1.02 + 0.37 * sex) * load_kg * (high_m - low_m))


def moved_kcal(
    body_kg: Number, load_kg: Number, from_m: Number, to_m: Number, sex: Number, squat: np.ndarray | bool = False
) -> np.ndarray:
    """Net kcal of moving a load from one height of the hands to another, up or down.

    squat : whether the knees bend for it; else the back does
    What crosses BENCH_M is cut there: below with the body, above with the arms, as the equations are meant. Nothing for
    a load that is not moved up or down.
    """
    from_m, to_m = np.asarray(from_m, float), np.asarray(to_m, float)
    low, high = np.minimum(from_m, to_m), np.maximum(from_m, to_m)
    below, above = (low, np.minimum(high, BENCH_M)), (np.maximum(low, BENCH_M), high)
    found = np.zeros(np.broadcast(low, np.asarray(load_kg), np.asarray(body_kg)).shape)
    for up, stoop, bent, arm in (
        (True, stoop_lift_kcal, squat_lift_kcal, arm_lift_kcal),
        (False, stoop_lower_kcal, squat_lower_kcal, arm_lower_kcal),
    ):
        body = np.where(squat, bent(body_kg, load_kg, *below, sex), stoop(body_kg, load_kg, *below, sex))
        parts = np.where(below[1] > below[0], body, 0.0)
        parts = parts + np.where(above[1] > above[0], arm(body_kg, load_kg, *above, sex), 0.0)
        found = np.where((to_m > from_m) == up, parts, found)
    return np.where(to_m == from_m, 0.0, found)


def walking_kcal_per_min(body_kg: Number, speed_m_per_s: Number, load_kg: Number = 0.0) -> Number:
    """Net, on level ground, with what is carried held in front against the waist or thighs."""
    v2, load = np.square(speed_m_per_s), np.asarray(load_kg, float)
    empty = 0.01 * (51.0 + 2.54 * body_kg * v2)
    loaded = 0.01 * (68.0 + 2.54 * body_kg * v2 + 4.08 * load * v2 + 11.4 * load)
    return np.where(load > 0, loaded, empty)


def holding_kcal_per_min(load_kg: Number) -> Number:
    """Net, of holding a load at the waist with both hands."""
    return 0.062 * load_kg


ARM_WORK_KCAL_PER_MIN = {"none": 0.0, "light": 1.2, "heavy": 2.2}
"""Net, of working with both arms."""
