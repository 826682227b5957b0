"""How far apart sums have to be before anything is decided: the triangles of a fully sequential procedure."""

from __future__ import annotations

import numpy as np

from opsim.study.select.constants import kn_eta
from opsim.study.select.race import ROUNDING
from opsim.study.select.selection import Asked

UNMOVED = 59
"""Replications before no spread at all is believed: what happens in 5 % of replications shows in so many of them but
with a chance of 0.95^59 < 0.05."""


class Rooms:
    """Where the triangles begin, by the spread of the first stage; a wider one closes later.

    A difference (or the figure of a limit) that is the same in the whole first stage says nothing of its spread: it may
    be a stop that is rare. Nothing is decided of it before ``look_again_at`` replications, which are its first stage.
    pairs : (k, k), limits : (k, L), of sums at replication 0; inf where nothing is decided yet
    """

    def __init__(self, asked: Asked, error: float, starts: np.ndarray):
        """starts : (k, n0, 1 + L) of the first stage, limits as by how much they are exceeded; error : of a decision"""
        self._asked, self._error = asked, error
        self._tolerances = np.array([limit.tolerance for limit in asked.limits])
        self.look_again_at = min(max(asked.first_stage, UNMOVED), asked.most)
        self.pairs, self.limits = self._begun(starts)
        if asked.first_stage < self.look_again_at:
            self.pairs[self.pairs == 0.0] = np.inf
            self.limits[self.limits == 0.0] = np.inf

    def look_again(self, alive: np.ndarray, values: np.ndarray) -> None:
        """values : (alive, look_again_at, 1 + L) as ``starts``"""
        pairs, limits = self._begun(values)
        grid = np.ix_(alive, alive)
        self.pairs[grid] = np.where(np.isinf(self.pairs[grid]), pairs, self.pairs[grid])
        self.limits[alive] = np.where(np.isinf(self.limits[alive]), limits, self.limits[alive])

    def at(self, r: int) -> tuple[np.ndarray, np.ndarray]:
        """(k, k) and (k, L): how much larger than 0 a sum has to be at the r-th replication."""
        return (
            np.maximum(0.0, self.pairs - 0.5 * self._asked.indifference * r),
            np.maximum(0.0, self.limits - 0.5 * self._tolerances * r),
        )

    def affordable(self, pairs: np.ndarray) -> float:
        """The indifference at which these pairs' triangles close at the last replication allowed; nan of none.

        pairs : (k, k), whether it counts
        """
        if not pairs.any():
            return float("nan")
        return float(np.sqrt(2.0 * self._asked.indifference * self.pairs[pairs].max() / self._asked.most))

    def _begun(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Source: Kim & Nelson 2001, h^2 S^2 / (2 c d) with c = 1 and h^2 = 2 c eta (n0 - 1)."""
        freedom = values.shape[1] - 1
        scale = 2.0 * kn_eta(freedom, self._error) * freedom
        figures, over = values[..., 0], values[..., 1:]
        pairs = np.array([_variances(of - figures, np.abs(figures).max(initial=0.0)) for of in figures])
        bounds = np.array([abs(limit.bound) for limit in self._asked.limits])
        limits = _variances(over.swapaxes(1, 2), bounds[None] + np.abs(over).max(axis=1, initial=0.0))
        return scale * pairs / (2.0 * self._asked.indifference), scale * limits / (2.0 * self._tolerances)


def _variances(values: np.ndarray, size: float | np.ndarray) -> np.ndarray:
    """Along the last axis; 0 where they differ by no more than rounding of numbers of this size."""
    return np.where(np.ptp(values, axis=-1) <= ROUNDING * size, 0.0, values.var(axis=-1, ddof=1))
