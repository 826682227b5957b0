"""What leaving one person out found: how foretold joint angles agree with people's own, as numbers and as a table.

Do two curves agree? Intraclass correlation and standard error of measurement of a true and a foretold angle.

Leave one person out: his mean posture sequence foretold from his body alone, judged joint angle by joint angle.

Source: Baydal-Bertomeu et al., "Validation methodology". Differences: one forecast a person, not one a recording; a
person's other recordings are left out with him (theirs leaves out one of six); ICC(2,1) of Shrout & Fleiss, since
their formula (7) is 1/2 for a perfect forecast; and the mean of the other people stands beside, which a body must beat.
The common clock and the chart of postures are made with everybody; the components, their number, model and means
without him.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator.covariates.body import Body
from emulator.covariates.model import CovariateModel
from emulator.covariates.table import CovariateTable, table_of
from emulator.geometry import sphere
from emulator.geometry.flattening import SIEM
from emulator.judge.joint_limits import joint_angles_deg
from emulator.model.reduction import JointPCA
from emulator.motion import MotionSet
from emulator.schemes.reductions import parallel_analysis
from emulator.skeleton import Skeleton

PAPER = {"ICC": (0.91, 0.04), "SEM": (4.16, 6.80)}
"""Mean and s.d. that Baydal-Bertomeu et al. report for 18 runners; SEM in degrees."""
LEAST_MOVING_DEG = 2.0


@dataclass(frozen=True, eq=False)
class Agreement:
    """How W people's foretold joint angles agree with their own: icc, paper_icc, sem_deg, rms_deg (W, A) over time.

    The ICCs of an angle that moves by less than ``LEAST_MOVING_DEG`` are NaN: there is nothing to agree on.
    person_icc (W,) : ICC(2,1) over all angles and moments of a person at once, what the paper's histogram shows
    """

    angles: tuple[str, ...]
    icc: np.ndarray
    paper_icc: np.ndarray
    sem_deg: np.ndarray
    rms_deg: np.ndarray
    person_icc: np.ndarray


@dataclass(frozen=True, eq=False)
class Validation:
    """by_body: from the covariates; by_mean: everybody foretold as the mean of the others.

    n_components, explained (W,) : components of each fold's PCA, by parallel analysis; scores explained of them
    """

    task: str
    workers: tuple[str, ...]
    n_repetitions: int
    n_components: np.ndarray
    explained: np.ndarray
    by_body: Agreement
    by_mean: Agreement

    def table(self) -> list[str]:
        """Lines of text: mean (SD) over angles beside the paper's, then angle by angle."""
        size = f"{len(self.workers)} people, {self.n_repetitions} repetitions"
        told = f"{_least_to_most(self.n_components)} components, {_least_to_most(self.explained)} explained"
        lines = [
            f"{self.task}: {size}, {told}",
            f"{'':34s}{'by body':>16s}{'by the mean':>16s}{'paper (running)':>17s}",
        ]
        for label, name, paper, digits in _ROWS:
            both = [_mean_sd(getattr(one, name), digits) for one in (self.by_body, self.by_mean)]
            said = f"{PAPER[paper][0]:.2f} ({PAPER[paper][1]:.2f})" if paper else ""
            lines.append(f"{label:34s}{both[0]:>16s}{both[1]:>16s}{said:>17s}")
        return lines + [
            f"  {angle:32s}" + "".join(f"{_mean_sd(one.sem_deg[:, a]):>16s}" for one in (self.by_body, self.by_mean))
            for a, angle in enumerate(self.by_body.angles)
        ]


_ROWS = (
    ("ICC(2,1) of a person, all angles", "person_icc", "ICC", 3),
    ("ICC(2,1) an angle", "icc", "", 3),
    ("formula (7) an angle", "paper_icc", "", 3),
    ("SEM an angle, degrees", "sem_deg", "SEM", 2),
    ("RMS error an angle, degrees", "rms_deg", "", 2),
)


def _mean_sd(values: np.ndarray, digits: int = 2) -> str:
    return f"{np.nanmean(values):.{digits}f} ({np.nanstd(values, ddof=1):.{digits}f})"


def _least_to_most(counts: np.ndarray) -> str:
    low, high = int(counts.min()), int(counts.max())
    return f"{low}" if low == high else f"{low} to {high}"


