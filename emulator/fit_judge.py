"""Three cheap figures for the fit report: what the components lose, how rough the draws are, how far from a copy."""

from __future__ import annotations

import numpy as np

from emulator import sphere
from emulator.flatten import SIEM
from emulator.reduce import JointPCA


def reconstruction_deg(flatten: SIEM, directions: np.ndarray, n_components: int, n_folds: int = 5) -> float:
    """Mean angle (degrees a bone) between aligned repetitions (N, T, B, 3) and their projection on others' components.

    Folds are every ``n_folds``-th repetition, so that in each some repetitions of every worker are left in.
    """
    flat = flatten.forward(directions).reshape(len(directions), -1)
    folds = np.arange(len(flat)) % min(n_folds, len(flat))
    angles = []
    for fold in np.unique(folds):
        held = folds == fold
        rank = int(np.sum(~held)) - 1
        if rank < 1:
            return float("nan")
        pca = JointPCA.fit(flat[~held], 0.999999, min(n_components, rank))
        again = flatten.inverse(pca.inverse(pca.forward(flat[held])).reshape(-1, *flatten_shape(directions)))
        angles.append(sphere.angle(again, directions[held]).mean(axis=(1, 2)))
    return float(np.degrees(np.concatenate(angles).mean()))


def flatten_shape(directions: np.ndarray) -> tuple[int, int]:
    """(T, 2B) of directions (N, T, B, 3)."""
    return directions.shape[1], 2 * directions.shape[2]


def roughness_ratio(flatten: SIEM, emulated: np.ndarray, aligned: np.ndarray, warps: np.ndarray) -> float:
    """Mean second difference in own time: emulated (n, T, B, 3) over recorded (N, T, B, 3), aligned by warps (N, T)."""
    clock = np.linspace(0, 1, warps.shape[1])
    flat = flatten.forward(aligned)
    own = np.stack([_along_time(x, np.interp(clock, gamma, clock)) for x, gamma in zip(flat, warps)])
    return float(_roughness(flatten.forward(emulated)) / _roughness(own))


def novelty_ratio(drawn: np.ndarray, recorded: np.ndarray) -> float:
    """Median distance of drawn scores (n, K) to the nearest recorded ones (N, K), over that among the recorded.

    NaN where half of the recorded ones or more have a twin (scores have unit spread; below 1e-6 is rounding).
    """
    among = _distances(recorded, recorded)
    np.fill_diagonal(among, np.inf)
    usual = np.median(among.min(axis=1))
    return float(np.median(_distances(drawn, recorded).min(axis=1)) / usual) if usual > 1e-6 else float("nan")


def _along_time(flat: np.ndarray, at: np.ndarray) -> np.ndarray:
    place = at * (len(flat) - 1)
    cell = np.minimum(place.astype(int), len(flat) - 2)
    share = (place - cell)[:, None]
    return (1 - share) * flat[cell] + share * flat[cell + 1]


def _roughness(flat: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(flat, n=2, axis=1), axis=-1).mean())


def _distances(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    square = (a**2).sum(1)[:, None] + (b**2).sum(1)[None] - 2 * a @ b.T
    return np.sqrt(np.maximum(square, 0.0))
