"""Leave one person out: his mean posture sequence foretold from his body alone, judged joint angle by joint angle.

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

from emulator import sphere
from emulator.covariates.agreement import icc_2_1, icc_of_the_paper, rms, sem
from emulator.covariates.body import Body
from emulator.covariates.model import CovariateModel
from emulator.covariates.table import CovariateTable, table_of
from emulator.covariates.validated import LEAST_MOVING_DEG, Agreement, Validation
from emulator.flatten import SIEM
from emulator.judge.joint_angles import joint_angles_deg
from emulator.motion import MotionSet
from emulator.reduce import JointPCA
from emulator.schemes.parallel import parallel_analysis
from emulator.skeleton import Skeleton


def validate(motions: MotionSet, *, names: Sequence[str] | None = None, keep: str = "fdr", seed: int = 0) -> Validation:
    """Register the repetitions of one task and leave each worker out in turn; ``cov_*`` say who they are.

    names : numeric covariates to take, as ``table_of``; seed : of the noise of the parallel analysis
    Raises ValueError where there are fewer than three workers, or for covariates that cannot be.
    """
    from emulator.fit_settings import FitSettings
    from emulator.model import SCHEME
    from emulator.registered import registered

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