def icc_2_1(true: np.ndarray, foretold: np.ndarray) -> np.ndarray:
    """Absolute agreement ICC(2,1) of curves (..., T) over their moments, (...); 1 is the same curve.

    Moments are the targets, the two curves the raters. NaN moments (an angle that says nothing) are left out; NaN for
    fewer than three moments or two curves that never move. Source: Shrout & Fleiss (1979), case 2, single rater.
    """
    pair = np.stack([true, foretold], axis=-1)
    there = np.all(np.isfinite(pair), axis=-1)
    n = there.sum(axis=-1)
    pair = np.where(there[..., None], pair, 0.0)
    enough = np.maximum(n, 1)
    rater = pair.sum(axis=-2) / enough[..., None]
    grand = rater.mean(axis=-1)
    target = np.where(there, pair.mean(axis=-1), grand[..., None])
    rows = 2.0 * np.sum((target - grand[..., None]) ** 2, axis=-1) / np.maximum(n - 1, 1)
    columns = enough * np.sum((rater - grand[..., None]) ** 2, axis=-1)
    fit = target[..., None] + rater[..., None, :] - grand[..., None, None]
    rest = np.sum(np.where(there[..., None], pair - fit, 0.0) ** 2, axis=(-2, -1)) / np.maximum(n - 1, 1)
    below = rows + rest + 2.0 * (columns - rest) / enough
    return np.where((n >= 3) & (below > 0), (rows - rest) / np.where(below > 0, below, 1.0), np.nan)


def icc_of_the_paper(true: np.ndarray, foretold: np.ndarray) -> np.ndarray:
    """Formula (7) of Baydal-Bertomeu et al., (...): var(foretold) / (var(true) + var(foretold)) of curves (..., T).

    It is 1/2 for a perfect forecast and for any other of the right size, so their 0.91 cannot have come from it as
    printed. Here to be quoted beside ``icc_2_1``, not to be judged by.
    """
    there = np.isfinite(true) & np.isfinite(foretold)
    one, other = (_variance(np.where(there, curve, np.nan)) for curve in (true, foretold))
    whole = one + other
    return np.where(whole > 0, other / np.where(whole > 0, whole, 1.0), np.nan)


def sem(true: np.ndarray, foretold: np.ndarray, icc: np.ndarray) -> np.ndarray:
    """Standard error of measurement (...), in the unit of the curves (..., T): combined s.d. times sqrt(1 - ICC).

    Source: Baydal-Bertomeu et al., eq. 8, sigma_c as the s.d. of both curves' moments; 0 for the same constant.
    """
    there = np.isfinite(true) & np.isfinite(foretold)
    both = np.concatenate([np.where(there, true, np.nan), np.where(there, foretold, np.nan)], axis=-1)
    spread = np.sqrt(_variance(both))
    return np.where(spread > 0, spread * np.sqrt(np.maximum(1.0 - icc, 0.0)), 0.0)


def rms(true: np.ndarray, foretold: np.ndarray) -> np.ndarray:
    """Root of the mean squared difference (...) of curves (..., T), over the moments that both have."""
    square = (true - foretold) ** 2
    n = np.sum(np.isfinite(square), axis=-1)
    return np.where(n > 0, np.sqrt(np.nansum(square, axis=-1) / np.maximum(n, 1)), np.nan)


def _variance(curves: np.ndarray) -> np.ndarray:
    """(...) variance over the finite moments of (..., T), about their mean, n - 1 in the denominator."""
    n = np.sum(np.isfinite(curves), axis=-1)
    mean = np.nansum(curves, axis=-1) / np.maximum(n, 1)
    return np.nansum((curves - mean[..., None]) ** 2, axis=-1) / np.maximum(n - 1, 1)


def validate(motions: MotionSet, *, names: Sequence[str] | None = None, keep: str = "fdr", seed: int = 0) -> Validation:
    """Register the repetitions of one task and leave each worker out in turn; ``cov_*`` say who they are.

    names : numeric covariates to take, as ``table_of``; seed : of the noise of the parallel analysis
    Raises ValueError where there are fewer than three workers, or for covariates that cannot be.
    """
    from emulator.fitting.registration import registered
    from emulator.fitting.settings import FitSettings
    from emulator.model.emulator import SCHEME

    made = registered(motions, FitSettings(SCHEME, None, 101, 20, 0.0, seed, ""), None)
    bones = np.mean([motion.bone_length_m for motion in made.moving.motions], axis=0)
    table = table_of(made.moving, names)
    rng = np.random.default_rng([seed, 6])
    return leave_one_worker_out(made.directions, table, motions.skeleton, bones, rng, keep=keep, task=motions.task)


