"""Where and when the feet of a made walk come down: step length by speed and leg, stride-to-stride scatter.

Step length over cadence, the walk ratio, hardly changes with speed: 0.0063 m a step a minute, 10 % between people
(Sekiya & Nagasaki 1998; Terrier & Schutz 2003). In leg lengths and units of sqrt(g leg) (Hof 1996) that is
step = 1.16 sqrt(speed), which carries it over to other statures. Stride time scatters by 1.3 to 2 % (Hausdorff and
others 1999), double support takes a quarter of a step at 1.2 m/s and less the faster (Murray 1967).

A made walk as postures: a planted foot rolls over ankle and toe and does not slide, hips ride above the feet.

Everything is in metres of the average body, as the fields of ``kinematics.REST``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.synthetic.choreography import REST, SIDES, Body

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


Fields = dict[str, np.ndarray]
_FOOT_M, _FLAT_RAD, _ANKLE_M = 0.16, 0.36, 0.08
_FULL_REACH = 0.996
"""The most of its length to which a leg stretches."""
HALF_WIDTH_M = 0.06


@dataclass(frozen=True)
class Style:
    """How one person walks: factors about 1 on arm swing, bob of the trunk, roll of the foot, width; pitch in rad."""

    arms: float = 1.0
    sway: float = 1.0
    roll: float = 1.0
    width: float = 1.0
    pitch: float = 0.0
    twist: float = 1.0
    sink_m: float = 0.008


def draw_style(rng: np.random.Generator) -> Style:
    """Somebody: 15 % between people in most things."""
    r = np.clip(rng.standard_normal(7), -2, 2)
    return Style(
        1 + 0.18 * r[0],
        1 + 0.15 * r[1],
        1 + 0.10 * r[2],
        1 + 0.15 * r[3],
        0.025 * r[4],
        1 + 0.2 * r[5],
        0.008 + 0.003 * r[6],
    )


def walk_pose(plan: WalkPlan, style: Style, time_s: np.ndarray, rng: np.random.Generator) -> tuple[Fields, np.ndarray]:
    """Fields of ``REST`` at times (T,) and contact (T, 2), left and right."""
    step_s = 1 / (time_s[1] - time_s[0])
    brisk = plan.speed_m_per_s / np.sqrt(9.81 * plan.leg_m) / 0.43
    feet = [_foot(plan, style, side, time_s, brisk) for side in (0, 1)]
    ankles = np.stack([foot[0] for foot in feet], axis=1)
    contact = np.stack([foot[2] for foot in feet], axis=1)
    wander = _wander(len(time_s), 6, 0.25 * step_s, rng)
    moving = np.clip((time_s - 0.35) / 0.4, 0, 1) * np.clip((plan.end_s - 0.15 - time_s) / 0.6, 0, 1)
    pelvis = _pelvis(plan, style, time_s, ankles, wander, step_s)
    pose = {name: np.broadcast_to(rest, (len(time_s), len(rest))).copy() for name, rest in REST.items()}
    pose["pelvis"] = pelvis
    stride = _smooth((ankles[:, 0, 0] - ankles[:, 1, 0])[:, None], 0.05 * step_s)[:, 0]
    pose["pitch"][:, 0] += style.pitch + (0.02 + 0.03 * (brisk - 1)) * moving + 0.008 * wander[:, 0]
    pose["twist"][:, 0] += -0.13 * style.twist * stride + 0.01 * wander[:, 1]
    pose["lean"][:, 0] += -0.4 * pelvis[:, 1] + 0.006 * wander[:, 2]
    pose["look"][:, 0] += 0.13 * style.twist * stride
    for number, (side, sign) in enumerate(SIDES):
        pose[f"{side}_ankle"], pose[f"{side}_toe"] = feet[number][0], feet[number][1][:, None]
        swing = -sign * stride * (0.30 + 0.14 * brisk) * style.arms + 0.012 * wander[:, 3 + number]
        wrist = pose[f"{side}_wrist"]
        wrist[:, 0] += pelvis[:, 0] + swing + 0.03 * moving
        wrist[:, 1] += 0.7 * pelvis[:, 1]
        wrist[:, 2] += pelvis[:, 2] - REST["pelvis"][2] + 0.35 * swing**2 + 0.12 * np.maximum(swing, 0) + 0.02 * moving
    return pose, contact


def _foot(
    plan: WalkPlan, style: Style, side: int, time_s: np.ndarray, brisk: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ankle (T, 3), pitch (T,) of the foot, and whether it bears (T,)."""
    scale, sign = plan.body.scale, 1.0 if side == 0 else -1.0
    mine = [k for k in range(len(plan.place_m)) if plan.foot(k) == side]
    bears = np.ones(len(time_s), bool)
    flat = np.array([0.0, sign * 0.11, _ANKLE_M])
    ankle, pitch = np.tile(flat, (len(time_s), 1)), np.zeros(len(time_s))
    last = mine[-1] if mine else -1
    for k in mine:
        off_s, on_s = plan.off_s[k], plan.strike_s[k]
        small = 0.6 if k in (0, 1) or k == last else 1.0
        push = 0.95 * style.roll * np.clip(brisk, 0.6, 1.3) ** 0.5 * (0.75 if k == mine[0] or k == last else 1.0)
        land = -0.28 * style.roll * np.clip(brisk, 0.5, 1.4) * (0.1 if k >= len(plan.place_m) - 1 else small)
        rise_s = off_s - (0.30 if k > 1 else 0.26) * (on_s - off_s) / 0.7 * (1.15 if k > 1 else 1.0)
        ended = k == len(plan.place_m) - 1
        there = np.array([plan.place_m[k] / scale, sign * HALF_WIDTH_M * style.width, _ANKLE_M])
        if ended or k == len(plan.place_m) - 2:
            there[1] = sign * 0.09
        _roll(time_s, ankle, pitch, flat, push, rise_s, off_s, sign)
        _swing(time_s, ankle, pitch, flat, there, (push, land), (rise_s, off_s, on_s), sign)
        bears &= ~((time_s > off_s) & (time_s < on_s))
        after = time_s >= on_s
        ankle[after] = there
        pitch[after] = land * _down((time_s[after] - on_s) / (0.22 * (on_s - off_s) / 0.7))
        flat = there
    return ankle, pitch, bears


