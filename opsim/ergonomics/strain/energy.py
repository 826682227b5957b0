"""How much rest work asks for: after holding still (Rohmert), and after work that takes energy (Murrell, Price).

All numbers are from memory of what is commonly cited: neither the originals nor a review of them (El ahrache & Imbeau
2009, Comparison of rest allowance models for static muscular work, International Journal of Industrial Ergonomics 39,
73-80) were at hand. To be checked against them before anybody judges by them. All take averages of people; none is
meant for one person.

When somebody walks within a task: his feet leave the floor in turn.

Metabolic energy of postures, lifts, lowers, walking, carrying and holding.

Source: Garg, Chaffin & Herrin 1978, Prediction of metabolic rates for manual materials handling jobs, American
Industrial Hygiene Association Journal 39(8), 661-674. Net kilocalories of an activity are added to those of the posture
in which it is done. Body mass and load in kilograms, heights in metres, speed in m/s; sex is 1 for men, 0 for women.

How often bodies go down and come up again, beside what lifts of loads already count.

What shifts cost in energy: postures, lifts and lowers, holding, walking, by Garg, Chaffin & Herrin 1978.

Not seen is work of the arms without a load, which widens the figure (none to light work of both arms), and so does
going down and coming up without a load (not at all to the body's part of the paper's lowering and lifting). Not in it
are tools, pushing and pulling, and loads that nobody told. Who walks has empty hands, but for a job of a product that
is carried, if its mass is told; who walks within a task walks at his own speed. Whose sex is not said has the range of
both.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.ergonomics.angles import AT
from opsim.ergonomics.anthropometry import MASS_KG
from opsim.ergonomics.shift.frames import Frames
from opsim.ergonomics.strain.lifting import Lifted, Lifts, loads_kg
from opsim.plan import Plan

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


LIFTED_M = 0.02
"""One ankle is higher than the other by more than this, and its foot is off the floor. Source: design."""
LONGEST_S = 1.2
"""Feet that follow each other after more than this do not walk: slower than any walk at work. Source: design."""


def stepping(measures: np.ndarray, start_s: np.ndarray, seconds: np.ndarray) -> np.ndarray:
    """(N,) bool: frames within half of ``LONGEST_S`` of an instant at which one foot is lifted after the other.

    measures : (N, COLUMNS), in the order of time; what is not known is no step
    """
    higher = measures[:, AT["left_ankle_up_m"]] - measures[:, AT["right_ankle_up_m"]]
    side = np.where(np.abs(higher) > LIFTED_M, np.sign(np.nan_to_num(higher)), 0.0)
    lifted = np.flatnonzero(side)
    middle_s = start_s + 0.5 * seconds
    follows = (np.diff(side[lifted]) != 0) & (np.diff(middle_s[lifted]) <= LONGEST_S)
    steps_s = middle_s[lifted[1:][follows]]
    if not steps_s.size:
        return np.zeros(start_s.size, bool)
    after = np.searchsorted(steps_s, middle_s)
    near_s = [np.abs(middle_s - steps_s[np.clip(place, 0, steps_s.size - 1)]) for place in (after - 1, after)]
    return np.minimum(*near_s) <= 0.5 * LONGEST_S


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


BENT_DEG = 20.0
"""Trunk flexion from which one stands bent. Source: design; the paper says "standing bent position"."""
SQUAT_DEG = 60.0
"""Bend of the knees at the lower end from which a lift is a squat and not a stoop. Source: design."""


@dataclass(frozen=True, slots=True, eq=False)
class Bends:
    """B bends (B,): whose (rank), the lowest height of the hands in metres, whether the knees bend for it, and whether
    the way down and the way up are without a load."""

    worker: np.ndarray
    low_m: np.ndarray
    squat: np.ndarray
    down: np.ndarray
    up: np.ndarray


def bends_of(frames: Frames, held: np.ndarray, may: np.ndarray) -> Bends:
    """Hands below BENCH_M while trunk or knees are bent, as long as it lasts without a break.

    held : (N,) bool, with a load; may : (N,) bool, which frames count
    """
    hands_m, knees, trunk = _at(frames, "hand_up_m"), _at(frames, "knee"), frames.measures[:, AT["trunk_flexion"]]
    low = may & (hands_m < BENCH_M) & ((trunk >= BENT_DEG) | (knees >= SQUAT_DEG))
    at = np.flatnonzero(low)
    if not at.size:
        none = np.empty(0, bool)
        return Bends(np.empty(0, int), np.empty(0), none, none, none)
    apart = (np.diff(at) > 1) | (frames.start_s[at[1:]] - frames.end_s[at[:-1]] > 1e-3)
    begins = np.flatnonzero(np.r_[True, apart])
    ends = np.r_[begins[1:], at.size]
    least_m, deepest = np.minimum.reduceat(hands_m[at], begins), np.maximum.reduceat(np.nan_to_num(knees[at]), begins)
    who = np.full(begins.size, frames.worker)
    return Bends(who, least_m, deepest >= SQUAT_DEG, ~held[at[begins]], ~held[at[ends - 1]])


def joined(parts: list[Bends]) -> Bends:
    """All of some."""
    if not parts:
        none = np.empty(0, bool)
        return Bends(np.empty(0, int), np.empty(0), none, none, none)
    return Bends(*(np.concatenate([getattr(one, name) for one in parts]) for name in Bends.__slots__))


def bending_kcal(bends: Bends, worker: int, body_kg: float, sex: float) -> float:
    """Net, of one worker's ways down and up without a load: the body's own part of lowering and lifting.

    Source: Garg, Chaffin & Herrin 1978 with a load of 0; that this may stand for a bend without one is the design's.
    """
    own = bends.worker == worker
    low_m, squat = bends.low_m[own], bends.squat[own]
    down = moved_kcal(body_kg, 0.0, BENCH_M, low_m, sex, squat)
    up = moved_kcal(body_kg, 0.0, low_m, BENCH_M, sex, squat)
    return float(down[bends.down[own]].sum() + up[bends.up[own]].sum())


def _at(frames: Frames, name: str) -> np.ndarray:
    """(N,) the mean of both sides, or the side that is known."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # numpy: "mean of empty slice" where both sides are missing
        return np.asarray(np.nanmean(frames.measures[:, [AT[f"left_{name}"], AT[f"right_{name}"]]], axis=1))


