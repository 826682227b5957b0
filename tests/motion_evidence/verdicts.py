"""The bounds, and whether they hold; figures are medians over the splits of a class."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass

import numpy as np
from motion_evidence.drawers import COPIER, OURS, PAPER, SHAKER
from motion_evidence.judged import Split

MOST_ENERGY_RATIO = 0.25
LEAST_P, LEAST_SHARE_OF_P = 0.05, 53 / 60
NOVELTY = (0.8, 1.25)
MOST_ROUGH, MOST_ACCELERATED = 0.10, 0.20
MOST_NUMBERS = 48


@dataclass(frozen=True)
class Figures:
    """One drawer in one class: medians over splits of energy, its ratio to the paper's, novelty, roughness.

    Roughness twice: the temporal one of the paper, and by second differences, where trembling shows first.

    ratio_of_medians, ratio_stratified : the same ratio from the medians, and from energies for stratified samples
    n_passed : splits with DISCO p above 0.05
    """

    task: str
    drawer: str
    n_splits: int
    energy: float
    ratio: float
    ratio_of_medians: float
    ratio_stratified: float
    n_passed: int
    novelty: float
    temporal_roughness: float
    roughness: float
    roughness_own_time: float

    def failures(self) -> list[str]:
        """The bounds of a class that do not hold, in words."""
        found = [
            (self.ratio > MOST_ENERGY_RATIO, f"energy {self.ratio:.2f} of the paper's"),
            (not NOVELTY[0] <= self.novelty <= NOVELTY[1], f"novelty {self.novelty:.2f}"),
            (abs(self.temporal_roughness - 1) > MOST_ROUGH, f"temporal roughness {self.temporal_roughness:.2f}"),
            (abs(self.roughness - 1) > MOST_ACCELERATED, f"second differences {self.roughness:.2f}"),
        ]
        return [words for fails, words in found if fails]


def figures(splits: Iterable[Split], task: str, drawer: str) -> Figures:
    """The figures of one drawer in one class."""
    mine = [split for split in splits if split.task == task]
    own, paper = (_columns(mine, name) for name in (drawer, PAPER))
    medians = {name: float(np.median(values)) for name, values in own.items()}
    return Figures(
        task,
        drawer,
        len(mine),
        medians["energy"],
        float(np.median(own["energy"] / paper["energy"])),
        float(medians["energy"] / np.median(paper["energy"])),
        float(medians["energy_stratified"] / np.median(paper["energy_stratified"])),
        int(np.sum(own["p"] > LEAST_P)),
        medians["novelty"],
        medians["temporal_roughness"],
        medians["roughness"],
        float(np.median([split.roughness_own_time for split in mine])) if drawer == OURS else float("nan"),
    )


def _columns(splits: list[Split], drawer: str) -> dict[str, np.ndarray]:
    rows = [asdict(split.compared[drawer]) for split in splits]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def failures(splits: list[Split]) -> list[str]:
    """All that does not hold, in words; empty where everything does."""
    tasks = list(dict.fromkeys(split.task for split in splits))
    ours = [figures(splits, task, OURS) for task in tasks]
    found = [f"{f.task}: {words}" for f in ours for words in f.failures()]
    passed = sum(f.n_passed for f in ours)
    if passed < np.floor(LEAST_SHARE_OF_P * len(splits)):
        found.append(f"DISCO p above {LEAST_P} in {passed} of {len(splits)} splits")
    for control in (COPIER, SHAKER):
        found += [f"{t}: the {control} passes" for t in tasks if not figures(splits, t, control).failures()]
    return found + _reconstruction(splits, tasks)


def _reconstruction(splits: list[Split], tasks: list[str]) -> list[str]:
    found = []
    for task in tasks:
        rows = [split for split in splits if split.task == task]
        ours, paper = (np.median([getattr(row, name) for row in rows]) for name in ("error", "paper_error"))
        most = max(row.n_components for row in rows)
        if most > MOST_NUMBERS or ours >= paper:
            found.append(f"{task}: {most} numbers lose {ours:.3f}, the paper's 300 lose {paper:.3f}")
    return found
