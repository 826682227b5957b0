"""JointLaw: the joint law of one task's posture, way, pace, duration, marks, bones and pauses, and how it is decoded.

What is drawn from it and fitted to it is in the files above: ``performances``, ``conditioning``, ``emulator``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from emulator.fitting.report import FitReport
from emulator.geometry.flattening import Flattening
from emulator.geometry.warps import coordinates_to_clock, evaluate, from_clr, from_clr_at
from emulator.model.decoding import Decoder, RootChannel
from emulator.model.dwell_times import GRID, NONE, WEIGHTS, Dwells
from emulator.model.feet import Footing, Legs
from emulator.model.gaussian import Law
from emulator.model.joint_coordinates import JointScale, Margin, inverse_all
from emulator.model.reduction import JointPCA
from emulator.people.workers import WorkerEffect, Workforce
from emulator.skeleton import Skeleton

SLOPE_ROOM = np.log(1.2)
FASTER = 1.07
_N_HERMITE = 20
LEAST_NOISE = 0.01
"""Share of its mean variance that noise of postures is taken to have along each axis, where it is asked whose it is."""
AT_ONCE = 64
"""Components of a law whose moments are made at a time."""


@dataclass(frozen=True, eq=False)
class JointLaw:
    """A task's model: the steps from recordings to joint coordinates z, each with its way back, and the Gaussians of z.

    posture, root, pace, bones : JointPCA of flat postures (T * C), side channel (T * 4), pace (Q), log bones (B)
    margin, mark_margins : of log moving duration (the whole duration, if nothing pauses), of each mark's coordinate
    dwells : sites of pauses and the law of each dwell; whole duration = moving duration + dwells
    footing : when and how the recorded feet stood, or None
    rides : the root rides on the feet and its side channel is what they do not explain, as in libraries of before
    """

    task: str
    skeleton: Skeleton
    mark_names: tuple[str, ...]
    n_times: int
    flatten: Flattening
    posture: JointPCA
    root: JointPCA
    pace: JointPCA
    bones: JointPCA
    margin: Margin
    mark_margins: tuple[Margin, ...]
    scale: JointScale
    workforce: Workforce
    report: FitReport
    dwells: Dwells = NONE
    footing: Footing | None = None
    rides: bool = False

    def law(self, effect: WorkerEffect | None) -> Law:
        """The law of z of the worker with this effect, or (None) of a new worker each time."""
        return self.workforce.law(effect)

    def moving_s(self, scores: np.ndarray) -> np.ndarray:
        """(n,) seconds of movement: the duration without its pauses."""
        return np.asarray(np.exp(self.margin.inverse(self.scale.raw(scores, "duration")[:, 0])))

    def dwell_s(self, scores: np.ndarray) -> np.ndarray:
        """(n, S) seconds of pause at each site of ``dwells``; 0 where a performance does not pause."""
        return self.dwells.seconds(self.scale.raw(scores, "dwells"))

    def whole_s(self, scores: np.ndarray) -> np.ndarray:
        """(n,) seconds, pauses included."""
        moving_s = self.moving_s(scores)
        return moving_s if len(self.dwells) == 0 else np.asarray(moving_s + self.dwell_s(scores).sum(axis=-1))

    def moving_share(self, scores: np.ndarray, own_share: np.ndarray) -> np.ndarray:
        """(n, T) share of the moving time at shares (n, T) of the whole time: it stands still while a pause lasts."""
        if len(self.dwells) == 0:
            return own_share
        moving_s, dwell_s = self.moving_s(scores)[:, None], self.dwell_s(scores)
        time_s = np.array(own_share * (moving_s + dwell_s.sum(axis=-1, keepdims=True)))
        start_s = moving_s * evaluate(self.warps(scores), self.dwells.clock)
        for j in range(dwell_s.shape[1]):  # each pause is taken out of the time that is left: later ones start earlier
            time_s -= np.clip(time_s - start_s[:, j : j + 1], 0.0, dwell_s[:, j : j + 1])
        return np.asarray(time_s / moving_s)

    def mark_share(self, scores: np.ndarray) -> np.ndarray:
        """(n, E) the share of its own duration at which each mark of a performance falls."""
        clock = coordinates_to_clock(inverse_all(self.mark_margins, self.scale.raw(scores, "marks")))
        share = from_clr_at(self._slopes(scores), clock)
        if len(self.dwells) == 0:
            return share
        moving_s, dwell_s = self.moving_s(scores)[:, None], self.dwell_s(scores)
        at_s = moving_s * share + dwell_s @ self.dwells.mark_share.T
        return np.asarray(at_s / (moving_s + dwell_s.sum(axis=-1, keepdims=True)))

    def warps(self, scores: np.ndarray) -> np.ndarray:
        """Own unit time on the common clock, (n, T), strictly increasing from 0 to 1."""
        return from_clr(self._slopes(scores), self.n_times)

    def _slopes(self, scores: np.ndarray) -> np.ndarray:
        """(n, Q) log ratios of the warps' slopes, within ``slope_limits``."""
        return np.minimum(
            np.maximum(self.pace.inverse(self.scale.raw(scores, "pace")), self.slope_limits[0]), self.slope_limits[1]
        )

    @cached_property
    def whitening(self) -> np.ndarray | None:
        """(P, P) to coefficients of posture in which noise moves a draw as far in all directions; None without noise.

        There a draw is nearest to the recording that it took its fine detail from (Mahalanobis 1936). As they are, most
        are nearest to recordings in the middle, since noise takes the place of much of a deviation.
        """
        smoothed = self.workforce.smoothed
        if smoothed is None:
            return None
        block = self.scale.block("posture")
        rows = smoothed.factor[:, block] * self.scale.spread[block]
        variance = rows.T @ rows
        least = LEAST_NOISE * np.trace(variance) / max(len(variance), 1)
        if not least > 0.0:
            return None
        return np.asarray(np.linalg.cholesky(np.linalg.inv(variance + least * np.eye(len(variance)))))

    @cached_property
    def slope_limits(self) -> np.ndarray:
        """(2, Q) least and largest log ratio of each knot: those of the recordings and a fifth beyond, if it has them.

        Else a few draws of new people would rush through a part of the task three times as fast as anybody did.
        """
        smoothed = self.workforce.smoothed
        if smoothed is None:
            return np.array([[-8.0], [8.0]])
        recorded = self.pace.inverse(self.scale.raw(smoothed.scores, "pace"))
        return np.stack([recorded.min(axis=0) - SLOPE_ROOM, recorded.max(axis=0) + SLOPE_ROOM])

    def aligned_directions(self, scores: np.ndarray) -> np.ndarray:
        """Postures on the common clock, (n, T, B, 3)."""
        flat = self.posture.inverse(self.scale.raw(scores, "posture"))
        return self.flatten.inverse(flat.reshape(len(scores), self.n_times, -1))

    def root_channel(self, scores: np.ndarray) -> np.ndarray:
        """Side channel of the root on the common clock, (n, T, 4)."""
        return self.root.inverse(self.scale.raw(scores, "root")).reshape(len(scores), self.n_times, 4)

    def bone_length_m(self, scores: np.ndarray) -> np.ndarray:
        """(n, B) metres."""
        return np.exp(self.bones.inverse(self.scale.raw(scores, "bones")))

    @cached_property
    def middle(self) -> np.ndarray:
        """(K,) z of the mean movement, towards which a draw is drawn in where a joint is too fast."""
        return np.zeros(len(self.scale.centre))

    @cached_property
    def middle_control(self) -> np.ndarray:
        """(T + 2, C) control points of the mean movement's flat postures."""
        return self.decoder.control(self.scale.raw(self.middle, "posture")[None])[0]

    @property
    def channel(self) -> RootChannel:
        return RootChannel(self.skeleton, self.rides)

    @cached_property
    def decoder(self) -> Decoder:
        """What makes postures of coefficients."""
        return Decoder(self.posture, self.flatten)

    @cached_property
    def most_m_per_s(self) -> float:
        """The greatest speed that a joint of a drawn body may have: 7 % beyond the fastest recorded one.

        So that between the moments at which it is known it stays within a tenth. A draw beyond it is drawn in, see
        ``MotionPerformances.damped``; without a bound in libraries of before.
        """
        fastest = self.report.fastest_m_per_s
        return float("inf") if self.footing is None or not fastest > 0 else FASTER * fastest

    @cached_property
    def legs(self) -> Legs | None:
        """What of the body stands; None without ankles and toes."""
        return Legs.of(self.skeleton)

    def covariance_with(self, at: int, effect: WorkerEffect | None) -> np.ndarray:
        """(K,) covariance of z with its coordinate ``at``: of one worker, or over the population."""
        column = self.workforce.within.covariance_with(at)
        return column if effect is not None else column + self.workforce.between.covariance_with(at)

    def duration_z(self, log_duration: np.ndarray) -> np.ndarray:
        """The coordinate of z at which the log duration is this."""
        at = self.scale.block("duration").start
        return np.asarray((self.margin.forward(log_duration) - self.scale.centre[at]) / self.scale.spread[at])

    def moments_s(self, effect: WorkerEffect | None) -> tuple[float, float]:
        """Mean and standard deviation of the whole time, of one worker or (None) over the population."""
        return self._population_s if effect is None else self._whole_moments_s(effect)

    @cached_property
    def _population_s(self) -> tuple[float, float]:
        """``moments_s`` of the population: thousands of components, and asked for at every station."""
        return self._whole_moments_s(None)

    def _whole_moments_s(self, effect: WorkerEffect | None) -> tuple[float, float]:
        return self._moments_s(effect) if len(self.dwells) == 0 else self._paused_moments_s(effect)

    def coordinates_of_times(self) -> np.ndarray:
        """Where duration and dwells lie in z: (1 + S,)."""
        return np.r_[self.scale.block("duration"), self.scale.block("dwells")]

    def _moments_s(self, effect: WorkerEffect | None) -> tuple[float, float]:
        """Mean and standard deviation of the duration, over the components of its law."""
        block, law = self.scale.block("duration"), self.law(effect)
        mean, covariance = law.coordinates(np.array([block.start]))
        raw = self.scale.centre[block] + self.scale.spread[block] * mean
        spread = self.scale.spread[block] * np.sqrt(covariance[:, 0])
        first, second = self.margin.moments_s(raw[:, 0], spread[:, 0])
        mean_s = float(law.weight @ first)
        return mean_s, float(np.sqrt(max(law.weight @ second - mean_s**2, 0.0)))

    def _paused_moments_s(self, effect: WorkerEffect | None) -> tuple[float, float]:
        law, at = self.law(effect), self.coordinates_of_times()
        mean, covariance = law.coordinates(at)
        scale = self.scale.spread[at]
        mean, covariance = self.scale.centre[at] + scale * mean, covariance * np.outer(scale, scale)
        blocks = [slice(start, start + AT_ONCE) for start in range(0, len(mean), AT_ONCE)]
        means, variances = np.concatenate([self._components_s(mean[rows], covariance[rows]) for rows in blocks], axis=1)
        mean_s = law.weight @ means
        return float(mean_s), float(np.sqrt(law.weight @ (variances + (means - mean_s) ** 2)))

    def _components_s(self, mean: np.ndarray, covariance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Means and variances (M,) of the whole time where the raw coordinates (M, 1 + S) are normal.

        Products of different terms by Mehler's series in Hermite polynomials of normal X, Y with correlation rho:
        Cov(f(X), g(Y)) = sum over k >= 1 of rho^k f_k g_k.
        """
        spread = np.sqrt(np.maximum(np.diagonal(covariance, axis1=1, axis2=2), 1e-300))
        raw = mean[..., None] + spread[..., None] * GRID
        moving_s = np.exp(self.margin.inverse(raw[:, 0]))
        terms = np.concatenate(
            [moving_s[:, None], np.moveaxis(self.dwells.seconds(np.moveaxis(raw[:, 1:], 1, -1)), -1, 1)], axis=1
        )
        coefficients = (terms * WEIGHTS) @ _hermite().T
        correlation = np.clip(covariance / (spread[:, :, None] * spread[:, None]), -1.0, 1.0)
        power, product = np.ones_like(correlation), np.zeros_like(correlation)
        for k in range(1, _N_HERMITE):
            power = power * correlation
            product += power * coefficients[:, :, None, k] * coefficients[:, None, :, k]
        own = np.arange(terms.shape[1])
        product[:, own, own] = terms**2 @ WEIGHTS - coefficients[..., 0] ** 2
        return coefficients[..., 0].sum(axis=1), np.maximum(product.sum(axis=(1, 2)), 0.0)


@lru_cache(maxsize=1)
def _hermite() -> np.ndarray:
    """(K, G) Hermite polynomials on the grid, orthonormal under the standard normal."""
    rows = [np.ones_like(GRID), GRID]
    for k in range(1, _N_HERMITE - 1):
        rows.append((GRID * rows[k] - np.sqrt(k) * rows[k - 1]) / np.sqrt(k + 1.0))
    return np.stack(rows)
