"""Reach: the law of joint coordinates z of one worker, given where joints are at marks.

h(z) is where they are (``targets.HandPlaces``). What the recordings tell of z by h(z), as a local regression
M (Cleveland 1979), carries each component of the law from its own place to the target, z + M(target) - M(h(z)): it
keeps what the place does not tell of it. In a gap between recorded places M is a straight line from one side to the
other, since a line through one side alone leads astray. A few Newton steps bring each onto the target itself; the noise
about it is held there, by Matheron's rule with the derivative of h at the middle of the new law.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from emulator.model.gaussian import Law, LowRankNormal
from emulator.model.joint_coordinates import within_worker
from emulator.model.joint_law import JointLaw
from emulator.people.workers import WorkerEffect

HIT_M = 1e-3
"""How near a component of a law comes to its target, and how loosely noise is held: a millimetre."""
MARK_M = 0.03
"""How well a place tells: three centimetres. It keeps what places that hardly varied tell from growing wild."""
STEP = 1e-3
ROUNDS = 8
LOST_M, NEARER = 0.05, (0.7, 0.5, 0.3, 0.1, 0.0)
"""A component that ends farther from its target begins anew with these shares of its way from the most likely z."""
SPANS = (np.inf, 1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.12)
"""Shares of the recordings that a local regression may look at; infinity: all, alike."""
AS_GOOD = 1.03
"""Curves follow as closely as they may at that price: what a narrow window adds to their scatter is not seen, but how a
wide one cuts corners is. Times scatter more, and there the best window is taken."""
SURE = 2.0
"""Standard errors by which places must foretell a time better than its mean does, to be believed."""

WIDE_M, FEW = 0.20, 3
"""Recordings farther apart than 0.20 m have a gap between them; fewer than 3 together within one do not end it."""

Places = Callable[[np.ndarray], np.ndarray]
"""z (n, K) -> (n, R) what of the places is asked for, in metres."""


@dataclass(frozen=True)
class HeldNormal(LowRankNormal):
    """A LowRankNormal whose deviations are held where they do not move the hands: x - mean -> (I - G H) (x - mean).

    gain : (K, R) G = M C H' (H M C H' + s^2)^-1, where M keeps what is not to be moved as it is; slope : (R, K) H, how
           the hands move with x
    Takes the same random numbers as the free one. Source: Matheron's rule, see Journel & Huijbregts (1978), sec. VII.
    """

    gain: np.ndarray
    slope: np.ndarray

    def sample(self, n: int, rng: np.random.Generator) -> np.ndarray:
        """n draws (n, K), see ``LowRankNormal.sample``."""
        x = super().sample(n, rng)
        x -= ((x - self.mean) @ self.slope.T) @ self.gain.T
        return x

    @cached_property
    def covariance(self) -> np.ndarray:  # type: ignore[override]
        """(K, K)."""
        held = np.eye(len(self.mean)) - self.gain @ self.slope
        return np.asarray(held @ super().covariance @ held.T)

    def covariance_with(self, index: int) -> np.ndarray:
        """(K,) covariance of every coefficient with coefficient ``index``."""
        return np.asarray(self.covariance[:, index])


def held(free: LowRankNormal, slope: np.ndarray, moved: np.ndarray) -> HeldNormal:
    """The free one held for this derivative of the hands (R, K) by the coordinates that may be ``moved`` (K,)."""
    by = gain(free.covariance, slope, moved)
    return HeldNormal(free.mean, free.factor, free.spread, free.rho, by, slope)


def gain(covariance: np.ndarray, slope: np.ndarray, moved: np.ndarray) -> np.ndarray:
    """(K, R) how z (K,) moves with the hands: M C H' (H M C H' + s^2 I)^-1, s being ``HIT_M``.

    moved : (K,) the diagonal of M: which coordinates may be moved
    """
    across = moved[:, None] * (covariance @ slope.T)
    return np.asarray(np.linalg.solve((slope @ across + HIT_M**2 * np.eye(len(slope))).T, across.T).T)


def gaps_m(along_m: np.ndarray) -> list[tuple[float, float]]:
    """(low, high) of each stretch between recorded places (N,) along an axis in which hardly any lie."""
    groups = np.split(np.sort(along_m), np.flatnonzero(np.diff(np.sort(along_m)) > WIDE_M) + 1)
    ends = [group for group in groups if len(group) >= FEW]
    return [(float(low[-1]), float(high[0])) for low, high in pairwise(ends)]


@dataclass(frozen=True, eq=False)
class LocalRegression:
    """What recordings tell of z by their places: lines or parabolas through those near a place (loess).

    z (N, K), place (N, R); span : share of the N that a line looks at; degree : 1 or 2
    trust : (K,) how much of what is foretold beyond the mean is believed, 0 to 1
    Source: Cleveland (1979), tricube weights without robustness; as a ridge of ``MARK_M``.
    """

    z: np.ndarray
    place: np.ndarray
    span: float = np.inf
    degree: int = 1
    trust: np.ndarray = field(default_factory=lambda: np.ones(1))

    def weights(self, at: np.ndarray) -> np.ndarray:
        """(n, N) that add to 1: how much each recording tells at places (n, R)."""
        return self._bridged(self._weights, at)

    def _weights(self, at: np.ndarray) -> np.ndarray:
        n = len(self.z)
        if not np.isfinite(self.span):
            return np.full((len(at), n), 1.0 / n)
        far = np.linalg.norm(at[:, None] - self.place, axis=-1)
        last = np.sort(far, axis=1)[:, min(n, max(self.fewest, int(np.ceil(self.span * n)))) - 1]
        weight = np.maximum(1.0 - (far / np.maximum(1.05 * last, 1e-9)[:, None]) ** 3, 0.0) ** 3
        return np.asarray(weight / weight.sum(axis=1, keepdims=True))

    @property
    def fewest(self) -> int:
        """Recordings that a line or a parabola needs."""
        n = self.place.shape[1]
        return 3 * (1 + n + (n * (n + 1) // 2 if self.degree == 2 else 0))

    def __call__(self, at: np.ndarray) -> np.ndarray:
        """(n, K) z as foretold at places (n, R)."""
        middle = self.z.mean(axis=0)
        return np.asarray(middle + self.trust * (self._bridged(self._smoother, at) @ self.z - middle))

    @cached_property
    def gaps_m(self) -> list[list[tuple[float, float]]]:
        """By axis, see ``gaps_m``; none where one straight line is drawn through all recordings anyway."""
        straight = self.degree == 1 and not np.isfinite(self.span)
        return [[] if straight else gaps_m(along) for along in self.place.T]

    def _bridged(self, rows_of: Callable[[np.ndarray], np.ndarray], at: np.ndarray, axis: int = 0) -> np.ndarray:
        """(n, N) of ``rows_of`` at places (n, R); in a gap along an axis, a straight line between its two ends."""
        if axis == len(self.gaps_m):
            return rows_of(at)
        out = self._bridged(rows_of, at, axis + 1)
        for low, high in self.gaps_m[axis]:
            inside = np.flatnonzero((low < at[:, axis]) & (at[:, axis] < high))
            if inside.size:
                share = ((at[inside, axis] - low) / (high - low))[:, None]
                ends = [np.array(at[inside]) for _ in range(2)]
                ends[0][:, axis], ends[1][:, axis] = low, high
                one, other = (self._bridged(rows_of, end, axis + 1) for end in ends)
                out[inside] = (1.0 - share) * one + share * other
        return out

    def _smoother(self, at: np.ndarray) -> np.ndarray:
        """(n, N) what is multiplied by z: linear in it."""
        weight = self._weights(at)
        middle = weight @ self.place
        apart, here = self.place - middle[:, None], at - middle
        doubt = np.full(here.shape, MARK_M**2)
        if self.degree == 2:
            apart, here, doubt = _bent(weight, apart, here, doubt)
        square = np.swapaxes(apart, 1, 2) @ (weight[..., None] * apart) + doubt[:, None] * np.eye(here.shape[1])
        lever = np.linalg.solve(square, here[..., None])
        return np.asarray(weight * (1.0 + (apart @ lever)[..., 0]))

    def best(self, scale: np.ndarray, as_good: float = 1.0) -> LocalRegression:
        """With the span and degree that follow z most closely and foretell left-out recordings as well as any.

        That is, of those whose error is at most ``as_good`` times the least, that with the greatest trace of the
        smoother. scale (K,) weighs errors.
        """
        tried = [replace(self, span=span, degree=degree) for degree in (1, 2) for span in SPANS]
        tried = [one for one in tried if len(self.z) * min(one.span, 1.0) > one.fewest or one is tried[0]]
        errors = [float(np.mean(((self.z - one._left_out()) * scale) ** 2)) for one in tried]
        good = [one for one, error in zip(tried, errors) if error <= as_good * min(errors)]
        return max(good, key=lambda one: float(np.trace(one._smoother(one.place))))

    def shrunk(self, sure: float | None = None) -> LocalRegression:
        """Of which no more is believed than left-out recordings bear out: the slope of z on what is foretold, 0 to 1.

        And nothing where places do not foretell them better than the mean does: by ``sure`` standard errors, also
        without the gain of any single recording, since what hangs on one is not believed; None: at all.
        Source: van Houwelingen & le Cessie (1990), shrinkage by cross-validation.
        """
        n, apart, left_out = len(self.z), self.z - self.z.mean(axis=0), self._left_out()
        told = left_out - self.z.mean(axis=0)
        slope = np.sum(told * apart, axis=0) / np.maximum(np.sum(told**2, axis=0), 1e-12)
        gain = (apart * n / (n - 1)) ** 2 - (self.z - left_out) ** 2
        believed = gain.mean(axis=0) > 0.0 if sure is None else _least_sure(gain) > sure
        return replace(self, trust=np.where(believed, np.clip(slope, 0.0, 1.0), 0.0))

    def _left_out(self) -> np.ndarray:
        """(N, K) each recording as foretold by the others."""
        smoother = self._smoother(self.place)
        own = np.minimum(np.diag(smoother), 0.95)[:, None]
        return np.asarray((smoother @ self.z - own * self.z) / (1.0 - own))


def _least_sure(gain: np.ndarray) -> np.ndarray:
    """(K,) means of gains (N, K) in their standard errors, the least with any one recording put aside."""
    n = len(gain) - 1
    if n < 3:  # of so few nothing is sure
        return np.full(gain.shape[1], -np.inf)
    mean = (gain.sum(axis=0) - gain) / n
    square = np.maximum((np.sum(gain**2, axis=0) - gain**2) / n - mean**2, 0.0) * n / (n - 1)
    return np.asarray(np.min(mean / np.maximum(np.sqrt(square / n), 1e-12), axis=0))


def _bent(
    weight: np.ndarray, apart: np.ndarray, here: np.ndarray, doubt: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places apart (n, N, R), here (n, R) and how far they are doubted (n, R), with their products beside them."""
    first, second = np.triu_indices(here.shape[1])
    products = apart[..., first] * apart[..., second]
    level = np.einsum("ni,nir->nr", weight, products)
    wide = np.einsum("ni,nir,nir->n", weight, apart, apart)
    return (
        np.concatenate([apart, products - level[:, None]], axis=2),
        np.concatenate([here, here[:, first] * here[:, second] - level], axis=1),
        np.concatenate([doubt, np.broadcast_to(MARK_M**2 * wide[:, None], level.shape)], axis=1),
    )


