"""How long a beat takes and how far a step goes: learned from the recordings, by speed and by worker.

Steps: log step length in legs = intercept + slope log Froude speed (speed over sqrt(g leg)), as walk ratio and dynamic
similarity have it (Sekiya & Nagasaki 1998; Hof 1996); the time of a step is its length over the speed.
Other cycles: log seconds of a cycle = intercept.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

GRAVITY_M_PER_S2 = 9.81
SLOWEST_M_PER_S, FASTEST_M_PER_S = 0.3, 2.5
SHORTEST_STEP_S = 0.38
"""Of a leg 0.92 m long: nobody walks faster than about 160 steps a minute."""
LONGEST = 1.25
"""A step is at most this much longer than usual at the speed asked for, however short and hurried the way."""


@dataclass(frozen=True)
class Pace:
    """steps : whether beats are steps; start_beats, stop_beats : what starting and stopping take, in beats

    intercept, slope : see above; time_cv, length_cv : scatter of beats, and ``follows`` how one follows the other
    usual : log Froude speed of a usual walk, 0 for other cycles; first : the first step over the others
    default : metres, or cycles, of a performance of which nothing is asked
    low, high : log steps, in legs, recorded (of other cycles: log seconds)
    """

    steps: bool
    intercept: float
    slope: float
    time_cv: float
    length_cv: float
    follows: float
    start_beats: float
    stop_beats: float
    usual: float
    first: float
    default: float
    low: float
    high: float

    def step_m(self, speed_m_per_s: np.ndarray, leg_m: np.ndarray, log_step: np.ndarray) -> np.ndarray:
        """(n,) usual steps at a speed of workers with these legs; ``log_step`` is their own."""
        froude = np.log(speed_m_per_s / np.sqrt(GRAVITY_M_PER_S2 * leg_m))
        return np.asarray(leg_m * np.exp(self.intercept + self.slope * froude + log_step))

    def usual_m_per_s(self, leg_m: np.ndarray) -> np.ndarray:
        """(n,) the speed of a usual walk with these legs."""
        return np.asarray(np.exp(self.usual) * np.sqrt(GRAVITY_M_PER_S2 * leg_m))

    @property
    def before_first(self) -> int:
        """How many beats come before the first step: none from standing, else one, at which a draw begins."""
        return int(self.start_beats == 0)

    @property
    def beyond(self) -> float:
        """How many beats longer than its n steps a walk takes: n + beyond is positive for n = 1, too."""
        return self.start_beats + self.stop_beats - 1 + self.before_first

    @property
    def halves(self) -> float:
        """How many steps further than n the root goes in n steps.

        At a strike it is half a step behind the foot that comes down, so what ends at one goes half a step less, and
        what begins at one but ends standing half a step more.
        """
        return 0.5 * self.before_first - 0.5 * (self.stop_beats == 0)

    def gone_m(self, place_m: np.ndarray) -> np.ndarray:
        """(n,) how far the root goes over footprints at places (n, B), nan beyond the last; 0 where there are none."""
        last = np.sort(np.hstack([np.zeros((len(place_m), 2)), np.nan_to_num(place_m)]), axis=1)[:, -2:]
        return np.asarray(last[:, 1] if self.stop_beats else last.mean(axis=1))

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


@dataclass(frozen=True, eq=False)
class Asked:
    """What is asked of n performances: metres and speed (steps) or cycles (others), each (n,); nan where not asked.

    speed_m_per_s of other cycles is how many times as fast as usual
    total_s : (n,) the exact duration, steps : (n,) the exact number of steps; nan where they follow from the rest
    """

    length: np.ndarray
    speed_m_per_s: np.ndarray
    total_s: np.ndarray
    steps: np.ndarray


@dataclass(frozen=True, eq=False)
class Itinerary:
    """Beats of n performances before any scatter. n_beats (n,) B: full steps (and the strike that a walk begins at,
    where it does not begin standing), or cycles and one.

    beat_s (n,) mean seconds of a beat, step_m (n,) mean step (0 where nothing is walked), duration_s (n,) its mean
    speed_m_per_s (n,) while the beats go on
    """

    n_beats: np.ndarray
    beat_s: np.ndarray
    step_m: np.ndarray
    duration_s: np.ndarray
    speed_m_per_s: np.ndarray
    exact: np.ndarray


def itinerary(pace: Pace, asked: Asked, leg_m: np.ndarray, log_step: np.ndarray) -> Itinerary:
    """How many beats of what length; ``log_step`` (n,) the workers' own: log step, or log seconds of a cycle."""
    return _walked(pace, asked, leg_m, log_step) if pace.steps else _cycled(pace, asked, log_step)


def _walked(pace: Pace, asked: Asked, leg_m: np.ndarray, log_step: np.ndarray) -> Itinerary:
    """The mean speed over the whole way is the one asked for: the shorter the way, the brisker its middle."""
    way_m, speed = asked.length, asked.speed_m_per_s
    exact = np.isfinite(asked.total_s)
    duration_s = np.where(exact, asked.total_s, way_m / speed)
    usual_m = pace.step_m(speed, leg_m, log_step)
    beyond, halves = pace.beyond, pace.halves
    n = _n_steps(way_m, usual_m, halves, asked)
    for _ in range(3):
        steady = way_m / (n + halves) / (duration_s / (n + beyond))
        step_m = np.minimum(pace.step_m(np.maximum(steady, speed), leg_m, log_step), LONGEST * usual_m)
        n = _n_steps(way_m, step_m, halves, asked)
    least_s = np.where(exact, 0.0, SHORTEST_STEP_S * np.sqrt(leg_m / 0.92))
    beat_s = np.maximum(duration_s / (n + beyond), least_s)
    mean_m, n_beats = way_m / (n + halves), n.astype(int) + pace.before_first
    return Itinerary(n_beats, beat_s, mean_m, beat_s * (n + beyond), mean_m / beat_s, exact)


def _n_steps(way_m: np.ndarray, step_m: np.ndarray, halves: float, asked: Asked) -> np.ndarray:
    """(n,) so many that none is more than an eighth longer than ``step_m``."""
    enough = np.maximum(np.ceil(way_m / step_m - halves - 0.4), np.ceil(way_m / step_m / 1.125 - halves - 1e-9))
    return np.asarray(np.where(np.isfinite(asked.steps), asked.steps, np.maximum(enough, 1.0)))


def _cycled(pace: Pace, asked: Asked, log_step: np.ndarray) -> Itinerary:
    usual_s = np.exp(pace.intercept + log_step) / asked.speed_m_per_s
    beyond, exact = pace.start_beats + pace.stop_beats, np.isfinite(asked.total_s)
    of_time = np.maximum(np.rint(np.where(exact, asked.total_s, 0.0) / usual_s - beyond), 1.0)
    n = np.where(np.isfinite(asked.length), asked.length, of_time)
    beat_s = np.where(exact, asked.total_s / (n + beyond), usual_s)
    zero = np.zeros_like(beat_s)
    return Itinerary(n.astype(int) + 1, beat_s, zero, beat_s * (n + beyond), zero, exact)


def scatter(n: int, cv: float, follows: float, rng: np.random.Generator) -> np.ndarray:
    """(n,) factors about 1 with this coefficient of variation, each following the one before."""
    noise = rng.standard_normal(n)
    for k in range(1, n):
        noise[k] = follows * noise[k - 1] + np.sqrt(1 - follows**2) * noise[k]
    return np.asarray(1 + cv * np.clip(noise, -3.0, 3.0))