def _roll(
    time_s: np.ndarray,
    ankle: np.ndarray,
    pitch: np.ndarray,
    flat: np.ndarray,
    push: float,
    rise_s: float,
    off_s: float,
    sign: float,
) -> None:
    """The heel rises while the toe stays: from ``rise_s`` the ankle goes round it."""
    rows = (time_s >= rise_s) & (time_s <= off_s)
    u = (time_s[rows] - rise_s) / (off_s - rise_s)
    pitch[rows] = push * u**2 * (1.6 - 0.6 * u)
    ankle[rows] = _round_toe(flat, pitch[rows])


def _round_toe(flat: np.ndarray, pitch: np.ndarray) -> np.ndarray:
    """Ankles (T, 3) of a foot pitched about its toe, whose ankle was at ``flat``."""
    at = _FLAT_RAD + pitch
    ahead = _FOOT_M * (np.cos(_FLAT_RAD) - np.cos(at))
    return flat + np.stack([ahead, 0 * at, _FOOT_M * (np.sin(at) - np.sin(_FLAT_RAD))], axis=-1)


def _swing(
    time_s: np.ndarray,
    ankle: np.ndarray,
    pitch: np.ndarray,
    flat: np.ndarray,
    there: np.ndarray,
    angles: tuple[float, float],
    times: tuple[float, float, float],
    sign: float,
) -> None:
    """The foot flies from where it left the floor to where it lands, with the speed it left with."""
    (push, land), (rise_s, off_s, on_s) = angles, times
    rows = (time_s > off_s) & (time_s < on_s)
    u, fly_s = (time_s[rows] - off_s) / (on_s - off_s), on_s - off_s
    ends = np.array([push - 1e-4, push])
    start, before = _round_toe(flat, ends)[1], _round_toe(flat, ends)[0]
    rate = push * 1.4 / (off_s - rise_s)
    speed = (start - before) / 1e-4 * rate * fly_s
    path = _quintic(start, speed, there, u)
    turn = _quintic(np.array([push]), np.array([rate * fly_s * 0.6]), np.array([land]), u)[:, 0]
    path[:, 2] += 0.035 * np.sin(np.pi * u) ** 2 * (1 - 0.4 * u)
    path[:, 1] += sign * 0.012 * np.sin(np.pi * u) ** 2
    toe = path[:, 2] - _FOOT_M * np.sin(_FLAT_RAD + turn)
    clear = 0.0236 + 0.022 * np.sin(np.pi * u) ** 2
    path[:, 2] += 0.006 * np.logaddexp(0.0, (clear - toe) / 0.006) * np.minimum(1.0, 8 * np.minimum(u, 1 - u))
    ankle[rows], pitch[rows] = path, turn


