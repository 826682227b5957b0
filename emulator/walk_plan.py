"""Where and when the feet of a made walk come down: step length by speed and leg, stride-to-stride scatter.

Step length over cadence, the walk ratio, hardly changes with speed: 0.0063 m a step a minute, 10 % between people
(Sekiya & Nagasaki 1998; Terrier & Schutz 2003). In leg lengths and units of sqrt(g leg) (Hof 1996) that is
step = 1.16 sqrt(speed), which carries it over to other statures. Stride time scatters by 1.3 to 2 % (Hausdorff and
others 1999), double support takes a quarter of a step at 1.2 m/s and less the faster (Murray 1967).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.kinematics import Body

GRAVITY_M_PER_S2 = 9.81
WALK_RATIO_M_MIN = 0.0063
LEG_M = 0.92
"""Height of the hip of the 1.75 m tall, to whom the walk ratio belongs."""
STRIDE_TIME_CV = 0.02
STEP_LENGTH_CV = 0.025
_FOLLOWS = 0.3
"""Correlation of one step's time with the next one's."""
_SETTLE_S, _STAND_S = 0.5, 0.35


def leg_m(body: Body) -> float:
    """Height of the hip above the floor, standing."""
    return (0.918 + 0.85 * (body.leg - 1)) * body.scale


def step_length_m(speed_m_per_s: float, leg: float) -> float:
    """The usual step at a steady speed of somebody with this leg: constant walk ratio, scaled by Froude number."""
    usual = np.sqrt(60 * WALK_RATIO_M_MIN * np.sqrt(GRAVITY_M_PER_S2 * LEG_M)) / LEG_M
    return float(usual * leg * np.sqrt(speed_m_per_s / np.sqrt(GRAVITY_M_PER_S2 * leg)))


def double_support(speed_m_per_s: float, leg: float) -> float:
    """Share of a step in which both feet bear."""
    return float(np.clip(0.25 - 0.36 * (speed_m_per_s / np.sqrt(GRAVITY_M_PER_S2 * leg) - 0.4), 0.12, 0.36))


@dataclass(frozen=True, eq=False)
class WalkPlan:
    """One walk from standing to standing: S movements of a foot, the first a full step, the last one closing.

    first_foot : 0 if the left foot goes first, 1 if the right one
    place_m    : (S,) where the foot comes down along the way; the last two are the same: feet together
    off_s, strike_s : (S,) when the foot leaves the floor and comes down
    speed_m_per_s, leg_m, body, end_s : what was walked, by whom, how long the take is
    """

    first_foot: int
    place_m: np.ndarray
    off_s: np.ndarray
    strike_s: np.ndarray
    speed_m_per_s: float
    leg_m: float
    body: Body
    end_s: float

    @property
    def step_length_m(self) -> np.ndarray:
        """(S - 1,) metres of each full step."""
        return np.diff(self.place_m[:-1], prepend=0.0)

    @property
    def step_time_s(self) -> np.ndarray:
        """(S - 1,) seconds from one foot's strike to the other's."""
        return np.diff(self.strike_s)

    def foot(self, step: int) -> int:
        """0 for a left foot, 1 for a right one."""
        return (self.first_foot + step) % 2


def draw_plan(
    body: Body, speed_m_per_s: float, n_steps: int, first_foot: int, style: float, rng: np.random.Generator
) -> WalkPlan:
    """A walk of ``n_steps`` steps and a closing one. style : log of this person's walk ratio over the usual, halved."""
    leg = leg_m(body)
    usual_m = step_length_m(speed_m_per_s, leg) * np.exp(style)
    usual_s = usual_m / speed_m_per_s
    length_m = usual_m * (1 + STEP_LENGTH_CV * rng.standard_normal(n_steps))
    length_m[0] *= 0.86
    step_s = usual_s * (1 + _scatter(n_steps, rng))
    step_s[-1] *= 0.97
    both_s = usual_s * double_support(speed_m_per_s, leg)
    first_off_s = _STAND_S + 0.15 * usual_s + 0.30
    first_strike_s = first_off_s + 0.82 * usual_s * (1 + 0.02 * rng.standard_normal())
    strike_s = first_strike_s + np.concatenate([[0.0], np.cumsum(step_s)])
    off_s = np.concatenate([[first_off_s], strike_s[:-1] + both_s])
    place_m = np.cumsum(length_m)
    return WalkPlan(
        first_foot,
        np.append(place_m, place_m[-1]),
        off_s,
        strike_s,
        speed_m_per_s,
        leg,
        body,
        float(strike_s[-1] + _SETTLE_S + 0.3 * usual_s),
    )


def _scatter(n: int, rng: np.random.Generator) -> np.ndarray:
    """(n,) relative deviations of step times, such that two steps together scatter by ``STRIDE_TIME_CV``."""
    spread = STRIDE_TIME_CV / np.sqrt((1 + _FOLLOWS) / 2)
    noise, out = rng.standard_normal(n), np.empty(n)
    out[0] = noise[0]
    for k in range(1, n):
        out[k] = _FOLLOWS * out[k - 1] + np.sqrt(1 - _FOLLOWS**2) * noise[k]
    return spread * out