@dataclass(frozen=True, eq=False)
class Trend:
    """What recordings tell of z by places: of curves, and of the single numbers beside them, each by its own window.

    timed : (K,) which coordinates of z are durations, marks and pauses, of which places tell much or nothing
    moved : (K,) which may be moved beyond what is foretold to bring joints to their places: no durations and pauses,
            but all of a library of plain Gaussians, which foretells by its covariance alone
    """

    timed: np.ndarray
    moved: np.ndarray
    curves: LocalRegression
    times: LocalRegression

    @classmethod
    def fit(cls, model: JointLaw, z: np.ndarray, place: np.ndarray) -> Trend:
        """Windows as left-out recordings ask for them; z (N, K), place (N, R)."""
        timed, scale = beside_curves(model), errors_scale(model)
        curves = LocalRegression(z[:, ~timed], place).best(scale[~timed], AS_GOOD)
        times = LocalRegression(z[:, timed], place).best(scale[timed])
        if model.workforce.smoothed is None:
            return cls(timed, np.ones(len(timed), bool), curves, times.shrunk())
        moved = np.ones(len(timed), bool)
        moved[model.scale.block("duration")] = moved[model.scale.block("dwells")] = False
        return cls(timed, moved, curves, times.shrunk(SURE))

    def of(self, z: np.ndarray, place: np.ndarray) -> Trend:
        """The same windows and trust over other z (N, K) and places (N, R)."""
        curves, times = (
            replace(one, z=z[:, which], place=place)
            for one, which in ((self.curves, ~self.timed), (self.times, self.timed))
        )
        return replace(self, curves=curves, times=times)

    def __call__(self, at: np.ndarray) -> np.ndarray:
        """(n, K) z as foretold at places (n, R)."""
        return self._together(self.curves(at), self.times(at))

    def covariance(self, at: np.ndarray) -> np.ndarray:
        """(K, K) of z near one place (R,)."""
        weight, z = self.curves.weights(at[None])[0], self._together(self.curves.z, self.times.z)
        apart = z - weight @ z
        return np.asarray(apart.T @ (weight[:, None] * apart))

    @property
    def place(self) -> np.ndarray:
        """(N, R) of the recordings."""
        return self.curves.place

    def _together(self, curves: np.ndarray, times: np.ndarray) -> np.ndarray:
        both = np.empty((len(curves), len(self.timed)))
        both[:, ~self.timed], both[:, self.timed] = curves, times
        return both


