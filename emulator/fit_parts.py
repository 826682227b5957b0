"""Registered recordings reduced to joint coordinates: postures, root, pace, duration, marks, bones and pauses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.anova import intraclass_correlation
from emulator.dwell_fit import fit_dwells, predictors
from emulator.dwells import NONE, Dwells
from emulator.fit_settings import FitSettings
from emulator.flatten import SIEM
from emulator.footing import Footing
from emulator.joint import JointScale
from emulator.margin import Margin, fit_margin, within_worker
from emulator.marks import clock_to_coordinates
from emulator.motion import MotionSet
from emulator.reduce import JointPCA
from emulator.registered import LARGEST_PACE, Registered
from emulator.root import RootChannel
from emulator.storage import bits, on_grid
from emulator.warp import clr, from_clr

BONE_SHARE, FINE_RAD, FINE_ROOT = 0.98, 0.002, 0.0001
LARGEST_POSTURE, LARGEST_ROOT = 200, 200
DURATION_KNOTS, MARK_KNOTS = 12, 60
ALL = 1.0 - 1e-6
"""Of the pace nothing is left out but rounding: registration did already."""
LARGEST_ICC_FOR_SCORES = 0.3


@dataclass(frozen=True, eq=False)
class Parts:
    """The steps of a model and what they make of the recordings.

    flat : (N, P) tangent postures on the common clock; z : (N, K) joint coordinates
    """

    flatten: SIEM
    posture: JointPCA
    root: JointPCA
    pace: JointPCA
    bones: JointPCA
    margin: Margin
    mark_margins: tuple[Margin, ...]
    dwells: Dwells
    scale: JointScale
    flat: np.ndarray
    z: np.ndarray
    footing: Footing | None


def parts_of(made: Registered, settings: FitSettings) -> Parts:
    """Fit every step and go forward through it."""
    flatten, n_times = SIEM.fit(made.directions), made.warps.shape[1]
    flat = flatten.forward(made.directions).reshape(len(made.directions), -1)
    posture = stored(_posture_components(flat, settings.n_components), n_times)
    log_bones = _log_bones(made.moving)
    bones = JointPCA.fit(log_bones, BONE_SHARE)
    channel = made.channels()
    root = stored(_finely(channel, FINE_ROOT, LARGEST_ROOT), n_times)
    slopes = clr(made.warps, settings.n_knots)
    pace = JointPCA.fit(slopes, ALL, LARGEST_PACE)
    marks = clock_to_coordinates(made.mark_clock(from_clr(pace.inverse(pace.forward(slopes)), n_times)))
    mark_margins = tuple(fit_margin(column, column, MARK_KNOTS, 0.05) for column in marks.T)
    log_duration = np.log(made.moving.duration_s)
    margin = duration_margin(log_duration, made.moving.worker_index)
    dwells, latent = _dwells(made, log_duration)
    blocks = {
        "posture": posture.forward(flat),
        "root": root.forward(channel),
        "pace": pace.forward(slopes),
        "duration": margin.forward(log_duration)[:, None],
        "marks": np.stack([m.forward(c) for m, c in zip(mark_margins, marks.T)], axis=1) if mark_margins else marks,
        "bones": bones.forward(log_bones),
    }
    scale, z = JointScale.fit(blocks | latent)
    leg_m = RootChannel(made.moving.skeleton).leg_m(np.stack([m.bone_length_m for m in made.moving.motions]))
    footing = Footing.fit(made.moving.motions, made.warps, blocks["posture"], leg_m)
    return Parts(flatten, posture, root, pace, bones, margin, mark_margins, dwells, scale, flat, z, footing)


def stored(pca: JointPCA, n_times: int) -> JointPCA:
    """The same components on the grid they are stored on, so that a saved model is the fitted one."""
    n_bits = bits(n_times)
    return JointPCA(on_grid(pca.mean[None], n_bits)[0], on_grid(pca.basis, n_bits), pca.explained_variance)


def duration_margin(log_duration: np.ndarray, worker_index: np.ndarray) -> Margin:
    """Lognormal; normal scores where the residuals refuse it and workers hardly differ.

    Where a few people differ, pooled scores are steps at each of them, and a new worker between two has two modes;
    on held-out repetitions of such people the lognormal was as good or better (DESIGN.md).
    """
    icc = intraclass_correlation(log_duration, worker_index)[0]
    residual = within_worker(log_duration, worker_index)
    return fit_margin(log_duration, residual[:0] if icc > LARGEST_ICC_FOR_SCORES else residual, DURATION_KNOTS)


def _posture_components(flat: np.ndarray, n_components: int | float | None) -> JointPCA:
    """As many as asked for, or all that say more than ``FINE_RAD`` a bone, which no recording knows better."""
    if n_components is None:
        return _finely(flat, FINE_RAD / np.sqrt(2.0), LARGEST_POSTURE)
    return JointPCA.fit(flat, n_components)


def _finely(rows: np.ndarray, fine: float, largest: int) -> JointPCA:
    """As many components, at most ``largest``, as leave no more than ``fine`` of a value of rows (N, P) in the mean.

    A share of the variance would not do: where bodies walk metres, or a trembling camera moves pelvis and trunk alike,
    what is cut off one block is missed in another.
    """
    total = np.sum((rows - rows.mean(axis=0)) ** 2)
    return JointPCA.fit(rows, float(np.clip(1.0 - fine**2 * rows.size / max(total, 1e-300), 0.5, 1.0 - 1e-9)), largest)


def _log_bones(motions: MotionSet) -> np.ndarray:
    """(N, B) log bone lengths: each repetition has those of its worker, the mean over repetitions."""
    index = motions.worker_index
    each = np.log(np.stack([m.bone_length_m for m in motions.motions]))
    return np.stack([each[index == w].mean(axis=0) for w in range(len(motions.workers))])[index]


def _dwells(made: Registered, log_duration: np.ndarray) -> tuple[Dwells, dict[str, np.ndarray]]:
    """The law of the pauses, and the block of their coordinates; no block where nothing pauses."""
    if not any(made.holds):
        return NONE, {}
    whole = predictors(made.holds, made.moving, log_duration)
    dwells, latent = fit_dwells(made.holds, made.warps, len(made.moving.mark_names), whole)
    return dwells, {"dwells": latent}