SEXES = {"m": (1.0, 1.0), "f": (0.0, 0.0)}
"""The paper's number of a sex, at least and at most."""


@dataclass(frozen=True, slots=True, eq=False)
class Energy:
    """Of W workers: (W, 2) kcal at least and at most of the time they were there and in no break, (W,) minutes of it;
    (W,) kcal and minutes of breaks, taken as sitting."""

    work_kcal: np.ndarray
    work_min: np.ndarray
    break_kcal: np.ndarray
    break_min: np.ndarray

    @property
    def kcal_per_min(self) -> np.ndarray:
        """(W, 2) over all the time they were there; nan for who never was."""
        return (self.work_kcal + self.break_kcal[:, None]) / _or_nan(self.work_min + self.break_min)[:, None]

    @property
    def work_kcal_per_min(self) -> np.ndarray:
        """(W, 2) breaks aside."""
        return self.work_kcal / _or_nan(self.work_min)[:, None]


class Spent:
    """A fold over workers' days: seconds bent and seated, kilograms held, ways within tasks, free arms, lifts, bends.

    bent_s, sitting_s, free_s : (W,) seconds; free_s of standing work without a load
    kg_s     : (W, 2) seconds of standing with a load in the hands, times its kilograms, at least and at most: no body
        and no share of its time says when hands are full at a mark
    walked_s : (W, tasks, 2) seconds of walking within a task, without and with its load
    """

    def __init__(self, plan: Plan):
        n, n_tasks = len(plan.workers), len(plan.tasks)
        self._loads_kg = np.r_[loads_kg(plan), 0.0, 0.0]
        self._sits = np.array([*(task.handling.sitting is True for task in plan.tasks), False, False])
        self._by_share = np.array([*(task.handling.by_share for task in plan.tasks), True, True])
        self._lifted, self._bends = Lifted(plan), list[Bends]()
        self.bent_s, self.sitting_s, self.free_s = (np.zeros(n) for _ in range(3))
        self.kg_s = np.zeros((n, 2))
        self.walked_s = np.zeros((n, n_tasks, 2))

    def add(self, frames: Frames, scores: Any = None) -> None:
        """The next stretch."""
        rank, seconds, sits = frames.worker, frames.seconds, self._sits[frames.task]
        bent = frames.measures[:, AT["trunk_flexion"]] >= BENT_DEG
        held_kg = np.where(frames.carrying, self._loads_kg[frames.task], 0.0)
        surely = self._by_share[frames.task] | frames.known
        self.bent_s[rank] += seconds[bent & ~sits].sum()
        self.sitting_s[rank] += seconds[sits].sum()
        works = frames.task >= 0
        walks = works & ~sits & stepping(frames.measures, frames.start_s, seconds)
        np.add.at(self.walked_s[rank], (frames.task[walks], (held_kg[walks] > 0).astype(int)), seconds[walks])
        self.kg_s[rank] += [seconds[some] @ held_kg[some] for some in (~walks & surely, ~walks)]
        self.free_s[rank] += seconds[((held_kg <= 0) | ~surely) & works & ~walks].sum()
        self._bends.append(bends_of(frames, held_kg > 0, works & ~sits & ~walks))
        self._lifted.add(frames)

    def lifts(self) -> Lifts:
        """All lifts and lowers."""
        return self._lifted.lifts()

    def bends(self) -> Bends:
        """All ways down and up."""
        return joined(self._bends)


