"""What the bodies of the recorded people tell of how they move, and what a body leaves open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.covariates.body import Body
from emulator.covariates.model import CovariateModel, level_shares, logged


@dataclass(frozen=True, eq=False)
class Told:
    """model : of people's mean joint coordinates by their bodies, its r2 (K,) with the choice of scores left out, too

    fitted : (W, K) what it says of the recorded people: shifts of their means from the mean of all
    """

    model: CovariateModel
    fitted: np.ndarray

    @property
    def left(self) -> np.ndarray:
        """(K,) share of the between-worker standard deviation that a fully known body leaves."""
        return np.asarray(np.sqrt(1.0 - np.clip(self.model.r2, 0.0, 1.0)))

    def hears(self, body: Body) -> bool:
        """Whether anything is known of a body that tells something."""
        known = set(body.known) | ({self.model.category} if body.sex in self.model.levels else set())
        return bool(known & set(self.model.telling))

    def unsure_rows(self, body: Body) -> np.ndarray:
        """(V, K) rows whose product is the covariance that the unknown covariates of a body leave in its shift."""
        known = body.known
        asked = np.array([[known.get(name, np.nan) for name in self.model.names]])
        sex = body.sex if body.sex in self.model.levels else None
        values = np.concatenate([logged(self.model.names, asked), level_shares([sex], self.model.levels)], axis=1)[0]
        size, axes = np.linalg.eigh(self.model.gaussian.unsure(np.isnan(values)))
        effect = self.model.level_effect
        steps = np.concatenate([self.model.slope, effect[1:] - effect[:1]]) if len(effect) else self.model.slope
        return np.asarray(np.sqrt(np.maximum(size, 0.0))[:, None] * axes.T @ steps)
