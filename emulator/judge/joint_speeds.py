"""Speed, acceleration and jerk of joints in real time, and how far two samples of movements are apart in them."""

from __future__ import annotations

import numpy as np

from emulator.judge.clips import Clips, resampled
from emulator.judge.sequence_distances import energy_v

RATE_HZ = 30.0
"""Frames a second at which speeds are taken: between them lies what a camera shows."""
ROOM = 1.1
"""A draw is too fast from here on, times the fastest recorded joint."""
STILL_M_PER_S = 1e-6
"""Nothing that moves: what rounding makes of a body that stands still is not too fast."""
N_PLACES = 31


def joint_rates(clips: Clips, order: int, rate_hz: float = RATE_HZ) -> list[np.ndarray]:
    """(T - order, J) lengths of the differences of this order over time, m/s^order, of each clip at ``rate_hz``."""
    places, step_s = clips.at_rate(rate_hz)
    return [np.linalg.norm(np.diff(p, n=order, axis=0), axis=-1) / s**order for p, s in zip(places, step_s)]


def peaks(clips: Clips, order: int, rate_hz: float = RATE_HZ) -> np.ndarray:
    """(n, J) greatest speed (order 1, m/s), acceleration (2, m/s^2) or jerk (3, m/s^3) of each joint in each clip."""
    return np.stack([rate.max(axis=0) for rate in joint_rates(clips, order, rate_hz)])


def share_too_fast(drawn: Clips, recorded: Clips, room: float = ROOM, rate_hz: float = RATE_HZ) -> float:
    """Share of draws in which any joint is faster than ``room`` times the fastest recorded one."""
    fastest = peaks(recorded, 1, rate_hz).max()
    return float(np.mean(peaks(drawn, 1, rate_hz).max(axis=1) > room * fastest + STILL_M_PER_S))


def share_too_fast_left_out(recorded: Clips, group: np.ndarray, room: float = ROOM, rate_hz: float = RATE_HZ) -> float:
    """The same of recordings, each beside those of other groups (n,): a number a recording, or a number a person."""
    top = peaks(recorded, 1, rate_hz).max(axis=1)
    others = [top[group != own].max(initial=0.0) for own in group]
    known = np.array([bool(np.any(group != own)) for own in group])
    return float(np.mean((top > room * np.array(others))[known])) if known.any() else float("nan")


def peak_ratio(drawn: Clips, recorded: Clips, order: int, rate_hz: float = RATE_HZ) -> float:
    """Median over joints of the median peak of a draw over that of a recording; joints that never move left out."""
    ours, theirs = (np.median(peaks(clips, order, rate_hz), axis=0) for clips in (drawn, recorded))
    return _ratio(ours, theirs)


def median_speed_ratio(drawn: Clips, recorded: Clips, rate_hz: float = RATE_HZ) -> float:
    """Median of the fastest joint's peak speed over draws, over that of recordings."""
    ours, theirs = (np.median(peaks(clips, 1, rate_hz).max(axis=1)) for clips in (drawn, recorded))
    return _ratio(ours[None], theirs[None])


def places_and_speeds(clips: Clips) -> tuple[np.ndarray, np.ndarray]:
    """Rows of places (n, 31 * J * 3) and of speeds (n, 30 * J) on 31 even points of each clip's own time.

    Places from the root's first, upright; rows divided so that their distance is the root mean square over joints and
    times, in m and m/s.
    """
    places, speeds = [], []
    for positions, seconds in zip(clips.positions_m, clips.duration_s):
        x = resampled(positions, N_PLACES)
        root = clips.skeleton.root
        x = x - x[:1, root : root + 1] * [1, 1, 0]
        speed = np.linalg.norm(np.diff(x, axis=0), axis=-1) * (N_PLACES - 1) / seconds
        places.append(x.ravel() / np.sqrt(x.size / 3))
        speeds.append(speed.ravel() / np.sqrt(speed.size))
    return np.array(places), np.array(speeds)


def energies(a: Clips, b: Clips) -> tuple[float, float]:
    """Energy distances (V-statistics) of places, mm, and of speeds, mm/s, between two samples of movements.

    Source: Rizzo & Szekely (2010); see ``emulator.judge.sequence_distances``.
    """
    from scipy.spatial.distance import cdist

    pairs = zip(places_and_speeds(a), places_and_speeds(b))
    places, speeds = (1000 * energy_v(cdist(x, y), cdist(x, x), cdist(y, y)) for x, y in pairs)
    return places, speeds


def _ratio(ours: np.ndarray, theirs: np.ndarray) -> float:
    moving = theirs > STILL_M_PER_S
    return float(np.median(ours[moving] / theirs[moving])) if moving.any() else float("nan")