def energy(
    spent: Spent,
    there_s: np.ndarray,
    break_s: np.ndarray,
    walk_s: np.ndarray,
    plan: Plan,
    carried_s: Sequence[tuple[int, float, float]] = (),
) -> Energy:
    """The energy of each of W workers, from what his body did and how long, (W,) each, he was there, in a break, and
    walking.

    carried_s : (worker, kilograms, seconds) of the walks among these on which he carries something
    """
    mass = np.array([MASS_KG if one.body.mass_kg is None else one.body.mass_kg for one in plan.workers], float)
    speed = np.array([one.walk_m_per_s for one in plan.workers], float)
    work_s = np.maximum(there_s - break_s, 0.0)
    standing_s = np.maximum(work_s - spent.bent_s - spent.sitting_s, 0.0)
    times_s = {"standing": standing_s, "bent": spent.bent_s, "sitting": spent.sitting_s}
    posture = mass * sum(POSTURES[name] * seconds / 60.0 for name, seconds in times_s.items())
    moving = walking_kcal_per_min(mass, speed) * (walk_s + spent.walked_s[:, :, 0].sum(axis=1)) / 60.0
    loaded = walking_kcal_per_min(mass[:, None], speed[:, None], loads_kg(plan)) * spent.walked_s[:, :, 1] / 60.0
    moving = moving + loaded.sum(axis=1)
    for rank, kg, seconds in carried_s:
        with_it, empty = (walking_kcal_per_min(mass[rank], speed[rank], load) for load in (kg, 0.0))
        moving[rank] += (with_it - empty) * seconds / 60.0
    arms = ARM_WORK_KCAL_PER_MIN["light"] * spent.free_s / 60.0
    kcal = (posture + moving)[:, None] + lifting_kcal(spent.lifts(), plan) + holding_kcal_per_min(spent.kg_s) / 60.0
    kcal[:, 1] += arms + _bending_kcal(spent.bends(), plan)
    return Energy(kcal, work_s / 60.0, mass * POSTURES["sitting"] * break_s / 60.0, break_s / 60.0)


def lifting_kcal(lifts: Lifts, plan: Plan) -> np.ndarray:
    """(W, 2) net kcal of each worker's lifts and lowers, at least and at most over what his sex may be."""
    load_kg, found = loads_kg(plan)[lifts.task], np.zeros((len(plan.workers), 2))
    lower = np.take_along_axis(lifts.knee_deg, lifts.height_m.argmin(axis=1)[:, None], axis=1)[:, 0]
    for rank, worker in enumerate(plan.workers):
        own = lifts.worker == rank
        mass = MASS_KG if worker.body.mass_kg is None else worker.body.mass_kg
        squat, sexes = lower[own] >= SQUAT_DEG, SEXES.get(worker.body.sex or "", (0.0, 1.0))
        taken_m, let_go_m = lifts.height_m[own].T
        by_sex = [moved_kcal(mass, load_kg[own], taken_m, let_go_m, sex, squat) for sex in sexes]
        found[rank] = np.minimum(*by_sex).sum(), np.maximum(*by_sex).sum()
    return found


def _bending_kcal(bends: Bends, plan: Plan) -> np.ndarray:
    """(W,) at most, over what each one's sex may be."""
    masses = [MASS_KG if one.body.mass_kg is None else one.body.mass_kg for one in plan.workers]
    sexes = [SEXES.get(one.body.sex or "", (0.0, 1.0)) for one in plan.workers]
    return np.array(
        [
            max(bending_kcal(bends, rank, mass, sex) for sex in either)
            for rank, (mass, either) in enumerate(zip(masses, sexes))
        ]
    )


def _or_nan(minutes: np.ndarray) -> np.ndarray:
    return np.where(minutes > 0, minutes, np.nan)
