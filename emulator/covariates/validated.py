"""What leaving one person out found: how foretold joint angles agree with people's own, as numbers and as a table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

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
