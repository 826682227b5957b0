"""From the pauses of the repetitions to the law of the dwells: sites, margins, latent coordinates; see ``dwells``."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from emulator.geometry.pauses import SHORTEST_S, SLOW_SHARE, Hold
from emulator.geometry.warps import evaluate, invert
from emulator.model.dwell_times import Dwells
from emulator.model.joint_coordinates import Margin, fit_margin
from emulator.motion import MotionSet

SAME_SITE, SAME_PAUSE = 0.10, 0.03
"""Pauses nearer than the first on the common clock are one site; of one repetition only if nearer than the second."""
MOST_SITES = 8
MARGIN_KNOTS = 12
_GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0
HOLDS_METHOD = (
    "pauses cut out before registration; duration is modelled as moving time, whole time = moving time + dwells; "
    "dwells zero-inflated: a latent normal coordinate, no pause below its threshold, lognormal or normal scores above"
)


def fit_dwells(
    holds: Sequence[Sequence[Hold]], warps: np.ndarray, n_marks: int, predictors: np.ndarray
) -> tuple[Dwells, np.ndarray]:
    """Sites, margins and latent coordinates (N, S) of the pauses of N repetitions with their warps (N, T).

    predictors : (N, P) what else is known of a repetition; where it does not pause, its coordinate is imputed from them
    """
    rows = np.array([i for i, mine in enumerate(holds) for _ in mine], dtype=int)
    every = [hold for mine in holds for hold in mine]
    share = np.array([hold.moving_share for hold in every])
    place = np.array([evaluate(invert(warps[i]), np.array([at]))[0] for i, at in zip(rows, share)])
    site = _sites(place, rows)
    seconds = np.zeros((len(holds), site.max() + 1))
    passed = np.zeros((n_marks, site.max() + 1))
    for i, hold, j in zip(rows, every, site):
        seconds[i, j] += hold.dwell_s
        passed[:, j] += hold.mark_share
    clock = np.array([place[site == j].mean() for j in range(site.max() + 1)])
    zero_share = np.mean(seconds == 0, axis=0)
    logs = [np.log(column[column > 0]) for column in seconds.T]
    margins = tuple(fit_margin(x, x, MARGIN_KNOTS, 0.05) for x in logs)
    latent = [_latent(column, p0, m, predictors) for column, p0, m in zip(seconds.T, zero_share, margins)]
    return Dwells(clock, zero_share, margins, passed / np.bincount(site)), np.stack(latent, axis=1)


def predictors(holds: Sequence[Sequence[Hold]], motions: MotionSet, log_duration: np.ndarray) -> np.ndarray:
    """(N, 2) what goes with pauses: log moving duration, standardised, and how often the worker pauses (a score)."""
    from scipy.special import ndtri

    index, pauses = motions.worker_index, np.array([len(mine) > 0 for mine in holds], dtype=float)
    often = (np.bincount(index, pauses) + pauses.mean()) / (np.bincount(index) + 1.0)
    spread = max(float(np.std(log_duration)), 1e-9)
    return np.stack([(log_duration - log_duration.mean()) / spread, ndtri(np.clip(often, 0.01, 0.99))[index]], axis=1)


def said(dwells: Dwells, holds: Sequence[Sequence[Hold]]) -> tuple[str, ...]:
    """A note on the pauses, for the fit report; none where nothing pauses."""
    if len(dwells) == 0:
        return ()
    seconds = [hold.dwell_s for mine in holds for hold in mine]
    sites = ", ".join(f"{at:.2f} ({100 * (1 - p0):.0f} %)" for at, p0 in zip(dwells.clock, dwells.zero_share))
    return (
        f"pauses (slower than {100 * SLOW_SHARE:.0f} % of the typical speed for {SHORTEST_S:g} s or longer) in "
        f"{sum(len(mine) > 0 for mine in holds)} of {len(holds)} repetitions, {np.mean(seconds):.2f} s on average, "
        f"are cut out and modelled as dwell times; place on the common clock (share that pauses there): {sites}",
    )


def _sites(place: np.ndarray, repetition: np.ndarray) -> np.ndarray:
    """The site (H,) of each pause at ``place`` (H,) of ``repetition`` (H,): neighbours merged until none is near."""
    groups = [[int(i)] for i in np.argsort(place, kind="stable")]
    while len(groups) > 1:
        centres = np.array([place[group].mean() for group in groups])
        gaps = np.diff(centres)
        once = [not set(repetition[a]) & set(repetition[b]) for a, b in pairwise(groups)]
        near = gaps < np.where(once, SAME_SITE, SAME_PAUSE)
        if not near.any() and len(groups) <= MOST_SITES:
            break
        first = int(np.where(near, gaps, np.inf).argmin() if near.any() else gaps.argmin())
        groups[first : first + 2] = [groups[first] + groups[first + 1]]
    site = np.empty(len(place), dtype=int)
    for j, group in enumerate(groups):
        site[group] = j
    return site


def _latent(seconds: np.ndarray, zero_share: float, margin: Margin, predictors: np.ndarray) -> np.ndarray:
    """Normal coordinates (N,): of a pause by its margin, of no pause imputed below the threshold.

    The imputed ones are normal scores of the share below the threshold, ordered by a draw from the regression on the
    predictors, so that what goes with pauses goes with the coordinate. The draw is a fixed sequence (golden ratio).
    """
    from scipy.special import ndtr, ndtri

    pauses = seconds > 0
    latent = np.zeros(len(seconds))
    latent[pauses] = -ndtri(ndtr(-margin.forward(np.log(seconds[pauses]))) * (1.0 - zero_share))
    none = np.flatnonzero(~pauses)
    if len(none) == 0:
        return latent
    scores = ndtri((np.arange(1, len(none) + 1) - 0.375) / (len(none) + 0.25) * zero_share)
    uniform = np.modf(_GOLDEN * (none + 1.0))[0]
    latent[none] = np.median(scores)
    design = np.column_stack([np.ones(len(seconds)), predictors])
    prior = np.diag([0.0, *np.full(predictors.shape[1], 4.0)])  # worth four repetitions that know of no relation
    for _ in range(20):
        slope = np.linalg.solve(design.T @ design + prior, design.T @ latent)
        middle = design @ slope
        spread = max(float(np.std(latent - middle)), 1e-6)
        limit = ndtr((ndtri(zero_share) - middle[none]) / spread) if zero_share < 1 else 1.0
        draw = middle[none] + spread * ndtri(np.clip(uniform * limit, 1e-12, 1 - 1e-12))
        latent[none[np.argsort(draw, kind="stable")]] = scores
    return latent
