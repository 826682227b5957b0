"""A hidden Markov chain with Gaussian emissions that likes to stay where it is: states of motion found without labels.

Source: Rabiner (1989), expectation-maximisation and Viterbi; staying is favoured by a Dirichlet prior on the rows of
transitions (the sticky part), worth ``PRIOR`` transitions a state.

Which foot bears, and what state a cycle is in: found from the motion itself, without labels.

Feet: slow or fast is decided by the threshold that parts the feet's log speeds best (Otsu 1979), so no speed has to be
given; short flickers are smoothed away. Other cyclic work: a hidden Markov chain over the velocity in the latent space
(``chain.py``), which Remillard & Kry (2010) name as future work.

Feet on the floor: how far they slide, and the way of the root if those that bear stay where they are.

A bearing foot may roll: over the ankle while it lands and stands, over the toe while it pushes off. It slides as far as
the one of the two that moves less. Source of the wish: Remillard & Kry (2010), fig. 2 (foot skate).

Legs put on given ankles: two rigid bones from hip to ankle, the knee to the side where it was.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from emulator.motion import stretches
from emulator.recordings.take import Take
from emulator.skeleton import Skeleton, standard_skeleton

ROUNDS = 100
PRIOR = 20.0
SETTLED = 1e-5
"""Gain of log likelihood a frame below which the search ends."""


@dataclass(frozen=True, eq=False)
class Chain:
    """``mean`` (S, f), ``covariance`` (S, f, f), ``start`` (S,), ``move`` (S, S) and the log likelihood reached."""

    mean: np.ndarray
    covariance: np.ndarray
    start: np.ndarray
    move: np.ndarray
    log_likelihood: float

    @classmethod
    def fit(cls, sequences: Sequence[np.ndarray], first: Sequence[np.ndarray], dwell_frames: float) -> Chain:
        """By expectation-maximisation from a first guess of each frame's state.

        sequences    : features (T, f) each;  first : states (T,) from 0
        dwell_frames : how long a state is thought to last before the data are asked
        Raises ValueError where a state of the guess has no frames.
        """
        n_states = int(max(one.max() for one in first)) + 1
        x, state = np.concatenate(list(sequences)), np.concatenate(list(first))
        if len(np.unique(state)) < n_states or n_states < 2:
            raise ValueError(f"found {len(np.unique(state))} states in the first guess, expected {max(n_states, 2)}")
        stay = 1 - 1 / dwell_frames
        expected = np.where(np.eye(n_states, dtype=bool), stay, (1 - stay) / (n_states - 1))
        share = np.eye(n_states)[state]
        chain = cls(*_moments(x, share, x), np.full(n_states, 1 / n_states), expected, -np.inf)
        for _ in range(ROUNDS):
            better = chain._round(sequences, PRIOR * expected)
            settled = better.log_likelihood - chain.log_likelihood < SETTLED * len(x)
            chain = better
            if settled:
                break
        return chain

    def _round(self, sequences: Sequence[np.ndarray], prior: np.ndarray) -> Chain:
        from emulator.kernels.switching import smoothed

        pairs, shares, total = prior.copy(), [], 0.0
        for x in sequences:
            share = np.empty((len(x), len(self.mean)))
            total += smoothed(self.log_emission(x), self.start, self.move, share, pairs)
            shares.append(share)
        start = np.mean([share[0] for share in shares], axis=0) + 1e-3
        x = np.concatenate(list(sequences))
        mean, covariance = _moments(x, np.concatenate(shares), x)
        return Chain(mean, covariance, start / start.sum(), pairs / pairs.sum(axis=1, keepdims=True), total)

    def log_emission(self, x: np.ndarray) -> np.ndarray:
        """(T, S) log densities of the features (T, f) in each state."""
        gap = x[:, None, :] - self.mean
        solved = np.linalg.solve(self.covariance, np.moveaxis(gap, 0, -1))
        square = np.einsum("tsf,sft->ts", gap, solved)
        _, volume = np.linalg.slogdet(self.covariance)
        return np.ascontiguousarray(-0.5 * (square + volume + x.shape[1] * np.log(2 * np.pi)))

    def path(self, x: np.ndarray) -> np.ndarray:
        """(T,) the likeliest sequence of states."""
        from emulator.kernels.switching import likeliest_path

        path = np.empty(len(x), dtype=np.int64)
        likeliest_path(self.log_emission(x), np.log(self.start), np.log(self.move), path)
        return path


def _moments(x: np.ndarray, share: np.ndarray, every: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means (S, f), covariances (S, f, f) under shares (T, S); a hundredth of the whole spread keeps them regular."""
    weight = share / share.sum(axis=0)
    mean = weight.T @ x
    gap = x[:, None, :] - mean
    covariance = np.einsum("ts,tsf,tsg->sfg", weight, gap, gap)
    return mean, covariance + 0.01 * np.diag(every.var(axis=0) + 1e-12)


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


SIDES = ("left", "right")


def foot_skate_m(
    positions_m: np.ndarray, contact: np.ndarray, skeleton: Skeleton | None = None, *, least_frames: int = 3
) -> np.ndarray:
    """Metres that each bearing foot slides on the floor, one number a stance.

    positions_m : (T, J, 3), contact : (T, 2) left and right foot bear; stances shorter than ``least_frames`` are left
    out. From frame to frame the slide is the lesser of the ankle's and the toe's, so that a foot may roll.
    Returns (S,), left stances first; its mean is the foot skate a step. Raises ValueError for a skeleton without feet.
    """
    skeleton = skeleton or standard_skeleton()
    slid = []
    for side, bears in zip(SIDES, np.asarray(contact, bool).T):
        joints = positions_m[:, [skeleton.index(f"{side}_ankle"), skeleton.index(f"{side}_toe")], :2]
        step = np.linalg.norm(np.diff(joints, axis=0), axis=-1).min(axis=1)
        slid += [
            float(step[start : stop - 1].sum()) for start, stop in stretches(bears) if stop - start >= least_frames
        ]
    return np.array(slid)


