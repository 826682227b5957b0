"""Registered recordings reduced to joint coordinates: postures, root, pace, duration, marks, bones and pauses.

What the bodies of the recorded people say of how they move: the covariates' part of a fit.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import gaussian_filter1d

from emulator.covariates.model import CovariateModel
from emulator.covariates.table import FEWEST_PEOPLE, CovariateTable, asked_table
from emulator.fitting.registration import LARGEST_PACE, Registered
from emulator.fitting.settings import FitSettings
from emulator.geometry.flattening import SIEM, Extrinsic, Flattening
from emulator.geometry.warps import clock_to_coordinates, clr, from_clr
from emulator.model.decoding import RootChannel
from emulator.model.dwell_fit import fit_dwells, predictors
from emulator.model.dwell_times import NONE, Dwells
from emulator.model.feet import Footing, fastest_m_per_s
from emulator.model.joint_coordinates import BLOCKS, JointScale, Margin, bits, fit_margin, on_grid, within_worker
from emulator.model.joint_law import FASTER
from emulator.model.reduction import JointPCA
from emulator.motion import MotionSet
from emulator.people.variance_components import intraclass_correlation
from emulator.people.workers import Told

BONE_SHARE, FINE_RAD, FINE_ROOT = 0.98, 0.0005, 0.00001
LARGEST_POSTURE, LARGEST_ROOT = 200, 200
FLATTENINGS: dict[str, type[SIEM] | type[Extrinsic]] = {"Extrinsic": Extrinsic, "SIEM": SIEM}
SMOOTH_SHARE, N_SMOOTH = 0.06, 8
"""How wide the means over time are that smooth components are made of, as a share of the clock, and how many those
are: 0.03 or 0.1 is rougher, 5 leave the noise of a squat a tenth shorter."""
DURATION_KNOTS, MARK_KNOTS = 12, 60
ALL = 1.0 - 1e-6
"""Of the pace nothing is left out but rounding: registration did already."""
LARGEST_ICC_FOR_SCORES = 0.3
QUICK, SOONER, SOONEST = 0.85, 1.02, 0.1
"""People differ in how fast they are, not only in how long they take; and the least time is less than any recorded."""


@dataclass(frozen=True, eq=False)
class Parts:
    """The steps of a model and what they make of the recordings.

    flat : (N, P) flat postures on the common clock; z : (N, K) joint coordinates
    """

    flatten: Flattening
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
    representation, _, density = settings.scheme.split("/")
    flatten, n_times = FLATTENINGS[representation].fit(made.directions), made.warps.shape[1]
    flat = flatten.forward(made.directions).reshape(len(made.directions), -1)
    smooth = SMOOTH_SHARE * n_times if density == "Smoothed" else 0.0
    rows = flat if settings.n_components else with_smooth(flat, n_times, smooth)
    posture = stored(_posture_components(rows, flatten, settings.n_components), n_times)
    log_bones = _log_bones(made.moving)
    bones = JointPCA.fit(log_bones, BONE_SHARE)
    channel = made.channels()
    root = stored(_finely(with_smooth(channel, n_times, smooth), FINE_ROOT, LARGEST_ROOT), n_times)
    slopes = clr(made.warps, settings.n_knots)
    pace = JointPCA.fit(slopes, ALL, LARGEST_PACE)
    marks = clock_to_coordinates(made.mark_clock(from_clr(pace.inverse(pace.forward(slopes)), n_times)))
    mark_margins = tuple(fit_margin(column, column, MARK_KNOTS, 0.05) for column in marks.T)
    log_duration = np.log(made.moving.duration_s)
    margin = duration_margin(log_duration, made.moving.worker_index)
    if smooth > 0:
        margin = margin.held_above(np.log(shortest_s(made.moving)))
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
    footing = Footing.fit(made.moving.motions, made.warps, scale.raw(z, "posture"), leg_m)
    return Parts(flatten, posture, root, pace, bones, margin, mark_margins, dwells, scale, flat, z, footing)


def stored(pca: JointPCA, n_times: int) -> JointPCA:
    """The same components on the grid they are stored on, so that a saved model is the fitted one."""
    n_bits = bits(n_times)
    return JointPCA(on_grid(pca.mean[None], n_bits)[0], on_grid(pca.basis, n_bits), pca.explained_variance)


def duration_margin(log_duration: np.ndarray, worker_index: np.ndarray) -> Margin:
    """Lognormal; normal scores where the residuals refuse it and workers hardly differ.

    Where a few people differ, pooled scores are steps at each of them, and a new worker between two has two modes;
    on held-out repetitions of such people the lognormal was as good or better (docs/emulator.md).
    """
    icc = intraclass_correlation(log_duration, worker_index)[0]
    residual = within_worker(log_duration, worker_index)
    return fit_margin(log_duration, residual[:0] if icc > LARGEST_ICC_FOR_SCORES else residual, DURATION_KNOTS)


def shortest_s(motions: MotionSet) -> float:
    """The least time of a body: in a little more the usual movement has joints as fast as those of draws may be.

    The t of a few people has long tails: .5 s for a throw that took 2.3 to 4 s, at three times the speed of any arm.
    """
    fastest, duration_s = fastest_m_per_s(motions.motions), motions.duration_s
    least_s = float(np.median(fastest * duration_s)) / max(FASTER * float(fastest.max()), 1e-9)
    return float(np.clip(QUICK * least_s, SOONEST * duration_s.min(), duration_s.min() / SOONER))


def with_smooth(rows: np.ndarray, n_times: int, width: float) -> np.ndarray:
    """Rows (N, T * C), and what is smooth of them: a few principal parts of their means over ``width`` points of time.

    What recordings differ by is as rough as they are, and no sum of it is smooth. Components of both leave a law room
    to move a movement without making it rough. The same rows where width is 0.
    """
    if width <= 0 or len(rows) < 2:
        return rows
    mean = rows.mean(axis=0)
    curves = (rows - mean).reshape(len(rows), n_times, -1)
    means = gaussian_filter1d(curves, width, axis=1, mode="nearest").reshape(rows.shape)
    u, d, vt = np.linalg.svd(means, full_matrices=False)
    return np.concatenate([rows, mean + (u[:, :N_SMOOTH] * d[:N_SMOOTH]) @ vt[:N_SMOOTH]])


def _posture_components(rows: np.ndarray, flatten: Flattening, n_components: int | float | None) -> JointPCA:
    """As many as asked for, or all that say more than ``FINE_RAD`` a bone, which no recording knows better."""
    if n_components is None:
        return _finely(rows, FINE_RAD / np.sqrt(flatten.n_channels / flatten.n_bones), LARGEST_POSTURE)
    return JointPCA.fit(rows, n_components)


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


LEVEL = 0.99
"""Stricter than the paper's 95 %: a library holds many tasks, and one false bond of height and time misleads."""
MOST_NESTED = 40
"""From so many people on, choosing scores by their own R^2 flatters it by less than 3 %."""
CHANGES = 1e-6
"""Of its standard deviation: a covariate that moves less from repetition to repetition is a person's own."""
FAMILY = {"posture": 0, "root": 0, "bones": 1}
"""Scores of one family are corrected for one another; duration, pace, marks and pauses are the third."""