def leave_one_worker_out(
    directions: np.ndarray,
    table: CovariateTable,
    skeleton: Skeleton,
    bone_length_m: np.ndarray,
    rng: np.random.Generator,
    *,
    keep: str = "fdr",
    task: str = "",
) -> Validation:
    """From postures on a common clock (N, T, B, 3), one row of ``table`` each; bones (B,) only join the directions.

    Raises ValueError for fewer than three workers or rows that do not match.
    """
    if len(table.workers) < 3 or len(table.numeric) != len(directions):
        raise ValueError(
            f"covariates: found {len(table.workers)} workers and {len(table.numeric)} rows for {len(directions)} "
            "repetitions, expected three workers or more and a row each"
        )
    chart = SIEM.fit(directions)
    charted = chart.forward(directions)
    flat = charted.reshape(len(directions), -1)
    folds = [_foretold(flat, table, worker, rng, keep) for worker in range(len(table.workers))]
    foretold = chart.inverse(np.stack([fold.flat for fold in folds], axis=1).reshape(2, len(folds), *charted.shape[1:]))
    true = [sphere.normalise(directions[table.groups == worker].mean(axis=0)) for worker in range(len(folds))]
    (names, own), *others = (_angles(skeleton, some, bone_length_m) for some in (np.stack(true), *foretold))
    judged = [_agreement(names, own, angles) for _, angles in others]
    counts, explained = (np.array(some) for some in zip(*((fold.n_components, fold.explained) for fold in folds)))
    return Validation(task, table.workers, len(directions), counts, explained, *judged)


@dataclass(frozen=True, eq=False)
class _Fold:
    """What the others foretell of one who is left out: flat postures (2, D), by his body and by their mean."""

    flat: np.ndarray
    n_components: int
    explained: int


def _foretold(flat: np.ndarray, table: CovariateTable, worker: int, rng: np.random.Generator, keep: str) -> _Fold:
    """From flat postures (N, D) of everybody, of which the worker's own play no part."""
    rows, others = flat[table.groups != worker], table.without(worker)
    count = parallel_analysis(rows, rng) if len(rows) > 2 else 1
    pca = JointPCA.fit(rows, min(max(count, 1), len(rows) - 1))
    model = CovariateModel.fit(
        pca.forward(rows), others.numeric, others.names, others.category, groups=others.groups, keep=keep
    )
    by_body = model.predict(Body.of(table.body(worker), table.names))  # the others may not tell by all of them
    foretold = pca.inverse(np.stack([by_body, np.zeros_like(by_body)]))
    return _Fold(foretold, pca.n_components, int(model.explained.sum()))


def _angles(
    skeleton: Skeleton, directions: np.ndarray, bone_length_m: np.ndarray
) -> tuple[tuple[str, ...], np.ndarray]:
    """Names (A,) and joint angles (W, A, T) in degrees of directions (W, T, B, 3)."""
    found = joint_angles_deg(skeleton, skeleton.positions(directions, bone_length_m, np.zeros(3)))
    names = [
        f"{side}{name}"
        for name, angle in found.items()
        for side in (("left ", "right ") if angle.shape[-1] == 2 else ("",))
    ]
    return tuple(names), np.moveaxis(np.concatenate(list(found.values()), axis=-1), -1, 1)


def _agreement(names: tuple[str, ...], true: np.ndarray, foretold: np.ndarray) -> Agreement:
    icc = icc_2_1(true, foretold)
    person = icc_2_1(true.reshape(len(true), -1), foretold.reshape(len(true), -1))
    error = sem(true, foretold, icc)
    there = np.isfinite(true)
    moves = np.where(there, true, -np.inf).max(-1) - np.where(there, true, np.inf).min(-1) >= LEAST_MOVING_DEG
    of_paper = np.where(moves, icc_of_the_paper(true, foretold), np.nan)
    return Agreement(names, np.where(moves, icc, np.nan), of_paper, error, rms(true, foretold), person)
