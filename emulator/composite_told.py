"""What a task of several motions tells of itself: what stands behind it, and how far its motions are apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from emulator.skeleton import Skeleton


@dataclass(frozen=True)
class Join:
    """Where one part ends and the next begins: by how much the bone to ``joint``, which differs most, differs.

    most_rad : a gap beyond it makes the join last longer than elsewhere, for nobody to move as no one can
    """

    before: str
    after: str
    gap_rad: float
    joint: str
    most_rad: float


@dataclass(frozen=True)
class CompositeReport:
    """What stands behind all parts together; people are those of the part with most."""

    source: str
    licence: str
    n_sequences: int
    n_workers: int


def report_of(models: Sequence[Any]) -> CompositeReport:
    """What stands behind these models together."""
    reports = [model.report for model in models]
    source, licence = (
        "; ".join(dict.fromkeys(getattr(one, name) for one in reports)) for name in ("source", "licence")
    )
    return CompositeReport(source, licence, sum(r.n_sequences for r in reports), max(r.n_workers for r in reports))


def joins_of(gaps_rad: np.ndarray, labels: Sequence[str], skeleton: Skeleton, most_rad: float) -> tuple[Join, ...]:
    """Each join by its gaps (P - 1, B) and the labels of the P parts."""
    bones = skeleton.bone_names
    return tuple(
        Join(labels[k], labels[k + 1], float(gap.max()), bones[int(gap.argmax())], most_rad)
        for k, gap in enumerate(gaps_rad)
    )
