"""Dwell times: how long a performance pauses at each site of the common clock, as coordinates of the joint vector.

A site is a place of the common clock where repetitions hold. Its coordinate is a latent normal number: below a
threshold there is no pause (the share of repetitions without one), above it the dwell is lognormal, or by normal
scores where that is refused. The duration block then models the MOVING time, and a performance lasts its moving time
plus its dwells. Shares of the whole duration would tie the pause to the pace: with pauses of 1 s in 40 % of reaches
of 1.6 s they drew moving times of CV 0.20 where 0.16 is true; seconds drew 0.16.
Source: a tobit (Tobin 1958): a normal coordinate of which only the part above a threshold is seen.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.model.joint_coordinates import Margin

GRID = np.linspace(-8.5, 8.5, 2001)
WEIGHTS = np.exp(-0.5 * GRID**2) / np.exp(-0.5 * GRID**2).sum()
"""Standard normal numbers and their weights: means over a latent coordinate are sums over them."""


@dataclass(frozen=True)
class Dwells:
    """Sites of pauses and the law of each dwell; without sites nothing ever pauses.

    clock      : (S,) places on the common clock, increasing
    zero_share : (S,) share of repetitions that do not pause there
    margins    : S margins of log dwell, given that there is a pause
    mark_share : (E, S) share of the pause that has passed at a mark
    """

    clock: np.ndarray
    zero_share: np.ndarray
    margins: tuple[Margin, ...]
    mark_share: np.ndarray

    def __len__(self) -> int:
        return len(self.clock)

    def seconds(self, latent: np.ndarray) -> np.ndarray:
        """Dwells (n, S) of latent coordinates (n, S)."""
        columns = [self._column(j, latent[..., j]) for j in range(len(self))]
        return np.stack(columns, axis=-1) if columns else np.zeros((len(latent), 0))

    def mean_s(self, mean: np.ndarray, spread: np.ndarray) -> np.ndarray:
        """Mean dwells (S,) where the latent coordinates are normal with these means and standard deviations (S,)."""
        return np.array([self._column(j, mean[j] + spread[j] * GRID) @ WEIGHTS for j in range(len(self))])

    def _column(self, j: int, latent: np.ndarray) -> np.ndarray:
        from scipy.special import ndtr, ndtri

        tail = ndtr(-latent) / (1.0 - self.zero_share[j])  # from above: 1 - share of pauses that are shorter
        pauses = tail < 1.0
        given = -ndtri(np.where(pauses, np.maximum(tail, 1e-300), 0.5))
        return np.where(pauses, np.exp(self.margins[j].inverse(given)), 0.0)


NONE = Dwells(np.zeros(0), np.zeros(0), (), np.zeros((0, 0)))
