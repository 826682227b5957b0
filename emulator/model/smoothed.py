"""The density beyond one Gaussian: recorded repetitions, each blurred by a little low-rank noise of the joint vector.

One Gaussian fills the gaps between kinds of execution with movements nobody made: its draws lie twice as far from the
nearest recording as unseen repetitions do. A smoothed bootstrap that keeps variances (Silverman & Young 1987) does not.
A known worker is drawn from his own repetitions, and with the weight of half a one (``BASE``) from what all others
do, about his shrunk mean: the predictive of a Dirichlet process (Ferguson 1973, sec. 5) with the crew as base measure.

How much to blur: so much that a draw is as far from the nearest recording as a repetition that was left out.

The distance to the nearest other repetition is what tells a copy from a movement of its own. It is known of every
recording by leaving it out, and the noise is made as large as it may be without going beyond it at any quartile.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from emulator.model.gaussian import Law, LowRankNormal, compressed
from emulator.model.joint_coordinates import within_worker

BASE = 0.5
"""Repetitions that a known worker's law takes from all others: of three recorded ones a seventh is theirs."""
FEWEST_OWN = 5


@dataclass(frozen=True, eq=False)
class SmoothedScores:
    """Recorded joint coordinates and the noise that blurs them.

    scores : (N, K); owner : (N,) number of the worker of each
    reach  : (N,) factor on the noise about each; smaller where repetitions lie close together
    factor : (R, K) noise is reach * xi @ factor, xi (R,) standard normal
    spread : (K,) within-worker standard deviations that draws are to have
    left   : (N, K) what is left of each one's deviation from its worker's mean beside the noise; of all but curves, of
             what curves do not tell
    tells  : (C, K - C) what the first C coordinates, curves, tell of all others: their regression within workers
    """

    scores: np.ndarray
    owner: np.ndarray
    reach: np.ndarray
    factor: np.ndarray
    spread: np.ndarray
    left: np.ndarray
    tells: np.ndarray

    @cached_property
    def noise(self) -> LowRankNormal:
        """The noise at reach 1."""
        return LowRankNormal(np.zeros(self.factor.shape[1]), self.factor, np.linalg.norm(self.factor, axis=0), 0.0)

    @cached_property
    def means(self) -> np.ndarray:
        """(W, K) mean of each worker's repetitions."""
        return np.stack([self.scores[self.owner == w].mean(axis=0) for w in range(self.owner.max() + 1)])

    @cached_property
    def deviations(self) -> np.ndarray:
        """(N, K) deviation of each recording from its worker's mean, drawn in; what its curves tell goes with them."""
        return with_told(self.left, self.tells)

    def anyone(self, mean: np.ndarray, like: int | None = None) -> Law:
        """The law of somebody never seen with this mean (K,): deviations like those of one worker, or of all."""
        weight, deviations, reach = self._components[-1 if like is None else like]
        return Law(weight, deviations, reach, self.noise, mean)

    @cached_property
    def _components(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Weights, means and reaches of those that somebody like each worker has; last, of somebody like nobody."""
        rows = [*map(self.rows_of, range(self.owner.max() + 1)), np.arange(len(self.owner))]
        return [(np.full(len(one), 1.0 / len(one)), self.deviations[one], self.reach[one]) for one in rows]

    def population(self, people: LowRankNormal, own: np.ndarray, sizes: np.ndarray) -> Law:
        """The law of one performance of a new person each time: who he is like, of which size, and what he does.

        people : noise between people, with their mean; own (A, W, K) how people like the recorded ones deviate, at
        ``sizes`` (A,)
        """
        parts = []
        n_workers, n_coordinates = own.shape[1:]
        for worker in range(n_workers):
            rows = self.rows_of(worker)
            mean = own[:, worker, None] + self.deviations[rows]
            reach = np.broadcast_to(self.reach[rows], mean.shape[:2])
            size = np.broadcast_to(sizes[:, None], mean.shape[:2])
            weight = np.full(mean.shape[:2], 1.0 / (n_workers * reach.size))
            parts.append((weight.ravel(), mean.reshape(-1, n_coordinates), reach.ravel(), size.ravel()))
        weight, mean, reach, size = (np.concatenate(part) for part in zip(*parts))
        return Law(weight, mean, reach, self.noise, people.mean, people, size)

    def rows_of(self, worker: int) -> np.ndarray:
        """The components that somebody like this worker has: that worker's own, and others' where there are few."""
        own = np.flatnonzero(self.owner == worker)
        if len(own) >= FEWEST_OWN:
            return own
        others = np.flatnonzero(self.owner != worker)
        step = max(1, len(others) // (FEWEST_OWN - len(own)))
        return np.concatenate([own, others[worker % step :: step][: FEWEST_OWN - len(own)]])

    def known(self, number: int, shrunk_mean: np.ndarray) -> Law:
        """The law of a worker seen in training: his own repetitions, and a little of what others do."""
        own, n = self.owner == number, len(self.owner)
        base = BASE / (np.sum(own) + BASE)
        weight = np.append(np.full(own.sum(), (1.0 - base) / own.sum()), np.full(n, base / n))
        mean = np.concatenate([self.means[number] - shrunk_mean + self.deviations[own], self.deviations])
        return Law(weight, mean, np.append(self.reach[own], self.reach), self.noise, shrunk_mean)


def less_told(rows: np.ndarray, tells: np.ndarray) -> np.ndarray:
    """Rows (R, K) of which only that is left beside the first C coordinates which these do not tell."""
    n = len(tells)
    return np.concatenate([rows[:, :n], rows[:, n:] - rows[:, :n] @ tells], axis=1)


def with_told(rows: np.ndarray, tells: np.ndarray) -> np.ndarray:
    """The way back from ``less_told``."""
    n = len(tells)
    return np.concatenate([rows[:, :n], rows[:, n:] + rows[:, :n] @ tells], axis=1)


def room(left: np.ndarray, variance: np.ndarray) -> np.ndarray:
    """The factor, at most 1, by which deviations of this variance leave no more than ``left`` of it."""
    return np.sqrt(np.minimum(np.maximum(left, 0.0) / np.maximum(variance, 1e-18), 1.0))


QUARTILES = (0.25, 0.5, 0.75)
N_TRIED, N_HALVINGS, LARGEST, N_NEAREST, MOST_REACH = 400, 16, 40.0, 3, 2.0
MOST_NOISE = (0.7, 0.6, 0.5)
"""Shares of a posture's variance that noise may be, to choose from: beyond, hardly anything of recordings is left."""
MOST_NOISE_BESIDE = 0.3
"""And of the variance of paths and paces: with more, movements have speeds where nobody has recorded any."""
PENALTIES = np.geomspace(1e-4, 1e4, 33)
"""Tried penalties on what curves tell, in mean squared lengths of the curves' singular values."""


@dataclass(frozen=True, eq=False)
class Curves:
    """A block of coordinates that say curves over time: postures, root paths, paces.

    at : where its P coordinates lie in z; size : (P,) their raw standard deviations, largest first
    bend : (P, P) products of the second differences in time of its components
    """

    at: slice
    size: np.ndarray
    bend: np.ndarray


@dataclass(frozen=True, eq=False)
class Bands:
    """Deviations along one kind of curve, parted by how much they bend: what is slow in time, and fine detail.

    axes : (P, P) columns orthonormal in raw coordinates, from those that bend least; size : (P,) raw spreads
    passes : (P,) what a smoothing lets through of each, 1 of what hardly bends; share : (P,) of the variance in each
    """

    axes: np.ndarray
    size: np.ndarray
    passes: np.ndarray
    share: np.ndarray

    @classmethod
    def of(cls, rows: np.ndarray, curve: Curves, stiffness: float) -> Bands:
        """For rows (R, P), smoothed by (I + (lambda bend)^2)^-1 (after Silverman 1996, smoothed principal components).

        lambda is ``stiffness`` times the rows' median variance over their bending.
        """
        raw = rows * curve.size
        bending = np.sum((raw @ curve.bend) * raw, axis=1)
        weight = stiffness * np.median(np.sum(raw**2, axis=1) / np.where(bending > 0, bending, np.inf))
        bends, axes = np.linalg.eigh(curve.bend)
        square = np.sum((raw @ axes) ** 2, axis=0)
        return cls(axes, curve.size, 1.0 / (1.0 + (weight * bends) ** 2), square / max(square.sum(), 1e-300))

    def noise(self, h: float, most_noise: float) -> np.ndarray:
        """(P,) share of the variance in each band that is noise with bandwidth h, of all at most ``most_noise``."""

        def square(by: float) -> np.ndarray:
            return np.minimum((by * self.passes) ** 2, 1.0)

        most = _largest_not(lambda by: bool(self.share @ square(by) > most_noise))
        return square(min(h, most))

    def times(self, rows: np.ndarray, factor: np.ndarray) -> np.ndarray:
        """Rows (R, P) with each band times its factor (P,)."""
        return np.asarray(((rows * self.size) @ self.axes * factor) @ self.axes.T / self.size)


def smoothed(
    z: np.ndarray,
    owner: np.ndarray,
    spread: np.ndarray,
    posture: Curves,
    others: tuple[Curves, ...],
    gram: np.ndarray,
    stiffness: float,
    most_noise: float = MOST_NOISE[0],
) -> SmoothedScores:
    """The smoothed scores of z (N, K) with the bandwidth that distances to left-out repetitions ask for.

    spread  : (K,) within-worker standard deviations that draws are to have
    posture : decides the bandwidth; others : are blurred like it, as stiffly
    gram    : (N, N) products of the whole centred posture sequences, of which the raw scores are the leading part
    stiffness : how much smoother than the recordings the noise is
    most_noise : share of a posture's variance that noise may be
    """
    square = np.diag(gram)[:, None] + np.diag(gram)[None] - 2 * gram
    other = np.sqrt(np.maximum(square, 0.0)) + np.diag(np.full(len(z), np.inf))
    nearest = np.sort(other, axis=1)[:, : min(N_NEAREST, len(z) - 1)]
    curves, at, size = (posture, *others), posture.at, posture.size
    own = within_worker(z, owner)
    tells = told_by_curves(own, curves, _n_free(owner))
    bands = [Bands.of(own[:, curve.at], curve, stiffness) for curve in curves]
    noise = _noise(own, owner, curves, tells)
    sharp = SmoothedScores(z, owner, _reach(nearest), noise, spread, less_told(own, tells), tells)
    recorded = z[:, at] * size
    cut_off = np.maximum(np.diag(gram) - np.sum(recorded**2, axis=1), 0.0)

    def too_far(h: float) -> bool:
        draws = drawn_about_recordings(_blurred(sharp, h, curves, bands, most_noise))[:, at] * size
        reached = np.quantile(_nearest(draws, recorded, cut_off), QUARTILES)
        return bool(np.mean(np.log(np.maximum(reached, 1e-12) / np.maximum(asked, 1e-12))) > 0)

    asked = np.quantile(nearest[:, 0], QUARTILES)
    h = _largest_not(too_far)
    blurred = _blurred(sharp, h, curves, bands, most_noise)
    return replace(blurred, factor=compressed(blurred.factor))


def _blurred(
    sharp: SmoothedScores, h: float, curves: tuple[Curves, ...], bands: list[Bands], most_noise: float
) -> SmoothedScores:
    """With bandwidth h along curves: noise in place of what is slow in time of deviations; beside them by the rule.

    In each band the shares of noise and of deviations add up to the variance, so fine detail, which takes no noise,
    stays whole. Drawn in as a whole towards their mean, movements whose peaks come at different times lost a fifth of
    their speed. Deviations from a mean of few lack a share of the variance (Davison & Hinkley 1997, eq. 6.9): that
    much more is left of them, but no more than they are, else of few repetitions a drawn body would be wilder in its
    fine detail than any. All other coordinates go with the curves, as drawn, as far as these tell of them, and what is
    left takes noise by the rule: with noise of their own for all of them a duration kept 0.48 of its correlation with
    made postures, where 0.60 was recorded.
    """
    lacking = len(sharp.owner) / _n_free(sharp.owner)
    factor, left = sharp.factor.copy(), sharp.left.copy()
    shares = [most_noise] + [MOST_NOISE_BESIDE] * (len(curves) - 1)
    for curve, band, most in zip(curves, bands, shares):
        noise = band.noise(h, most)
        factor[:, curve.at] = band.times(factor[:, curve.at], np.sqrt(noise))
        left[:, curve.at] = band.times(left[:, curve.at], np.sqrt(np.minimum(lacking * (1.0 - noise), 1.0)))
    return _beside_curves(replace(sharp, factor=factor, left=left), curves)


def _beside_curves(blurred: SmoothedScores, curves: tuple[Curves, ...]) -> SmoothedScores:
    """With the noise that all but curves takes: what these tell of it, and of the rest a share by the rule.

    Each row of noise is the smooth part of a recording's deviation, and tells of all else what that recording does, as
    far as it goes: by itself it would tell less, being hardly in the span of the recordings.

    Where curves are drawn larger than recorded they tell less; the rest is drawn in, or out, until the variance is
    whole.
    """
    own, n = within_worker(blurred.scores, blurred.owner), len(blurred.tells)
    n_free, square = _n_free(blurred.owner), np.mean(blurred.reach**2)
    size = np.concatenate([curve.size for curve in curves])
    far = np.sqrt(np.sum((blurred.factor[:, :n] * size) ** 2) / max(np.sum((own[:, :n] * size) ** 2), 1e-300))
    told, noise = blurred.deviations[:, :n] @ blurred.tells, far * own[:, :n] @ blurred.tells
    recorded = np.sum((own[:, :n] @ blurred.tells) ** 2, axis=0) / n_free
    less = room(recorded, np.mean(told**2, axis=0) + square * np.sum(noise**2, axis=0))
    blurred = replace(blurred, tells=blurred.tells * less, factor=blurred.factor.copy())
    rest, wild = less_told(own, blurred.tells)[:, n:], np.linalg.norm(blurred.factor[:, n:], axis=0)
    wanted = np.sqrt(_noise_share(blurred.owner) * np.sum(rest**2, axis=0) / n_free / square)
    blurred.factor[:, n:] = blurred.factor[:, n:] * wanted / np.maximum(wild, 1e-12) + noise * less
    told = told * less
    left = blurred.spread[n:] ** 2 - square * np.sum(blurred.factor[:, n:] ** 2, axis=0) - np.mean(told**2, axis=0)
    rest = rest * _root(np.mean(rest**2, axis=0), np.mean(rest * told, axis=0), left)
    return replace(blurred, left=np.concatenate([blurred.left[:, :n], rest], axis=1))


def _n_free(owner: np.ndarray) -> int:
    """Degrees of freedom of deviations from workers' means."""
    return max(len(owner) - len(np.unique(owner)), 1)


def _root(square: np.ndarray, half: np.ndarray, left: np.ndarray) -> np.ndarray:
    """The x >= 0 at which square x^2 + 2 half x = left, or the nearest to it."""
    inside = np.sqrt(np.maximum(half**2 + square * left, 0.0))
    return np.maximum(inside - half, 0.0) / np.maximum(square, 1e-18)


def told_by_curves(own: np.ndarray, curves: tuple[Curves, ...], n_free: int) -> np.ndarray:
    """(C, K - C) regression of all else on the C coordinates of curves, from deviations (N, K) from workers' means.

    A ridge on the curves' raw scores, for each coordinate with the penalty of least generalised cross-validation
    (Golub, Heath & Wahba 1979); a coordinate that curves do not foretell gets next to nothing.
    """
    size = np.concatenate([curve.size for curve in curves])
    n = len(size)
    u, d, vt = np.linalg.svd(own[:, :n] * size, full_matrices=False)
    y = u.T @ own[:, n:]
    outside = np.sum(own[:, n:] ** 2, axis=0) - np.sum(y**2, axis=0)
    kept = d**2 / (d**2 + PENALTIES[:, None] * max(np.mean(d**2), 1e-300))
    missed = outside + (1.0 - kept) ** 2 @ y**2
    free = np.maximum(n_free - kept.sum(axis=1), 1e-9)
    best = (missed / free[:, None] ** 2).argmin(axis=0)
    slopes = np.where(d > 1e-9 * d.max(initial=0.0), 1.0 / np.maximum(d, 1e-300), 0.0) * kept[best]
    return np.asarray(size[:, None] * (vt.T @ (slopes.T * y)))


def _noise_share(owner: np.ndarray) -> float:
    """Share of the variance that is noise by the rule of Silverman (1986, eq. 3.28) for the repetitions of one worker.

    At least what deviations from a worker's own mean lack of the variance.
    """
    each = len(owner) / len(np.unique(owner))
    h = (4.0 / (3.0 * each)) ** 0.2
    return max(h**2 / (1.0 + h**2), 1.0 / each)


def _largest_not(too_far: Callable[[float], bool]) -> float:
    """The largest h up to ``LARGEST`` that is not too far, by bisection."""
    low, high = 0.0, LARGEST
    for _ in range(N_HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if too_far(middle) else (middle, high)
    return low


def drawn_about_recordings(blurred: SmoothedScores) -> np.ndarray:
    """(N_TRIED, K) draws about the recordings in turn, always with the same random numbers."""
    rng = np.random.default_rng(0)
    n = len(blurred.owner)
    at = rng.permutation(np.arange(max(N_TRIED, n)) % n)[:N_TRIED]
    centre = blurred.means[blurred.owner[at]] + blurred.deviations[at]
    return np.asarray(centre + blurred.reach[at, None] * blurred.noise.sample(N_TRIED, rng))


def distance_to_recordings(blurred: SmoothedScores, at: slice, size: np.ndarray) -> float:
    """Median distance of draws about recordings to the nearest of these, in coordinates ``at`` (P,) times size (P,)."""
    recorded = blurred.scores[:, at] * size
    return float(np.median(_nearest(drawn_about_recordings(blurred)[:, at] * size, recorded, np.zeros(len(recorded)))))


def _nearest(drawn: np.ndarray, recorded: np.ndarray, cut_off: np.ndarray) -> np.ndarray:
    """(n,) distance of raw scores (n, P) to the nearest whole sequence; ``cut_off`` (N,) is what scores leave out."""
    square = np.sum(drawn**2, axis=1)[:, None] + np.sum(recorded**2, axis=1) - 2 * drawn @ recorded.T
    return np.asarray(np.sqrt(np.maximum(square + cut_off, 0.0).min(axis=1)))


def _reach(nearest: np.ndarray) -> np.ndarray:
    """(N,) distance to the nearest few over its geometric mean, at most twice or half of it."""
    far = np.maximum(np.sqrt(np.mean(nearest**2, axis=1)), 1e-12)
    reach = np.clip(far / np.exp(np.log(far).mean()), 1.0 / MOST_REACH, MOST_REACH)
    return reach / np.sqrt(np.mean(reach**2))


def _noise(own: np.ndarray, owner: np.ndarray, curves: tuple[Curves, ...], tells: np.ndarray) -> np.ndarray:
    """(N, K) rows of the within-worker covariance, strange repetitions drawn in to the median size (Huber 1964).

    Of curves, which the first of them tells, all then are as much larger as leaves the variance what it was; of all
    else the rows are what curves do not tell.
    """
    rows = less_told(own, tells)
    length = np.linalg.norm(rows[:, curves[0].at] * curves[0].size, axis=1)
    rows = rows * np.minimum(1.0, np.median(length) / np.maximum(length, 1e-12))[:, None]
    for curve in curves:
        before, after = (float(np.sum((some[:, curve.at] * curve.size) ** 2)) for some in (own, rows))
        rows[:, curve.at] *= np.sqrt(before / max(after, 1e-300))
    return rows / np.sqrt(_n_free(owner))
