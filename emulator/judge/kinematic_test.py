"""Can a classifier tell drawn movements from recorded ones by how they move? The hardest fair judge of real time.

Each movement says its quantiles of speed, acceleration and jerk over joints and time, and what its feet do; a logistic
curve on these and their squares is fitted to some movements and asked of the others. An area under the curve of .5 says
that it cannot tell, 1 that it always can. Source: Lopez-Paz & Oquab 2017 (classifier two-sample tests), with the area
under the curve in place of accuracy; the null by permutation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.special import expit

from emulator.judge.clips import Clips
from emulator.judge.feet import feet, footing, standing_m

RATE_HZ, CUT_OFF_HZ = 60.0, 6.0
"""Recorded and drawn are read alike at this rate, without what lies above the cut-off: only markers show that."""
QUANTILES = (0.1, 0.25, 0.5, 0.75, 0.9, 0.97, 1.0)
FLOORS = {"speed": 0.01, "acceleration": 0.1, "jerk": 2.0}
"""m/s, m/s^2, m/s^3 added before the logarithm: exact zeros tell of a file format, not of a movement."""
FEET = ("planted", "wander_cm", "slide_cm")
RIDGE = 1.0
N_FOLDS, N_DEALS = 5, 2
FEWEST = 3
"""Movements of each kind with which the test can be made."""
_STEPS, _CLOSE = 25, 1e-6


@dataclass(frozen=True)
class KinematicTest:
    """What was found.

    auc       : cross-validated area under the curve, drawn above recorded; .5 cannot tell, 1 always can
    null_mean, null_95 : mean and 95 % quantile of it over permutations of who is drawn
    p         : (1 + permutations at least as high) / (1 + ``n_permutations``)
    telling   : the feature that alone tells most, in words, and its area (above .5: greater in draws)
    """

    auc: float
    null_mean: float
    null_95: float
    p: float
    n_recorded: int
    n_drawn: int
    n_permutations: int
    telling: tuple[str, float]


def kinematic_test(
    recorded: Clips,
    drawn: Clips,
    rng: np.random.Generator,
    *,
    pairs: bool = False,
    n_permutations: int = 99,
) -> KinematicTest:
    """Recorded clips against drawn ones.

    pairs : clip i of both is one movement (recorded, and encoded and decoded): both lie in one fold, and a permutation
            changes roles within pairs
    Raises ValueError for fewer than ``FEWEST`` of either, or pairs of unequal number.
    """
    n, m = len(recorded), len(drawn)
    if min(n, m) < FEWEST or (pairs and n != m):
        raise ValueError(f"kinematic test: found {n} recorded and {m} drawn, expected {FEWEST} or more of each, alike")
    standing = standing_m(recorded)
    names = feature_names(recorded)
    x = filled(np.concatenate([features(clips, standing) for clips in (recorded, drawn)]))
    y = np.arange(n + m) >= n
    group = np.concatenate([np.arange(n), np.arange(n) if pairs else n + np.arange(m)])
    folds = [_dealt(y, group, pairs, rng) for _ in range(N_DEALS)]
    auc = _validated(x, y, folds)
    null = np.array([_validated(x, _permuted(y, pairs, rng), folds) for _ in range(n_permutations)])
    p = (1 + int(np.sum(null >= auc))) / (1 + n_permutations)
    mean, high = (float(null.mean()), float(np.quantile(null, 0.95))) if n_permutations else (np.nan, np.nan)
    return KinematicTest(auc, mean, high, p, n, m, n_permutations, _telling(x, y, names))


def feature_names(clips: Clips) -> list[str]:
    """Words for the columns of ``features``."""
    rates = [f"{'greatest' if q == 1 else f'{100 * q:.0f} % quantile of'} {name}" for name in FLOORS for q in QUANTILES]
    words = ("share of time with a foot down", "wander of a planted foot", "slide of a planted foot")
    return rates + (list(words) if feet(clips.skeleton) else [])


def features(clips: Clips, standing: np.ndarray | None = None) -> np.ndarray:
    """(n, F) logarithms of quantiles over joints and times, below ``CUT_OFF_HZ``, and of what the feet do (NaN: none).

    The Gaussian that smooths lets through half the power at the cut-off.
    """
    places, step_s = clips.at_rate(RATE_HZ)
    blur_s = np.sqrt(np.log(2)) / (2 * np.pi * CUT_OFF_HZ)
    rows = []
    for positions, step in zip(places, step_s):
        smooth, row = gaussian_filter1d(positions, blur_s / step, axis=0, mode="nearest"), []
        for order, floor in enumerate(FLOORS.values(), 1):
            rate = np.linalg.norm(np.diff(smooth, n=order, axis=0), axis=-1) / step**order
            row += np.log(np.quantile(rate, QUANTILES) + floor).tolist()
        rows.append(row)
    if not feet(clips.skeleton):
        return np.array(rows)
    found = footing(clips, standing)
    planted, *ways = (getattr(found, name) for name in FEET)
    return np.column_stack([np.array(rows), planted, *(np.log(way + 0.1) for way in ways)])


def filled(x: np.ndarray) -> np.ndarray:
    """(n, F) with what is not known replaced by the middle of its column, and columns that say nothing left at 0."""
    known = np.isfinite(x)
    middle = np.array([np.median(column[there]) if there.any() else 0.0 for column, there in zip(x.T, known.T)])
    return np.where(known, x, middle)


def area_under_curve(score: np.ndarray, positive: np.ndarray) -> float:
    """Share of pairs in which the positive one has the higher score, ties by half; (n,) each."""
    others = np.sort(score[~positive])
    below, up_to = (np.searchsorted(others, score[positive], side=side) for side in ("left", "right"))
    return float(np.mean(0.5 * (below + up_to)) / len(others))


def logistic(x: np.ndarray, y: np.ndarray, ridge: float = RIDGE) -> np.ndarray:
    """Coefficients (F + 1,), intercept first, of y (n,) on x (n, F): both kinds of equal weight, ``ridge`` on the rest.

    Least of the sum of weighted losses + ridge / 2 * |coefficients|^2, by Newton's steps, halved where too long.
    """
    design = np.column_stack([np.ones(len(x)), x])
    weight = np.where(y, 0.5 / max(y.mean(), 1e-9), 0.5 / max(1 - y.mean(), 1e-9))
    penalty = np.full(design.shape[1], ridge)
    penalty[0] = 1e-6
    beta = np.zeros(design.shape[1])
    loss = _loss(design, y, weight, penalty, beta)
    for _ in range(_STEPS):
        chance = expit(design @ beta)
        slope = design.T @ (weight * (chance - y)) + penalty * beta
        bend = (design * (weight * np.maximum(chance * (1 - chance), 1e-9))[:, None]).T @ design + np.diag(penalty)
        step = np.linalg.solve(bend, slope)
        share = 1.0
        while (new := _loss(design, y, weight, penalty, beta - share * step)) > loss and share > 1e-4:
            share /= 2
        beta, gained, loss = beta - share * step, loss - new, new
        if gained < _CLOSE * abs(loss):
            break
    return beta


def _loss(design: np.ndarray, y: np.ndarray, weight: np.ndarray, penalty: np.ndarray, beta: np.ndarray) -> float:
    line = design @ beta
    return float(weight @ (np.logaddexp(0.0, line) - y * line) + 0.5 * penalty @ beta**2)


def _validated(x: np.ndarray, y: np.ndarray, folds: list[np.ndarray]) -> float:
    """Mean area under the curve over deals of folds (n,), of scores by classifiers that have not seen the movement."""
    areas = []
    for fold in folds:
        score = np.empty(len(x))
        for k in np.unique(fold):
            out = fold == k
            score[out] = _scores(x[~out], y[~out], x[out])
        areas.append(area_under_curve(score, y))
    return float(np.mean(areas))


def _scores(x: np.ndarray, y: np.ndarray, unseen: np.ndarray) -> np.ndarray:
    centre, spread = x.mean(axis=0), x.std(axis=0)
    spread = np.where(spread > 1e-9, spread, np.inf)

    def squared(rows: np.ndarray) -> np.ndarray:
        unit = np.clip((rows - centre) / spread, -5.0, 5.0)
        return np.concatenate([unit, unit**2 - 1.0], axis=1)

    beta = logistic(squared(x), y)
    return np.asarray(beta[0] + squared(unseen) @ beta[1:])


def _dealt(y: np.ndarray, group: np.ndarray, pairs: bool, rng: np.random.Generator) -> np.ndarray:
    """(n,) fold of each movement, as many of each kind in every one; a pair lies in one."""
    fold = np.empty(len(y), int)
    for kind in (False,) if pairs else (False, True):
        at = rng.permutation(np.flatnonzero(y == kind))
        fold[at] = np.arange(len(at)) % min(N_FOLDS, len(at))
    if pairs:
        fold[y] = fold[~y][group[y]]
    return fold


def _permuted(y: np.ndarray, pairs: bool, rng: np.random.Generator) -> np.ndarray:
    if not pairs:
        return np.asarray(rng.permutation(y))
    swap = rng.random(len(y) // 2) < 0.5
    return np.concatenate([swap, ~swap])


def _telling(x: np.ndarray, y: np.ndarray, names: list[str]) -> tuple[str, float]:
    areas = np.array([area_under_curve(column, y) for column in x.T])
    most = int(np.abs(areas - 0.5).argmax())
    return names[most], float(areas[most])
