"""Which foot bears, and what state a cycle is in: found from the motion itself, without labels.

Feet: slow or fast is decided by the threshold that parts the feet's log speeds best (Otsu 1979), so no speed has to be
given; short flickers are smoothed away. Other cyclic work: a hidden Markov chain over the velocity in the latent space
(``chain.py``), which Remillard & Kry (2010) name as future work.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from emulator.cyclic.chain import Chain
from emulator.recordings.take import Take
from emulator.skeleton import Skeleton

SHORTEST_S = 0.06
"""Contacts and flights shorter than this are flicker."""
SLOWEST_M_PER_S = 0.05
"""Speeds below this are all the same: the noise of a foot that stands."""
STANDING_M_PER_S = 0.4
"""Where speeds do not fall into two kinds, a foot bears below this (as ``contact_feet`` of the public data says)."""
TWO_KINDS = 3.0
"""Fast feet must be this many times as fast as slow ones, or nobody is walking."""
DWELL_S = 0.3


def contact_of(
    positions_m: Take | np.ndarray, skeleton: Skeleton | None = None, rate_hz: float | None = None
) -> np.ndarray:
    """(T, 2) whether the left and the right foot bear, of a take or of joints (T, J, 3) with skeleton and rate.

    A foot is as slow as the slower of its ankle and toe, since it rolls. Raises ValueError where feet are missing.
    """
    if isinstance(positions_m, Take):
        take = positions_m
        skeleton, rate_hz, positions_m = Skeleton(take.names, take.parents or ()), take.rate_hz, take.positions_m
    if skeleton is None or rate_hz is None:
        raise ValueError("contact_of needs the skeleton and the rate of positions without a take")
    speed = np.stack([_foot_speed_m_per_s(positions_m, skeleton, rate_hz, side) for side in ("left", "right")], axis=1)
    bears = speed < contact_speed_m_per_s(speed)
    least = max(1, round(SHORTEST_S * rate_hz))
    return np.stack([without_flicker(foot, least) for foot in bears.T], axis=1)


def contact_speed_m_per_s(speed_m_per_s: np.ndarray) -> float:
    """The speed below which feet bear, from all their speeds: the best parting of the logarithms into two kinds."""
    logs = np.sort(np.log(np.asarray(speed_m_per_s, float).ravel() + SLOWEST_M_PER_S))
    number, total = np.arange(1, len(logs)), np.cumsum(logs)
    low, high = total[:-1] / number, (total[-1] - total[:-1]) / (len(logs) - number)
    at = int(np.argmax(number * (len(logs) - number) * (high - low) ** 2))
    if high[at] - low[at] < np.log(TWO_KINDS):
        return STANDING_M_PER_S
    return float(np.exp(0.5 * (logs[at] + logs[at + 1])) - SLOWEST_M_PER_S)


def without_flicker(bears: np.ndarray, least: int) -> np.ndarray:
    """(T,) with runs shorter than ``least`` frames given to what is around them; runs at the ends stay."""
    out = np.asarray(bears, bool).copy()
    edges = np.flatnonzero(np.diff(out)) + 1
    for start, stop in pairwise(edges):
        if stop - start < least:
            out[start:stop] = out[start - 1]
    return out


def state_of_contact(contact: np.ndarray) -> np.ndarray:
    """(..., 2) left and right -> (...) 0 none, 1 left, 2 right, 3 both."""
    contact = np.asarray(contact, bool)
    return np.asarray(contact[..., 0] + 2 * contact[..., 1], dtype=int)


def contact_of_state(state: np.ndarray) -> np.ndarray:
    """(...) 0 none, 1 left, 2 right, 3 both -> (..., 2) left and right."""
    return np.stack([np.asarray(state) & 1, np.asarray(state) & 2], axis=-1) > 0


def single_support(contact: np.ndarray) -> np.ndarray:
    """(T,) 1 left or 2 right: who bears; of two the one that came down last, of none the one that bore last."""
    state = state_of_contact(contact)
    alone = np.flatnonzero((state == 1) | (state == 2))
    if not len(alone):
        return np.ones(len(state), dtype=int)
    out = np.empty(len(state), dtype=int)
    last = int(state[alone[0]])
    for t, now in enumerate(state):
        if now in (1, 2):
            last = int(now)
        elif now == 3 and t and state[t - 1] in (1, 2):
            last = 3 - int(state[t - 1])
        out[t] = last
    return out


def found_states(
    sequences: Sequence[np.ndarray], n_states: int, rate_hz: float, *, dwell_s: float = DWELL_S
) -> list[np.ndarray]:
    """States (T,) from 0 of latents (T, d): which way and how fast, by a chain that likes to stay.

    State 0 is the slowest (a pause, if there is one), the others follow by mean speed.
    """
    velocity = [np.gradient(np.asarray(z, float), axis=0) * rate_hz for z in sequences]
    if n_states < 2:
        return [np.zeros(len(z), dtype=int) for z in sequences]
    typical = np.sqrt(np.mean(np.concatenate(velocity) ** 2)) + 1e-12
    features = [_way_and_speed(v / typical) for v in velocity]
    first = _first_guess(np.concatenate(features), n_states)
    cuts = np.cumsum([len(x) for x in features])[:-1]
    chain = Chain.fit(features, np.split(first, cuts), max(dwell_s * rate_hz, 2.0))
    order = np.argsort(chain.mean[:, -1])
    return [np.argsort(order)[chain.path(x)] for x in features]


def _way_and_speed(velocity: np.ndarray) -> np.ndarray:
    """(T, d + 1): velocity drawn in towards its direction, and log speed."""
    speed = np.linalg.norm(velocity, axis=1, keepdims=True)
    return np.hstack([velocity / np.sqrt(speed**2 + 0.3**2), np.log(speed + 0.05)])


def _first_guess(features: np.ndarray, n_states: int) -> np.ndarray:
    """(T,) by k-means from points far from each other, so that the same data give the same states."""
    from scipy.cluster.vq import kmeans2

    scaled = (features - features.mean(axis=0)) / (features.std(axis=0) + 1e-12)
    centres = [scaled[scaled[:, -1].argmin()]]
    while len(centres) < n_states:
        away = np.min([((scaled - centre) ** 2).sum(axis=1) for centre in centres], axis=0)
        centres.append(scaled[away.argmax()])
    return np.asarray(kmeans2(scaled, np.array(centres), minit="matrix", iter=30)[1])


def _foot_speed_m_per_s(positions_m: np.ndarray, skeleton: Skeleton, rate_hz: float, side: str) -> np.ndarray:
    joints = [skeleton.index(f"{side}_{joint}") for joint in ("ankle", "toe")]
    velocity = np.gradient(np.asarray(positions_m, float)[:, joints], axis=0) * rate_hz
    return np.asarray(np.linalg.norm(velocity, axis=-1).min(axis=1))