def shares(contact: np.ndarray) -> np.ndarray:
    """(T, 2) how much each foot carries: 0 in the air, in double support from the old one to the new one evenly.

    Where both bear from the start or to the end each carries half; with no foot on the floor the last shares go on.
    """
    from emulator.kernels.bodies import shared

    share = np.empty(np.shape(contact))
    shared(np.asarray(contact, bool), share)
    return share


def path_from_contacts(hanging_m: np.ndarray, contact: np.ndarray, skeleton: Skeleton | None = None) -> np.ndarray:
    """The level way (T, 2) of the root of joints (T, J, 3), root at 0, if bearing feet stay; from x = y = 0.

    In double support both feet have their say by how much they carry.
    """
    from emulator.kernels.bodies import ridden

    skeleton = skeleton or standard_skeleton()
    feet = np.array([[skeleton.index(f"{side}_{joint}") for joint in ("ankle", "toe")] for side in SIDES])
    way = np.empty((len(hanging_m), 2))
    ridden(np.ascontiguousarray(hanging_m, dtype=float), np.asarray(contact, bool), feet, way)
    return way


_LEG = ("hip", "knee", "ankle", "toe")


@dataclass(frozen=True)
class Legs:
    """Joint numbers of both legs, hip to toe, and the joints that hang on an ankle or a toe, of one skeleton."""

    joints: tuple[tuple[int, ...], tuple[int, ...]]
    below: tuple[tuple[tuple[int, int], ...], tuple[tuple[int, int], ...]]
    """Of each leg (joint, parent) of what hangs on its ankle or toe besides."""

    @cached_property
    def tables(self) -> tuple[np.ndarray, np.ndarray]:
        """``joints`` (2, 4) and ``below`` (2, K, 2) as the kernels take them, filled up with -1."""
        below = np.full((2, max(len(side) for side in self.below) + 1, 2), -1, dtype=np.int64)
        for rows, side in zip(below, self.below):
            rows[: len(side)] = np.array(side, dtype=np.int64).reshape(-1, 2)
        return np.array(self.joints, dtype=np.int64), below

    def chain(self, skeleton: Skeleton) -> np.ndarray:
        """(b, 3) those rows of the skeleton's chain that the legs hang on."""
        needed = {joint for leg in self.joints for toe in leg for joint in (toe, *_up(skeleton, toe))}
        return np.ascontiguousarray(skeleton.chain[[int(child) in needed for child in skeleton.chain[:, 2]]])

    @classmethod
    def of(cls, skeleton: Skeleton) -> Legs | None:
        """None for a skeleton without two legs whose knee hangs on the hip and whose ankle on the knee."""
        if not {f"{side}_{joint}" for side in ("left", "right") for joint in _LEG} <= set(skeleton.names):
            return None
        joints = tuple(tuple(skeleton.names.index(f"{side}_{joint}") for joint in _LEG) for side in ("left", "right"))
        for hip, knee, ankle, toe in joints:
            if skeleton.parents[knee] != hip or skeleton.parents[ankle] != knee or ankle not in _up(skeleton, toe):
                return None
        below = tuple(
            tuple((j, skeleton.parents[j]) for j in _outwards(skeleton) if leg[2] in _up(skeleton, j)) for leg in joints
        )
        return cls((joints[0], joints[1]), (below[0], below[1]))


def _up(skeleton: Skeleton, joint: int) -> list[int]:
    path, parent = [], skeleton.parents[joint]
    while parent >= 0:
        path.append(parent)
        parent = skeleton.parents[parent]
    return path


def _outwards(skeleton: Skeleton) -> list[int]:
    return sorted(range(skeleton.n_joints), key=lambda joint: len(_up(skeleton, joint)))


def wanting_m(joints_m: np.ndarray, ankles_m: np.ndarray, legs: Legs, bone_m: Mapping[int, float]) -> np.ndarray:
    """(T,) how much the hips must come down so that no leg of joints (T, J, 3) stretches to its ankle (T, 2, 3).

    Below 0 there is room to spare.
    """
    from emulator.kernels.bodies import wanting_all

    room = np.empty(len(joints_m))
    wanting_all(joints_m, ankles_m, legs.tables[0], _by_joint(bone_m, joints_m), room)
    return room


def stand_on(
    joints_m: np.ndarray, ankles_m: np.ndarray, feet: np.ndarray, legs: Legs, bone_m: Mapping[int, float]
) -> np.ndarray:
    """Joints (T, J, 3) with the ankles at ankles_m (T, 2, 3), feet along unit vectors (T, 2, 3), knees on their side.

    bone_m : length of the bone that ends in a joint. An ankle out of reach is approached to ``limbs.REACH`` of the leg.
    """
    from emulator.kernels import bodies as limbs

    out = np.empty(joints_m.shape)
    limbs.stand_on(joints_m, ankles_m, feet, *legs.tables, _by_joint(bone_m, joints_m), out)
    return out


def _by_joint(bone_m: Mapping[int, float], joints_m: np.ndarray) -> np.ndarray:
    """(J,) length of the bone that ends in a joint, 0 for the root."""
    return np.array([bone_m.get(joint, 0.0) for joint in range(joints_m.shape[1])])