def _quintic(start: np.ndarray, speed: np.ndarray, end: np.ndarray, u: np.ndarray) -> np.ndarray:
    """(T, C) from start with ``speed`` a unit of u to rest at end; no acceleration at either."""
    u = u[:, None]
    ease = u**3 * (10 - 15 * u + 6 * u**2)
    lead = u * (1 - u) ** 3 * (1 + 3 * u)
    return np.asarray(start + (end - start) * ease + speed * lead)


def _down(u: np.ndarray) -> np.ndarray:
    """1 to 0 over u from 0 to 1, softly at the end."""
    u = np.clip(u, 0.0, 1.0)
    return np.asarray((1 - u) ** 2 * (1 + 2 * u))


def _pelvis(
    plan: WalkPlan, style: Style, time_s: np.ndarray, ankles: np.ndarray, wander: np.ndarray, per_s: float
) -> np.ndarray:
    """(T, 3): between the feet at every strike, over the bearing foot between, as high as the legs reach."""
    from scipy.interpolate import PchipInterpolator
    from scipy.ndimage import minimum_filter1d

    scale = plan.body.scale
    place = np.concatenate([[0.0], plan.place_m]) / scale
    middle = 0.57 * place[1:] + 0.43 * place[:-1]
    middle[-1] = place[-1]
    start_s = plan.off_s[0] - 0.32
    at = np.concatenate([[time_s[0] - 1, start_s], plan.strike_s[:-1], [plan.strike_s[-1] + 0.12, time_s[-1] + 1]])
    ahead = PchipInterpolator(at, np.concatenate([[0.0, 0.0], middle, [place[-1]]]))(time_s)
    sides = np.array([1.0 if plan.foot(k) else -1.0 for k in range(len(plan.place_m))])
    sway_s = np.concatenate([[time_s[0] - 1, start_s], 0.5 * (plan.off_s + plan.strike_s), [plan.strike_s[-1] + 0.4]])
    wide = 0.022 * style.sway * sides
    wide[0] *= 1.8
    wide[-1] *= 1.2
    aside = PchipInterpolator(np.append(sway_s, time_s[-1] + 1), np.concatenate([[0, 0], wide, [0, 0]]))(time_s)
    level = _smooth(np.stack([ahead, aside], axis=1), 0.07 * per_s) + 0.002 * wander[:, :2]
    reach = 0.84 * plan.body.leg
    rest = REST["pelvis"][2]
    walking = np.clip((time_s - start_s) / 0.4, 0, 1) * np.clip((plan.strike_s[-1] + 0.45 - time_s) / 0.4, 0, 1)
    most = np.full((len(time_s), 3), rest + 0.85 * (plan.body.leg - 1))
    most[:, 2] -= style.sink_m * walking
    for side, sign in ((0, 1.0), (1, -1.0)):
        apart = np.hypot(ankles[:, side, 0] - level[:, 0], ankles[:, side, 1] - level[:, 1] - sign * 0.10)
        hip = ankles[:, side, 2] + np.sqrt(np.maximum((_FULL_REACH * reach) ** 2 - apart**2, 0.01))
        most[:, side] = hip + 0.05
    # the least of a few frames, smoothed over as many, stays below what the legs reach
    least = minimum_filter1d(most.min(axis=1), 2 * round(0.05 * per_s) + 1, mode="nearest")
    height = _smooth(least[:, None], 0.04 * per_s)[:, 0]
    return np.column_stack([level, height - 0.85 * (plan.body.leg - 1)])


def _smooth(values: np.ndarray, sigma: float) -> np.ndarray:
    """(T, C) through a Gaussian of ``sigma`` frames; the ends go on as they are."""
    from scipy.ndimage import gaussian_filter1d

    return np.asarray(gaussian_filter1d(values, sigma, axis=0, mode="nearest"))


def _wander(n: int, k: int, sigma: float, rng: np.random.Generator) -> np.ndarray:
    """(n, k) slow standard normal noise."""
    pad = int(4 * sigma) + 1
    noise = _smooth(rng.standard_normal((n + 2 * pad, k)), sigma)[pad:-pad]
    return np.asarray(noise * np.sqrt(2 * np.sqrt(np.pi) * sigma))
