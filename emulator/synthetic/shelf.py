"""A made task with a known reach: both hands to a shelf at any height, by people of any stature.

What the height decides is put in: how far the trunk bends, how deep the hips sink and how long it takes. All three go
by the height over the body's scale, so that a short person at one shelf does what a tall one does at a higher one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator.motion import Motion, MotionSet, motion_from_positions
from emulator.skeleton import standard_skeleton
from emulator.synthetic.choreography import REST, Body, Fields, joints_m
from emulator.synthetic.tasks import LICENCE, RATE_HZ, SOURCE, warps_of

TASK, MARK = "shelf", "grasp"
LOWEST_M, HIGHEST_M, HIGHEST_SHARE = 0.1, 1.9, 1.03
"""Heights of shelves; nobody reaches for one above this share of his stature."""
MARK_CLOCK, MARK_SPREAD = 0.5, 0.012
ARM_M, TRUNK_M = 0.47, 0.44
"""How far a wrist is from its shoulder at most when a person chooses, and the shoulder from the pelvis, of a body
1.75 m tall: the arm itself is 0.55 m long."""
BETWEEN, WITHIN = np.array([0.05, 0.08, 0.015, 0.01]), np.array([0.05, 0.07, 0.02, 0.02])
"""Standard deviations between and within people: of log trunk flexion, of log duration, how far ahead and aside (m)."""
_CLOCK = np.linspace(0.0, 1.0, 201)


def trunk_flexion_rad(height: np.ndarray) -> np.ndarray:
    """What is put in on average at heights (...,) over the body's scale, in metres of a body 1.75 m tall."""
    return np.asarray(0.04 + 1.20 * _rise((0.62 - height) / 0.17))


def median_duration_s(height: np.ndarray) -> np.ndarray:
    """The same of the duration."""
    return np.asarray(1.6 * np.exp(0.45 * _rise((0.60 - height) / 0.16) + 0.22 * _rise((height - 1.5) / 0.12)))


def ahead_m(height: np.ndarray) -> np.ndarray:
    """The same of how far ahead the hands are."""
    return np.asarray(0.28 + 0.12 * np.exp(-(((height - 1.0) / 0.45) ** 2)))


def _rise(x: np.ndarray) -> np.ndarray:
    return np.asarray(1.0 / (1.0 + np.exp(-x)))


def highest_m(stature_m: float) -> float:
    """The highest shelf that somebody reaches for."""
    return min(HIGHEST_M, HIGHEST_SHARE * stature_m)


@dataclass(frozen=True)
class Reacher:
    """A made person: the body, and by how much the four of ``BETWEEN`` differ from anybody's, (4,)."""

    body: Body
    habit: np.ndarray

    @classmethod
    def of(cls, stature_m: float, rng: np.random.Generator) -> Reacher:
        """Somebody of this stature."""
        return cls(Body(stature_m), BETWEEN * rng.standard_normal(4))


def crew(n: int, rng: np.random.Generator, low_m: float = 1.5, high_m: float = 2.0) -> list[Reacher]:
    """n people, statures evenly from low to high in a random order."""
    statures = low_m + (high_m - low_m) * (np.arange(n) + 0.5) / n
    return [Reacher.of(float(stature), rng) for stature in rng.permutation(statures)]


def make_shelf(
    people: Sequence[Reacher], n_repetitions: int = 20, *, rng: np.random.Generator, heights_m: Sequence[float] = ()
) -> MotionSet:
    """``n_repetitions`` reaches of each person at heights spread evenly over that person's range, or at ``heights_m``.

    Recordings keep the height as ``cov_shelf_m`` and the stature as ``cov_height_m``.
    """
    motions = []
    for w, person in enumerate(people):
        low, high = LOWEST_M, highest_m(person.body.stature_m)
        even = low + (high - low) * (rng.permutation(n_repetitions) + rng.random(n_repetitions)) / n_repetitions
        own = np.resize(np.asarray(heights_m, float), n_repetitions) if len(heights_m) else even
        motions += [_motion(person, height, f"w{w + 1}", f"r{i + 1}", rng) for i, height in enumerate(own.tolist())]
    return MotionSet(TASK, tuple(motions), (MARK,), SOURCE, LICENCE)


def _motion(person: Reacher, height_m: float, worker: str, trial: str, rng: np.random.Generator) -> Motion:
    luck, scale = person.habit + WITHIN * rng.standard_normal(4), person.body.scale
    gamma = warps_of(rng.standard_normal((1, 3)))[0]
    duration_s = float(median_duration_s(np.array(height_m / scale)) * np.exp(luck[1]))
    n_times = max(round(duration_s * RATE_HZ) + 1, 20)
    clock = np.interp(np.linspace(0, 1, n_times), gamma, _CLOCK)
    mark = MARK_CLOCK + MARK_SPREAD * rng.standard_normal()
    return motion_from_positions(
        standard_skeleton(),
        joints_m(_pose(clock, height_m / scale, luck), person.body),
        (n_times - 1) / duration_s,
        worker=worker,
        trial=trial,
        mark_s=[duration_s * float(np.interp(mark, _CLOCK, gamma))],
        covariates={"cov_height_m": person.body.stature_m, "cov_shelf_m": height_m},
    )


def _pose(clock: np.ndarray, height: float, luck: np.ndarray) -> Fields:
    """The fields of a body 1.75 m tall: from rest to the shelf and back, at rest at both ends and there."""
    share = np.where(clock < MARK_CLOCK, clock / MARK_CLOCK, (1.0 - clock) / (1.0 - MARK_CLOCK))
    eased = (share**2 * (3.0 - 2.0 * share))[:, None]
    there = _at_shelf(height, luck)
    return {name: rest + eased * (there.get(name, rest) - rest) for name, rest in REST.items()}


def _at_shelf(height: float, luck: np.ndarray) -> Fields:
    pitch = float(trunk_flexion_rad(np.array(height))) * np.exp(luck[0])
    ahead = float(ahead_m(np.array(height))) + luck[2]
    back = -0.22 * np.sin(pitch)
    level = ahead - back - TRUNK_M * np.sin(pitch)
    most = height + np.sqrt(max(ARM_M**2 - level**2, 0.01)) - TRUNK_M * np.cos(pitch)
    sunk = 0.05 * np.log1p(np.exp((REST["pelvis"][2] - most) / 0.05))
    wrists = {
        f"{side}_wrist": np.array([ahead, sign * 0.16 + luck[3], height]) for side, sign in (("left", 1), ("right", -1))
    }
    return wrists | {
        "pelvis": np.array([back, 0.0, REST["pelvis"][2] - sunk]),
        "pitch": np.array([pitch]),
        "twist": np.array([1.5 * luck[3]]),
        "nod": np.array([0.1 - 0.3 * pitch]),
    }