def recorded(model: JointLaw, mean: np.ndarray | None) -> np.ndarray:
    """(N, K) joint coordinates that tell how z goes with places.

    mean : (K,) of a worker: the recordings as if that worker had made them; None: the recordings as they are
    A library of plain Gaussians, which has none, tells it by deviations of one standard deviation along each row.
    """
    known = model.workforce.smoothed
    if known is None:
        rows = model.workforce.within.factor
        middle = model.workforce.between.mean if mean is None else mean
        both = rows if mean is not None else np.concatenate([rows, model.workforce.between.factor])
        return np.concatenate([middle + both, middle - both])
    return known.scores if mean is None else mean + within_worker(known.scores, known.owner)


def beside_curves(model: JointLaw) -> np.ndarray:
    """(K,) which coordinates are durations, marks and pauses: single numbers, of which places tell much or nothing."""
    doubted = np.zeros(len(model.scale.centre), bool)
    for name in ("duration", "marks", "dwells"):
        doubted[model.scale.block(name)] = True
    return doubted


def errors_scale(model: JointLaw) -> np.ndarray:
    """(K,) what errors of z count: postures by their size, log duration as much as all of these, the rest nothing."""
    scale, posture = np.zeros(len(model.scale.centre)), model.scale.block("posture")
    size = model.scale.spread[posture]
    scale[posture] = size / max(float(np.linalg.norm(size)), 1e-12)
    scale[model.scale.block("duration")] = 1.0
    return scale