@dataclass(frozen=True, eq=False)
class Covariates:
    """told : None where nothing is told; lines : for the fit report

    within : (N, K) what covariates that change from repetition to repetition (a pace asked for) say of each, about its
             worker's mean; 0 where they do not change
    """

    told: Told | None
    lines: tuple[str, ...]
    within: np.ndarray


def covariates_of(parts: Parts, motions: MotionSet, asked: tuple[str, ...]) -> Covariates:
    """The covariates' model of the joint coordinates, by the body and the columns that were asked for."""
    table, index = asked_table(motions, asked), motions.worker_index
    nothing = np.zeros_like(parts.z)
    if len(motions.workers) < FEWEST_PEOPLE or not (table.names or any(table.category)):
        return Covariates(None, (), nothing)
    rows, z = _rows(table, parts.z, index)
    families = np.repeat([FAMILY.get(name, 2) for name in BLOCKS[: len(parts.scale.sizes)]], parts.scale.sizes)
    model, shift = told_of(rows, z, families)
    if not model.explained.any():
        return Covariates(None, tuple(model.lines), nothing)
    fitted = _means(shift, rows.groups)
    within = shift - fitted[index] if len(rows.groups) == len(index) else nothing
    return Covariates(Told(model, fitted - fitted.mean(axis=0)), tuple(model.lines), within)


