"""The law of people who were never recorded: near somebody recorded in fine detail, uncertain in what is large.

A Gaussian over people in all coordinates gives new people movements that nobody's body makes: fine details of several
people added up, some of them with a minus. And with few people the spread between them is known badly: the next person
of I lies within intervals of a t with I - 1 degrees of freedom, not of a normal. So a new person deviates from the mean
like one recorded person, drawn in, and beside that by smooth noise between people (a smoothed bootstrap of people:
Silverman & Young 1987). What is large of the deviation, and the noise, have the size of the t: a normal over the root
of a chi-square, in equal steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from emulator.model.smoothed import Bands
from emulator.people.bone_turns import NO_TURNS, BoneTurns
from emulator.people.kinds import Kinds

N_SIZES, LARGEST_SIZE = 8, 3.0
BODY_SHARE = 0.1
"""Share of noise in bones: bodies are known to differ little, and a t of three would make people of three metres."""


@dataclass(frozen=True, eq=False)
class Population:
    """What a new person's mean is made of: mean + drawn_in * deviation of one of W people, sized, + size * xi @ rows.

    rows     : (W, K) noise between people, xi (W,) standard normal
    drawn_in : (K,) at most 1, what leaves room for the noise
    fine     : (W, K) what is added of each person: fine detail takes no noise, and is not drawn in
    curves   : (K,) coordinates that say curves over time: only the smooth part of a deviation is of the size, since
               nobody's fine detail is to be made larger
    bones    : (K,) coordinates whose deviations are of size 1
    kinds    : whose means people deviate from
    turns    : by how much bones point another way throughout
    """

    rows: np.ndarray
    drawn_in: np.ndarray
    fine: np.ndarray
    curves: np.ndarray
    bones: np.ndarray
    kinds: Kinds
    turns: BoneTurns = NO_TURNS

    @classmethod
    def fit(
        cls,
        between: np.ndarray,
        curves: Sequence[tuple[slice, Bands]],
        bones: slice,
        kinds: Kinds,
        turns: BoneTurns = NO_TURNS,
    ) -> Population:
        """From rows (W, K) whose product is the covariance between people of one kind.

        curves : where these blocks lie, and how they are smoothed; bones : where this block lies
        """
        share = noise_share(kinds.n_free)
        rows, fine = np.sqrt(share) * between, np.zeros_like(between)
        at_curves, at_bones = np.zeros((2, between.shape[1]), bool)
        drawn_in = np.full(between.shape[1], np.sqrt(1.0 - share))
        for at, bands in curves:
            at_curves[at] = True
            rows[:, at] = bands.times(rows[:, at], bands.passes)
            whole = np.sqrt(1.0 - share * bands.passes**2)
            fine[:, at] = bands.times(between[:, at], whole - np.sqrt(1.0 - share))
        at_bones[bones], drawn_in[bones] = True, np.sqrt(1.0 - BODY_SHARE)
        rows[:, bones] = np.sqrt(BODY_SHARE) * between[:, bones]
        return cls(rows, drawn_in, fine, at_curves, at_bones, kinds, turns)

    @property
    def sizes(self) -> np.ndarray:
        """(A,) equally likely sizes."""
        return predictive_sizes(self.kinds.n_free)

    def deviations(self, own: np.ndarray, left: np.ndarray | float = 1.0) -> np.ndarray:
        """(A, W, K) deviations of people like each of the recorded ones from the mean of their kind, at each size.

        own  : (W, K) those of the recorded ones
        left : (K,) what a known body leaves of spreads
        """
        n = self.kinds.n_not_alone
        smooth = self.rows * left * np.sqrt(n / noise_share(self.kinds.n_free))
        sized = np.where(self.curves, smooth, np.where(self.bones, 0.0, own))
        fine = self.fine * left * np.sqrt(n)
        return np.asarray((own + (self.sizes[:, None, None] - 1.0) * sized) * self.drawn_in + fine)


def noise_share(n_people: int) -> float:
    """Share of the variance between people that is noise: the rule of Silverman (1986, eq. 3.28)."""
    square = (4.0 / (3.0 * n_people)) ** 0.4
    return square / (1.0 + square)


@lru_cache(maxsize=16)
def predictive_sizes(n_people: int) -> np.ndarray:
    """(A,) standard deviations of a new person over that between the recorded ones, equally likely.

    sqrt(1 + 1 / W) for the mean that is not known, and sqrt(v / chi-square_v), v = W - 1, for the spread that is not
    (Geisser 1993, sec. 2), at the middles of ``N_SIZES`` equal shares, at most ``LARGEST_SIZE``.
    """
    from scipy.special import chdtri

    free = n_people - 1
    share = (np.arange(N_SIZES) + 0.5) / N_SIZES
    return np.minimum(np.sqrt((1.0 + 1.0 / n_people) * free / chdtri(free, 1.0 - share)), LARGEST_SIZE)[::-1]
