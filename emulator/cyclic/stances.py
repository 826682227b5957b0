"""When and where each foot bears in one performance, at any moment: planted stances with swings between.

A planted foot does not twist. While it points up from the floor it turns about its ankle, once it points further down
than it stands about its toe; the point about which it turns does not move. Between two stances it flies as the posture
says, plus what is missing at both ends, eased. Where a leg is too short for a foot behind, the heel rises further;
where it is too short for a foot in flight, that comes nearer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

EASY, SPARE = 0.975, 0.018
"""Share of a leg's length up to which it stretches freely; what is asked beyond is drawn in to EASY + SPARE at most."""
BEHIND = 0.25
"""Only a foot this share of a leg behind its hip raises its heel with full effect: who stands, stands flat."""
SOFT_M = 0.001
"""How softly a flying foot turns its toe away from the floor."""
LOWEST = -0.995
"""A foot stands on its toe at most this steeply (a sine)."""


@dataclass(frozen=True, eq=False)
class FootStances:
    """The S stances of one foot, in order. Times in seconds, places in metres, angles in radians.

    on_s, rise_s, off_s : (S,) the foot comes down, its heel rises for good, it leaves the floor
    ankle_m   : (S, 3) where the ankle stands; way_rad : (S,) where the foot points to, seen from above
    flat      : height of the toe below the ankle of a standing foot, as a share of its length foot_m (a negative sine)
    toe_least_m : no toe is lower; leg_m : length of thigh and shank
    missing, missing_per_s : (S, 2, 5) planted ankle, angle and pitch of the foot less the posture's, coming and leaving
    """

    on_s: np.ndarray
    rise_s: np.ndarray
    off_s: np.ndarray
    ankle_m: np.ndarray
    way_rad: np.ndarray
    flat: float
    foot_m: float
    toe_least_m: float
    leg_m: float
    missing: np.ndarray
    missing_per_s: np.ndarray

    def bears(self, time_s: np.ndarray) -> np.ndarray:
        """(T,) whether the foot is planted."""
        at = self._at(time_s)
        return np.asarray((time_s >= self.on_s[at]) & (time_s <= self.off_s[at]))

    def ankle(
        self, time_s: np.ndarray, raw_m: np.ndarray, foot: np.ndarray, hip_m: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """(T, 3) ankles and feet, for postures with ankles raw_m, feet along ``foot`` and hips hip_m, each (T, 3)."""
        at, bears = self._at(time_s), self.bears(time_s)[:, None]
        pitch = np.where(time_s <= self.rise_s[at], np.maximum(foot[:, 2], self.flat), foot[:, 2])
        planted, standing = planted_foot(
            pitch, self.ankle_m[at], self.way_rad[at], self.flat, self.foot_m, hip_m, self.leg_m
        )
        missing = self._missing(time_s, at)
        flown = raw_m + missing[:, :3]
        near = within_reach(flown, hip_m, self.leg_m)
        over = self._flight(time_s, at)
        flown = flown + (_eased(over / 0.25) * _eased((1 - over) / 0.5))[:, None] * (near - flown)
        flying = pointing(_way(foot) + missing[:, 3], foot[:, 2] + missing[:, 4])
        soft_m = SOFT_M * (1 + 6 * np.clip(4 * over * (1 - over), 0.0, 1.0))
        flying = raised(flying, flown, self.toe_least_m, self.foot_m, soft_m)
        return np.where(bears, planted, flown), np.where(bears, standing, flying)

    def _at(self, time_s: np.ndarray) -> np.ndarray:
        """(T,) the stance that holds, or the last one before."""
        return np.clip(np.searchsorted(self.on_s, time_s, side="right") - 1, 0, len(self.on_s) - 1)

    def _flight(self, time_s: np.ndarray, at: np.ndarray) -> np.ndarray:
        """(T,) share of the flight after stance ``at`` that is over."""
        following = np.minimum(at + 1, len(self.on_s) - 1)
        return np.asarray((time_s - self.off_s[at]) / np.maximum(self.on_s[following] - self.off_s[at], 1e-6))

    def _missing(self, time_s: np.ndarray, at: np.ndarray) -> np.ndarray:
        """(T, 5) in flight: a cubic between what is missing at both ends, with its rates; held before and after all."""
        following = np.minimum(at + 1, len(self.on_s) - 1)
        fly_s = np.maximum(self.on_s[following] - self.off_s[at], 1e-6)
        u = np.clip((time_s - self.off_s[at]) / fly_s, 0.0, 1.0)[:, None]
        rest = (following == at)[:, None]
        start, end = self.missing[at, 1], np.where(rest, self.missing[at, 1], self.missing[following, 0])
        leave = np.where(rest, 0.0, self.missing_per_s[at, 1] * fly_s[:, None])
        arrive = np.where(rest, 0.0, self.missing_per_s[following, 0] * fly_s[:, None])
        return np.asarray(
            start * (1 + 2 * u) * (1 - u) ** 2
            + end * u**2 * (3 - 2 * u)
            + leave * u * (1 - u) ** 2
            - arrive * u**2 * (1 - u)
        )


def planted_foot(
    pitch: np.ndarray,
    ankle_m: np.ndarray,
    way_rad: np.ndarray,
    flat: float,
    foot_m: float,
    hip_m: np.ndarray,
    leg_m: float,
) -> tuple[np.ndarray, np.ndarray]:
    """(T, 3) ankle and direction of a bearing foot: pitch (T,) is the z of the posture's foot."""
    toe = ankle_m + foot_m * pointing(way_rad, np.full_like(pitch, flat))
    pitch = pitch.copy()
    ankle = toe - foot_m * pointing(way_rad, np.minimum(pitch, flat))
    behind = _eased(np.sum((hip_m - ankle)[:, :2] * pointing(way_rad, 0 * pitch)[:, :2], axis=-1) / (BEHIND * leg_m))
    short = np.flatnonzero((behind > 0) & (np.linalg.norm(ankle - hip_m, axis=-1) > EASY * leg_m))
    if len(short):
        now = np.minimum(pitch[short], flat)
        up = _heel_up(now, toe[short], way_rad[short], foot_m, hip_m[short], leg_m)
        pitch[short] += behind[short] * (up - pitch[short])
        pitch[short] = np.minimum(pitch[short], now)
        ankle[short] = toe[short] - foot_m * pointing(way_rad[short], pitch[short])
    return ankle, pointing(way_rad, pitch)


def _heel_up(
    pitch: np.ndarray, toe: np.ndarray, way_rad: np.ndarray, foot_m: float, hip_m: np.ndarray, leg_m: float
) -> np.ndarray:
    """(T,) lower pitches at which the leg is as long as ``drawn_in`` lets it be (law of cosines); LOWEST if none."""
    gap = toe - hip_m
    wanted = drawn_in(np.linalg.norm(gap - foot_m * pointing(way_rad, pitch), axis=-1), leg_m)
    ahead = gap[:, 0] * np.cos(way_rad) + gap[:, 1] * np.sin(way_rad)
    share = (np.sum(gap * gap, axis=-1) + foot_m**2 - wanted**2) / (2 * foot_m * np.hypot(ahead, gap[:, 2]))
    angle = np.arctan2(gap[:, 2], ahead) + np.arccos(np.clip(share, -1.0, 1.0))
    return np.minimum(np.sin(np.maximum(angle, np.arcsin(LOWEST))), pitch)


def drawn_in(apart_m: np.ndarray, leg_m: float) -> np.ndarray:
    """How far hip and ankle may be apart, where the posture says ``apart_m``: the same up to EASY of the leg."""
    beyond = np.maximum(apart_m / leg_m - EASY, 0.0)
    return np.asarray(np.where(beyond > 0, leg_m * (EASY - SPARE * np.expm1(-beyond / SPARE)), apart_m))


def within_reach(ankle_m: np.ndarray, hip_m: np.ndarray, leg_m: float) -> np.ndarray:
    """Ankles (T, 3), those too far from the hip drawn in along the line to it."""
    apart = ankle_m - hip_m
    distance = np.linalg.norm(apart, axis=-1)
    return np.asarray(hip_m + apart * (drawn_in(distance, leg_m) / np.maximum(distance, 1e-9))[:, None])


def pointing(way_rad: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Unit vectors (T, 3) to a side seen from above, of this z."""
    height = np.clip(height, -0.999, 0.999)
    level = np.sqrt(1.0 - height**2)
    return np.stack([level * np.cos(way_rad), level * np.sin(way_rad), height], axis=-1)


def stances(
    time_s: np.ndarray,
    runs: list[tuple[int, int]],
    raw_m: np.ndarray,
    foot: np.ndarray,
    place_m: np.ndarray,
    foot_m: float,
    toe_least_m: float,
    hip_m: np.ndarray,
    leg_m: float,
) -> FootStances:
    """The stances of one foot: runs (start, stop) of nodes at time_s (T,) in which it bears; hip_m (T, 3).

    raw_m (T, 3) ankles of the postures, foot (T, 3) unit vectors to the toe, place_m (S, 3) where the ankles stand
    """
    flat = float(np.clip((toe_least_m - place_m[0, 2]) / foot_m, -0.95, 0.95))
    raw = np.column_stack([raw_m, np.unwrap(_way(foot)), foot[:, 2]])
    missing, rates, ways, rise_s = [], [], [], []
    for (start, stop), place in zip(runs, place_m):
        rows = slice(start, stop)
        middle = slice(start + (stop - start) // 5, max(start + 3 * (stop - start) // 5, start + 1))
        way = float(np.mean(raw[middle, 3]))
        flat_at = np.flatnonzero(foot[rows, 2] >= flat)
        held = stop == len(time_s) or not len(flat_at)
        rise = stop if held else start + int(flat_at[-1])
        rise_s.append(np.inf if held else time_s[rise])
        pitch = np.where(np.arange(start, stop) <= rise, np.maximum(foot[rows, 2], flat), foot[rows, 2])
        ankle, standing = planted_foot(
            pitch, np.tile(place, (stop - start, 1)), np.full(stop - start, way), flat, foot_m, hip_m[rows], leg_m
        )
        gap = np.column_stack([ankle, np.full(stop - start, way), standing[:, 2]]) - raw[rows]
        rate = np.gradient(gap, time_s[rows], axis=0) if stop - start > 1 else np.zeros_like(gap)
        missing.append(gap[[0, -1]])
        rates.append(rate[[0, -1]])
        ways.append(way)
    on_s = np.array([time_s[start] for start, _ in runs])
    off_s = np.array([time_s[stop - 1] for _, stop in runs])
    if runs[0][0] == 0:
        on_s[0] = -np.inf
    if runs[-1][1] == len(time_s):
        off_s[-1] = np.inf
    way_rad, gaps = np.array(ways), np.stack(missing)
    return FootStances(
        on_s, np.array(rise_s), off_s, place_m, way_rad, flat, foot_m, toe_least_m, leg_m, gaps, np.stack(rates)
    )


def raised(foot: np.ndarray, ankle_m: np.ndarray, toe_least_m: float, foot_m: float, soft_m: np.ndarray) -> np.ndarray:
    """Unit vectors foot (T, 3), turned up as far as the toe must not be below ``toe_least_m``, within soft_m (T,)."""
    soft = soft_m / foot_m
    least = np.minimum((toe_least_m - ankle_m[:, 2]) / foot_m, 0.9)
    return pointing(_way(foot), foot[:, 2] + soft * np.logaddexp(0.0, (least - foot[:, 2]) / soft))


def _eased(u: np.ndarray) -> np.ndarray:
    """0 to 1 over u from 0 to 1, softly."""
    u = np.clip(u, 0.0, 1.0)
    return np.asarray(u * u * (3 - 2 * u))


def _way(foot: np.ndarray) -> np.ndarray:
    return np.arctan2(foot[..., 1], foot[..., 0])
