"""How much to blur: so much that a draw is as far from the nearest recording as a repetition that was left out.

The distance to the nearest other repetition is what tells a copy from a movement of its own. It is known of every
recording by leaving it out, and the noise is made as large as it may be without going beyond it at any quartile.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from emulator.density import compressed
from emulator.margin import within_worker
from emulator.smoothed import SmoothedScores, partners, room

QUARTILES = (0.25, 0.5, 0.75)
NEARER = 0.875
"""Draws may be an eighth nearer to a recording than a left-out repetition is: noise is paid for in roughness."""
STIFF = 16.0
"""How much smoother than the recordings the noise is."""
N_TRIED, N_HALVINGS, LARGEST, N_NEAREST, MOST_REACH = 400, 12, 2.0, 3, 2.0
MOST_NOISE = 0.5
"""Share of a curve's variance that noise may be: beyond it hardly anything of the recordings themselves is left."""


@dataclass(frozen=True, eq=False)
class Curves:
    """A block of coordinates that say curves over time: postures, root paths, paces.

    at : where its P coordinates lie in z; size : (P,) their raw standard deviations, largest first
    bend : (P, P) products of the second differences in time of its components
    """

    at: slice
    size: np.ndarray
    bend: np.ndarray


def smoothed(
    z: np.ndarray,
    owner: np.ndarray,
    spread: np.ndarray,
    posture: Curves,
    others: tuple[Curves, ...],
    gram: np.ndarray,
) -> SmoothedScores:
    """The smoothed scores of z (N, K) with the bandwidth that distances to left-out repetitions ask for.

    spread  : (K,) within-worker standard deviations that draws are to have
    posture : decides the bandwidth; others : are blurred like it, as stiffly
    gram    : (N, N) products of the whole centred posture sequences, of which the raw scores are the leading part
    """
    square = np.diag(gram)[:, None] + np.diag(gram)[None] - 2 * gram
    other = np.sqrt(np.maximum(square, 0.0)) + np.diag(np.full(len(z), np.inf))
    nearest = np.sort(other, axis=1)[:, : min(N_NEAREST, len(z) - 1)]
    curves, at, size, mixed = (posture, *others), posture.at, posture.size, partners(owner, other)
    whole = SmoothedScores(z, owner, _reach(nearest), _noise(z, owner, curves), spread, np.ones(z.shape[1]), mixed)
    recorded = z[:, at] * size
    cut_off = np.maximum(np.diag(gram) - np.sum(recorded**2, axis=1), 0.0)

    def too_far(h: float) -> bool:
        draws = _drawn(_blurred(whole, h, curves))[:, at] * size
        reached = np.quantile(_nearest(draws, recorded, cut_off), QUARTILES)
        return bool(np.mean(np.log(np.maximum(reached, 1e-12) / np.maximum(asked, 1e-12))) > 0)

    asked = NEARER * np.quantile(nearest[:, 0], QUARTILES)
    h = _largest_not(too_far)
    blurred = _blurred(whole, h, curves)
    return replace(blurred, factor=compressed(blurred.factor))


def _blurred(whole: SmoothedScores, h: float, curves: tuple[Curves, ...]) -> SmoothedScores:
    """With bandwidth h along curves, though no coordinate varies more than it is to vary; beside them by the rule.

    What deviations are drawn in by, to leave room for the noise, is one factor for each curve: a factor for each
    coordinate parts the large ones from the fine detail that belongs to them, and draws get rough. All other
    coordinates take about as much noise, because what one takes from the recording and another from the noise they
    do not share: with h for the duration too, which nothing held back, it was all noise, and its correlation with made
    postures 0.26-0.55 within workers where 0.60 was recorded; by the rule it is 0.48-0.56.
    """
    noise = whole.noise.spread * np.sqrt(np.mean(whole.reach**2))
    wanted = whole.spread * np.sqrt(_noise_share(whole.owner))
    for curve in curves:
        wanted[curve.at] = np.minimum(h * noise, np.sqrt(MOST_NOISE) * whole.spread)[curve.at]
    variance = np.mean(within_worker(whole.scores, whole.owner) ** 2, axis=0)
    drawn_in = room(whole.spread**2 - wanted**2, variance)
    for curve in curves:
        here, weight = curve.at, curve.size**2
        left = np.maximum(whole.spread[here] ** 2 - wanted[here] ** 2, 0.0)
        drawn_in[here] = room(np.sum(left * weight), np.sum(variance[here] * weight))
    return replace(whole, factor=whole.factor * wanted / np.maximum(noise, 1e-12), drawn_in=drawn_in)


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


def _drawn(blurred: SmoothedScores) -> np.ndarray:
    """(N_TRIED, K) draws about the recordings in turn, always with the same random numbers."""
    rng = np.random.default_rng(0)
    first, deviation = blurred.sources
    at = rng.permutation(np.arange(max(N_TRIED, len(first))) % len(first))[:N_TRIED]
    centre = blurred.means[blurred.owner[first[at]]] + deviation[at]
    return np.asarray(centre + blurred.reach[first[at], None] * blurred.noise.sample(N_TRIED, rng))


def _nearest(drawn: np.ndarray, recorded: np.ndarray, cut_off: np.ndarray) -> np.ndarray:
    """(n,) distance of raw scores (n, P) to the nearest whole sequence; ``cut_off`` (N,) is what scores leave out."""
    square = np.sum(drawn**2, axis=1)[:, None] + np.sum(recorded**2, axis=1) - 2 * drawn @ recorded.T
    return np.asarray(np.sqrt(np.maximum(square + cut_off, 0.0).min(axis=1)))


def _reach(nearest: np.ndarray) -> np.ndarray:
    """(N,) distance to the nearest few over its geometric mean, at most twice or half of it."""
    far = np.maximum(np.sqrt(np.mean(nearest**2, axis=1)), 1e-12)
    reach = np.clip(far / np.exp(np.log(far).mean()), 1.0 / MOST_REACH, MOST_REACH)
    return reach / np.sqrt(np.mean(reach**2))


def _noise(z: np.ndarray, owner: np.ndarray, curves: tuple[Curves, ...]) -> np.ndarray:
    """(N, K) rows of the within-worker covariance, strange repetitions drawn in to the median size (Huber 1964).

    Curves are smoothed by (I + (lambda bend)^2)^-1, so that noise moves a recording without making it rough (after
    Silverman 1996, smoothed principal components); lambda is STIFF times the variance over the bending of the rows.
    """
    rows = within_worker(z, owner)
    length = np.linalg.norm(rows[:, curves[0].at] * curves[0].size, axis=1)
    rows = rows * np.minimum(1.0, np.median(length) / np.maximum(length, 1e-12))[:, None]
    for curve in curves:
        rows[:, curve.at] = stiff(rows[:, curve.at], curve)
    return rows / np.sqrt(max(len(z) - len(np.unique(owner)), 1))


def stiff(rows: np.ndarray, curve: Curves) -> np.ndarray:
    """Rows (R, P) of a block of curves, smoothed by (I + (lambda bend)^2)^-1.

    lambda is ``STIFF`` times the rows' median variance over their bending.
    """
    raw = rows * curve.size
    bending = np.sum((raw @ curve.bend) * raw, axis=1)
    weight = STIFF * np.median(np.sum(raw**2, axis=1) / np.where(bending > 0, bending, np.inf))
    return np.linalg.solve(np.eye(len(curve.size)) + weight**2 * curve.bend @ curve.bend, raw.T).T / curve.size