@dataclass(frozen=True, eq=False)
class ReachedLaw:
    """law : of z given the target; middle : (K,) its most likely z; moving : (K, R) how z follows the hands there."""

    law: Law
    middle: np.ndarray
    moving: np.ndarray


def reached_law(
    model: JointLaw, effect: WorkerEffect | None, places: Places, target: np.ndarray, like: Trend
) -> ReachedLaw:
    """The law of the worker with this effect, or (None) of anybody, given that ``places`` are at ``target`` (R,).

    like : a trend whose windows and trust are taken
    """

    def places_of(z: np.ndarray, rows: np.ndarray) -> np.ndarray:
        return places(z)  # one worker's, in all rows

    law = model.workforce.law(effect)
    z = recorded(model, None if effect is None else effect.z)
    trend = like.of(z, places(z))
    foretold = trend(target[None])[0]
    near = trend.covariance(target) + np.mean(law.reach**2) * law.noise.covariance
    middle, moving = foretold, np.zeros((len(foretold), len(target)))
    slope = np.zeros((len(target), len(foretold)))
    for _ in range(ROUNDS):
        here, slope = derivative(places, middle)
        moving = gain(near, slope, like.moved)
        if np.abs(target - here).max() < HIT_M:
            break
        middle = on_target(places_of, middle[None], moving, target)[0]
    centre = law.mean + (law.centre if law.people is None else law.people.mean)
    start = centre + foretold - trend(places(centre))
    moved = on_target(places_of, start, moving, target)
    for share in NEARER:  # what is too far away for a straight line begins nearer to the most likely one
        lost = np.flatnonzero(np.linalg.norm(target - places(moved), axis=1) > LOST_M)
        if lost.size == 0:
            break
        nearer = np.where(like.moved, middle + share * (start[lost] - middle), start[lost])
        moved[lost] = on_target(places_of, nearer, moving, target)
    people = None if law.people is None else held(law.people, slope, like.moved)
    base = law.centre if law.people is None else law.people.mean
    own = replace(law, mean=moved - base, noise=held(law.noise, slope, like.moved), people=people)
    return ReachedLaw(own, middle, moving)


def derivative(places: Places, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places (R,) at z (K,) and how they move with it, (R, K)."""
    around = places(np.concatenate([z[None], z + STEP * np.eye(len(z))]))
    return around[0], (around[1:] - around[0]).T / STEP


def on_target(
    places: Callable[[np.ndarray, np.ndarray], np.ndarray], z: np.ndarray, moving: np.ndarray, target: np.ndarray
) -> np.ndarray:
    """z (n, K) moved along ``moving`` (K, R) until they are at ``target``, by Newton steps halved where they miss.

    places : of some z and which rows they are
    """
    z = np.array(z)
    miss = target - places(z, np.arange(len(z)))
    size, step = np.linalg.norm(miss, axis=1), np.ones(len(z))
    for _ in range(ROUNDS):
        rows = np.flatnonzero(size > HIT_M)
        if rows.size == 0:
            break
        tried = z[rows] + step[rows, None] * (miss[rows] @ moving.T)
        missed = target - places(tried, rows)
        length = np.linalg.norm(missed, axis=1)
        better = length < size[rows]
        step[rows] = np.where(better, np.minimum(2.0 * step[rows], 1.0), 0.5 * step[rows])
        won = rows[better]
        z[won], miss[won], size[won] = tried[better], missed[better], length[better]
    return z