def told_of(rows: CovariateTable, z: np.ndarray, families: np.ndarray | None) -> tuple[CovariateModel, np.ndarray]:
    """The model of joint coordinates z (R, K) by the rows of a table, its r2 with everything left out; its shifts.

    families : (K,) as for ``CovariateModel.fit``
    """
    model = _fit(rows, z, families)
    if model.explained.any():
        model = replace(model, r2=_honest_r2(model, rows, z, families))
    return model, _shifts(model, rows, np.arange(len(z)))


def _rows(table: CovariateTable, z: np.ndarray, index: np.ndarray) -> tuple[CovariateTable, np.ndarray]:
    """A row for each worker with the means of z, or, where a covariate changes within workers, for each repetition."""
    people = table.of_people()
    apart = np.abs(table.numeric - people.numeric[index])
    if np.any(apart > CHANGES * np.nanstd(table.numeric, axis=0)):
        return table, z
    return people, _means(z, index)


def _fit(rows: CovariateTable, z: np.ndarray, families: np.ndarray | None) -> CovariateModel:
    return CovariateModel.fit(
        z, rows.numeric, rows.names, rows.category, groups=rows.groups, families=families, level=LEVEL
    )


def _shifts(model: CovariateModel, rows: CovariateTable, at: np.ndarray) -> np.ndarray:
    """(A, K) what the model says of the rows ``at`` (A,)."""
    columns = np.array([rows.names.index(name) for name in model.names], int)
    return model.shifts(rows.numeric[np.ix_(at, columns)], [rows.category[i] for i in at])


def _honest_r2(model: CovariateModel, rows: CovariateTable, z: np.ndarray, families: np.ndarray | None) -> np.ndarray:
    """(K,) leave-one-person-out R^2 where each fold also chooses anew which scores are told, and by how much.

    The R^2 by which scores were chosen flatters those that are: with it new people varied by 0.2-0.7 of what their
    forecast errs by (6 to 8 people, 50-70 % of the variance told), with this by 0.7-1.3; where 90 % are told, 2 to 4
    times as much, since a fold has one person less to be sure by. From 12 people on it is 0.9-1.6.
    """
    if len(rows.workers) > MOST_NESTED:
        return model.r2
    missed, spread = np.zeros(z.shape[1]), np.zeros(z.shape[1])
    for person in range(len(rows.workers)):
        own, some = rows.groups == person, rows.without(person)
        centre = _means(z[~own], some.groups).mean(axis=0)
        foretold = centre + _shifts(_fit(some, z[~own], families), rows, np.flatnonzero(own)).mean(axis=0)
        missed += (z[own].mean(axis=0) - foretold) ** 2
        spread += (z[own].mean(axis=0) - centre) ** 2
    anew = np.clip(missed / np.where(spread > 0, spread, 1.0), 0.0, 1.0)
    return np.where(model.explained, 1.0 - anew, 0.0)


def _means(values: np.ndarray, groups: np.ndarray) -> np.ndarray:
    """(G, K) means of rows (R, K) by group."""
    return np.stack([values[groups == g].mean(axis=0) for g in range(int(groups.max()) + 1)])
