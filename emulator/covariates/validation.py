"""Leave one person out: his mean posture sequence foretold from his body alone, judged joint angle by joint angle.

Source: Baydal-Bertomeu et al., "Validation methodology". Differences: one forecast a person, not one a recording; a
person's other recordings are left out with him (theirs leaves out one of six); ICC(2,1) of Shrout & Fleiss, since
their formula (7) is 1/2 for a perfect forecast; and the mean of the other people stands beside, which a body must beat.
The common clock and the chart of postures are made with everybody; components, model and means without him.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator import sphere
from emulator.covariates.agreement import icc_2_1, icc_of_the_paper, rms, sem
from emulator.covariates.model import CovariateModel
from emulator.covariates.table import CovariateTable, table_of
from emulator.flatten import SIEM
from emulator.judge.joint_angles import joint_angles_deg
from emulator.motion import MotionSet
from emulator.reduce import JointPCA
from emulator.schemes.parallel import parallel_analysis
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

    n_components : of the PCA, by parallel analysis; explained (W,) : scores that each fold's covariates explained
    """

    task: str
    workers: tuple[str, ...]
    n_repetitions: int
    n_components: int
    explained: np.ndarray
    by_body: Agreement
    by_mean: Agreement

    def table(self) -> list[str]:
        """Lines of text: mean (SD) over angles beside the paper's, then angle by angle."""
        size = f"{len(self.workers)} people, {self.n_repetitions} repetitions, {self.n_components} components"
        told = f"{self.explained.min()} to {self.explained.max()} explained"
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
    flat = chart.forward(directions).reshape(len(directions), -1)
    count = max(parallel_analysis(flat, rng), 1)
    true: list[np.ndarray] = []
    by_body: list[np.ndarray] = []
    by_mean: list[np.ndarray] = []
    explained: list[int] = []
    for worker in range(len(table.workers)):
        his = table.groups == worker
        pca = JointPCA.fit(flat[~his], min(count, int(np.sum(~his)) - 1))
        others = table.without(worker)
        model = CovariateModel.fit(
            pca.forward(flat[~his]), others.numeric, others.names, others.category, groups=others.groups, keep=keep
        )
        explained.append(int(model.explained.sum()))
        true.append(sphere.normalise(directions[his].mean(axis=0)))
        for found, scores in ((by_body, model.predict(table.body(worker))), (by_mean, np.zeros(pca.n_components))):
            found.append(chart.inverse(pca.inverse(scores).reshape(directions.shape[1], -1)))
    angles = [_angles(skeleton, np.stack(some), bone_length_m) for some in (true, by_body, by_mean)]
    names, own = angles[0]
    judged = [_agreement(names, own, foretold) for _, foretold in angles[1:]]
    return Validation(task, table.workers, len(directions), count, np.array(explained), *judged)


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


def _mean_sd(values: np.ndarray, digits: int = 2) -> str:
    return f"{np.nanmean(values):.{digits}f} ({np.nanstd(values, ddof=1):.{digits}f})"
